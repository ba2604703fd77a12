// Two sheets of the surface nearer to each other than the chord error of the mesh may cross in
// the mesh although its topology is right. Such places are found and the sheets pushed outwards.
#pragma once

#include <functional>

#include "refine/trials.h"

namespace nonobtuse::refine {

/// Pushes crossing sheets apart, a little farther out every round, while that lowers the number of
/// crossings and lets no more triangles leave `options.goal`. Returns the crossings left.
Index separate_sheets(mesh::EditableMesh& mesh, Fidelity& fidelity, const TrialOptions& options,
                      const parallel::Workers& workers,
                      const std::function<bool(double)>& keep_going);

}  // namespace nonobtuse::refine
