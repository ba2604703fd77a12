// Triangles of the mesh that pass through each other.
#pragma once

#include <utility>
#include <vector>

#include "mesh/editable_mesh.h"
#include "parallel/workers.h"
#include "refine/knots.h"

namespace nonobtuse::refine {

/// Pairs of triangles that properly cross each other, by index. In doubles: touching (also at
/// copies of one knot) and overlap in a plane do not count.
std::vector<std::pair<Index, Index>> crossing_triangles(const mesh::EditableMesh& mesh,
                                                        const Knots& knots,
                                                        const parallel::Workers& workers);

/// Whether two triangles do.
bool properly_cross(const mesh::EditableMesh& mesh, const Knots& knots, Index t, Index u);

}  // namespace nonobtuse::refine
