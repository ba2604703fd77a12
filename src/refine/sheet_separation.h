// Two sheets of the surface nearer to each other than the chord error of the mesh may cross in
// the mesh although its topology is right. Such places are found and the sheets pushed outwards.
#pragma once

#include <functional>
#include <utility>
#include <vector>

#include "refine/trials.h"

namespace nonobtuse::refine {

/// Pairs of triangles that properly cross each other, by index. In doubles: touching (also at
/// copies of one knot) and overlap in a plane do not count.
std::vector<std::pair<Index, Index>> crossing_triangles(const mesh::EditableMesh& mesh,
                                                        const Knots& knots,
                                                        const parallel::Workers& workers);

/// Pushes crossing sheets apart, a little farther out every round, while that lowers the number of
/// crossings and lets no more triangles leave `options.goal`. Returns the crossings left.
Index separate_sheets(mesh::EditableMesh& mesh, Fidelity& fidelity, const TrialOptions& options,
                      const parallel::Workers& workers,
                      const std::function<bool(double)>& keep_going);

}  // namespace nonobtuse::refine
