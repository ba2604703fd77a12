// The restricted Delaunay triangulation: the dual of the exact restricted Voronoi diagram
// (Edelsbrunner, Shah, Triangulating topological spaces, 1997).
#pragma once

#include <span>
#include <vector>

#include "mesh/surface.h"
#include "nonobtuse/mesh.h"
#include "rvd/restricted_voronoi.h"

namespace nonobtuse::rdt {

/// A triangle (i, j, k) for every point of the surface where three cells meet, oriented like the
/// surface, in order of facets; i is the lowest index. A triangle may occur more than once and the
/// whole need not be a manifold: see closed_ball.h. `owner` (#P) is the cell each piece belongs to:
/// diagram.site for plain cells, or that of localized ones.
std::vector<Triangle> restricted_delaunay(const rvd::RestrictedVoronoi& diagram,
                                          std::span<const Index> owner);

}  // namespace nonobtuse::rdt
