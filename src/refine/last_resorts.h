// For triangles that relaxation does not bring inside the bounds: flips with their consequences,
// and a vertex more or less here for one less or more elsewhere; each on a copy, kept only if it
// helps.
#pragma once

#include <functional>
#include <vector>

#include "refine/trials.h"

namespace nonobtuse::refine {

/// Tries to mend the given triangles one after another. Valences and the number of vertices are
/// kept; a change is accepted only if it lowers (triangles outside the promise, outside the goal)
/// of its neighbourhood and folds nothing. `keep_going` is asked once per triangle. Returns the
/// number of changes.
Index mend_triangles(mesh::EditableMesh& mesh, Fidelity& fidelity,
                     const std::vector<Index>& triangles, const TrialOptions& options,
                     const parallel::Workers& workers, const std::function<bool()>& keep_going);

}  // namespace nonobtuse::refine
