// The largest distances, one place at a time: once all angles are in order, the few points of
// either side that are farthest from the other get more weight and their surroundings relax.
#pragma once

#include <functional>

#include "refine/trials.h"

namespace nonobtuse::refine {

/// Lowers the largest distance without letting more triangles leave `options.goal`; keeps the best
/// state. Only places farther than a few times the mean distance are touched.
void polish_distance(mesh::EditableMesh& mesh, Fidelity& fidelity, const TrialOptions& options,
                     const parallel::Workers& workers,
                     const std::function<bool(double)>& keep_going);

}  // namespace nonobtuse::refine
