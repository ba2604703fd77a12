// Sweeps of local relaxation and flips over the last triangles outside the bounds.
#pragma once

#include <functional>

#include "mesh/editable_mesh.h"
#include "parallel/workers.h"
#include "refine/angle_goal.h"
#include "refine/fidelity.h"
#include "refine/trials.h"

namespace nonobtuse::refine {

/// Relaxes and flips around the triangles outside `goal` (aiming two degrees inside) until there
/// are none or nothing helps any more; keeps the best state by (triangles outside the promise,
/// triangles outside the goal). `keep_going(fraction)` is asked once per sweep; the budget bounds
/// the last resorts; `circumcentre` is that term's weight. Returns the number of triangles left
/// outside `goal`.
Index sweep_angles(mesh::EditableMesh& mesh, Fidelity& fidelity, const AngleGoal& goal,
                   bool on_surface, const parallel::Workers& workers,
                   const std::function<bool(double)>& keep_going, TrialBudget* budget = nullptr,
                   double circumcentre = 1);

}  // namespace nonobtuse::refine
