// From a field of target edge lengths h to densities: a centroidal tessellation spreads rho h^4
// evenly (Du, Wang, The optimal centroidal Voronoi tessellations and the Gersho's conjecture,
// 2005), so that rho = h^-4 realises h, with rho^(1/2) sites per area.
#pragma once

#include <span>
#include <vector>

#include "mesh/surface.h"

namespace nonobtuse::sizing {

/// The number of vertices that target edge lengths h (#V, linear on facets) ask for: the integral
/// of 2 / (sqrt(3) h^2) over the surface.
double vertices_for(const mesh::Surface& surface, std::span<const double> length);

/// The same of a part of the surface: the facets listed.
double vertices_for(const mesh::Surface& surface, std::span<const double> length,
                    std::span<const Index> facets);

/// Scales `length` (#V, positive or infinite) so that it asks for `vertices` and grows by no more
/// than `gradation` (see limit_gradation): the limited field of the right scale.
void scale_to_vertices(const mesh::Surface& surface, double vertices, double gradation,
                       std::vector<double>& length);

}  // namespace nonobtuse::sizing
