// The largest distances, one place at a time: once all angles are in order, the neighbourhoods of
// the points farthest from the other side are relaxed against just these, with other flips, or with
// a vertex more or less there for one less or more in a flat place.
#pragma once

#include <functional>

#include "refine/trials.h"

namespace nonobtuse::refine {

/// Lowers the largest distance; no valence gets worse and no more triangles leave `options.goal`.
/// Only places farther than a few times the mean distance are touched, and no more than a few of
/// them. `keep_going(fraction)` is asked once per place. Returns the number of changes.
Index mend_distance(mesh::EditableMesh& mesh, Fidelity& fidelity, const TrialOptions& options,
                    const parallel::Workers& workers,
                    const std::function<bool(double)>& keep_going);

}  // namespace nonobtuse::refine
