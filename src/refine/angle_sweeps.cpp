#include "refine/angle_sweeps.h"

#include <algorithm>

#include "refine/flips.h"
#include "refine/last_resorts.h"
#include "refine/neighborhood.h"
#include "refine/relaxation.h"

namespace nonobtuse::refine {
namespace {

constexpr int kRounds = 3;  // of last resorts
constexpr int kSweeps = 20;
constexpr int kPatience = 3;  // sweeps without fewer triangles outside
constexpr double kHinge = 100;
// Local edits mend places, not whole meshes: with more triangles outside the goal than this many,
// or this part of all, only those that break the promise are tried.
constexpr std::size_t kManyOutside = 50;
constexpr double kManyOutsidePart = 0.02;

// Relaxes and flips until no triangle is outside `aim` or patience ends; while nothing helps the
// hinge grows.
void sweep(mesh::EditableMesh& mesh, Fidelity& fidelity, const AngleGoal& aim,
           RelaxationOptions options, double hinge_growth, const parallel::Workers& workers,
           const std::function<bool(double)>& keep_going) {
  const AngleTest test(aim);
  const AngleTest promise(kPromise);
  const auto worth = [&](const std::vector<Index>& outside) {
    const auto broken = std::count_if(outside.begin(), outside.end(),
                                      [&](Index t) { return !promise.inside(mesh, t); });
    return std::pair(broken, outside.size());
  };
  std::vector<Index> bad = triangles_outside(mesh, test);
  if (bad.empty()) return;
  std::size_t least = bad.size();
  auto best_worth = worth(bad);
  mesh::EditableMesh best_mesh = mesh;
  Fidelity best_fidelity = fidelity;
  for (int sweep = 0, idle = 0; sweep < kSweeps && idle < kPatience && !bad.empty(); ++sweep) {
    if (!keep_going(static_cast<double>(sweep) / kSweeps)) break;
    std::vector<Index> active = dilated(mesh, bad, 2);
    fidelity.knots.add_copies(mesh, active);
    relax(mesh, fidelity, active, options, workers);
    const std::vector<Index> touched = triangles_around(mesh, active);
    fidelity.rewalk(mesh, touched);
    flip_edges(mesh, fidelity, options.shape, &touched);
    bad = triangles_outside(mesh, test);
    idle = bad.size() < least ? 0 : idle + 1;
    if (idle > 0) options.shape.hinge *= hinge_growth;
    least = std::min(least, bad.size());
    // On a tie the later state: it is the more relaxed one.
    if (const auto now = worth(bad); now <= best_worth) {
      best_worth = now;
      best_mesh = mesh;
      best_fidelity = fidelity;
    }
  }
  if (worth(bad) > best_worth) {
    mesh = std::move(best_mesh);
    fidelity = std::move(best_fidelity);
  }
}

}  // namespace

Index sweep_angles(mesh::EditableMesh& mesh, Fidelity& fidelity, const AngleGoal& goal,
                   bool on_surface, const parallel::Workers& workers,
                   const std::function<bool(double)>& keep_going, TrialBudget* budget,
                   double circumcentre) {
  RelaxationOptions options;
  options.gauss_newton = !fidelity.knots.empty();
  options.on_surface = on_surface;
  options.shape = energy::hinged(kHinge, goal.smallest + 3, goal.largest - 3);
  options.shape.circumcentre = circumcentre;
  sweep(mesh, fidelity, {goal.smallest + 2, goal.largest - 2}, options, 1, workers,
        [&](double f) { return keep_going(0.4 * f); });
  const AngleTest test(goal);
  TrialOptions trial;
  trial.goal = goal;
  trial.budget = budget;
  trial.shape = options.shape = energy::hinged(kHinge, goal.smallest + 1, goal.largest - 1);
  trial.shape.circumcentre = options.shape.circumcentre = circumcentre;
  trial.on_surface = on_surface;
  // What is still outside the goal itself may cost some fidelity, then other connectivity.
  for (int round = 0; round < kRounds; ++round) {
    sweep(mesh, fidelity, goal, options, 3, workers,
          [&](double f) { return keep_going(0.4 + 0.2 * round + 0.1 * f); });
    std::vector<Index> bad = triangles_outside(mesh, test);
    if (static_cast<double>(bad.size()) >
        std::max<double>(kManyOutside, kManyOutsidePart * mesh.triangle_count()))
      bad = triangles_outside(mesh, AngleTest(trial.promise));
    if (bad.empty()) break;
    if (mend_triangles(mesh, fidelity, bad, trial, workers,
                       [&] { return keep_going(0.5 + 0.2 * round); }) == 0 &&
        round > 0)
      break;
    trial.shape.hinge *= 10;
  }
  return static_cast<Index>(triangles_outside(mesh, test).size());
}

}  // namespace nonobtuse::refine
