// Curvature of a triangle mesh by normal cycles (Cohen-Steiner, Morvan, Restricted Delaunay
// triangulations and normal cycle, 2003), averaged over a disc so that facets do not show.
#pragma once

#include <vector>

#include "mesh/surface.h"
#include "parallel/workers.h"

namespace nonobtuse::sizing {

/// #V: the principal curvature larger in size, >= 0, per working length; averaged over the facets
/// connected to the vertex whose centres lie within `radius`. Creases count by their dihedral
/// angle, boundaries not at all. O(#V facets per disc).
std::vector<double> largest_curvature(const mesh::Surface& surface, double radius,
                                      const parallel::Workers& workers);

}  // namespace nonobtuse::sizing
