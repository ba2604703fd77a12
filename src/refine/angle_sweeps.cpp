#include "refine/angle_sweeps.h"

#include <algorithm>

#include "refine/flips.h"
#include "refine/last_resorts.h"
#include "refine/relaxation.h"

namespace nonobtuse::refine {
namespace {

constexpr int kRounds = 4;  // of last resorts
constexpr int kSweeps = 20;
constexpr int kPatience = 3;  // sweeps without fewer triangles outside
constexpr double kHinge = 100;

// Vertices of the triangles and of `rings` rings around them, by index.
std::vector<Index> dilated(const mesh::EditableMesh& mesh, const std::vector<Index>& triangles,
                           int rings) {
  std::vector<Index> vertices;
  for (Index t : triangles)
    for (Index v : mesh.triangle(t)) vertices.push_back(v);
  const auto make_unique = [&] {
    std::sort(vertices.begin(), vertices.end());
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  };
  make_unique();
  for (int ring = 0; ring < rings; ++ring) {
    const std::size_t count = vertices.size();
    for (std::size_t i = 0; i < count; ++i)
      for_ring(mesh, vertices[i], [&](Index t, int) {
        for (Index v : mesh.triangle(t)) vertices.push_back(v);
      });
    make_unique();
  }
  return vertices;
}

std::vector<Index> triangles_of(const mesh::EditableMesh& mesh,
                                const std::vector<Index>& vertices) {
  std::vector<Index> triangles;
  for (Index v : vertices) for_ring(mesh, v, [&](Index t, int) { triangles.push_back(t); });
  std::sort(triangles.begin(), triangles.end());
  triangles.erase(std::unique(triangles.begin(), triangles.end()), triangles.end());
  return triangles;
}

}  // namespace

namespace {

using Counts = std::pair<std::size_t, std::size_t>;  // outside the promise, outside the goal

Counts count_outside(const mesh::EditableMesh& mesh, const AngleGoal& goal) {
  return {triangles_outside(mesh, AngleTest(kPromise)).size(),
          triangles_outside(mesh, AngleTest(goal)).size()};
}

// Relaxes and flips until no triangle is outside `aim` or patience ends; while nothing helps the
// hinge grows.
void sweep(mesh::EditableMesh& mesh, Fidelity& fidelity, const AngleGoal& aim,
           RelaxationOptions options, double hinge_growth, const parallel::Workers& workers,
           const std::function<bool(double)>& keep_going) {
  const AngleTest test(aim);
  std::vector<Index> bad = triangles_outside(mesh, test);
  std::size_t least = bad.size();
  for (int sweep = 0, idle = 0; sweep < kSweeps && idle < kPatience && !bad.empty(); ++sweep) {
    if (!keep_going(static_cast<double>(sweep) / kSweeps)) return;
    const std::vector<Index> active = dilated(mesh, bad, 2);
    relax(mesh, fidelity, active, options, workers);
    const std::vector<Index> touched = triangles_of(mesh, active);
    fidelity.rewalk(mesh, touched);
    flip_edges(mesh, fidelity, options.shape, &touched);
    bad = triangles_outside(mesh, test);
    idle = bad.size() < least ? 0 : idle + 1;
    if (idle > 0) options.shape.hinge *= hinge_growth;
    least = std::min(least, bad.size());
  }
}

}  // namespace

Index sweep_angles(mesh::EditableMesh& mesh, Fidelity& fidelity, const AngleGoal& goal,
                   bool on_surface, const parallel::Workers& workers,
                   const std::function<bool(double)>& keep_going) {
  RelaxationOptions options;
  options.on_surface = on_surface;
  options.shape = energy::hinged(kHinge, goal.smallest + 3, goal.largest - 3);
  sweep(mesh, fidelity, {goal.smallest + 2, goal.largest - 2}, options, 1, workers,
        [&](double f) { return keep_going(0.4 * f); });
  // What is still outside the goal itself may cost some fidelity.
  options.shape = energy::hinged(kHinge, goal.smallest + 1, goal.largest - 1);
  sweep(mesh, fidelity, goal, options, 3, workers,
        [&](double f) { return keep_going(0.4 + 0.1 * f); });
  const AngleTest test(goal);
  TrialOptions trial;
  trial.goal = goal;
  trial.shape = energy::hinged(kHinge, goal.smallest + 2, goal.largest - 2);
  trial.on_surface = on_surface;
  for (int round = 0; round < kRounds; ++round) {
    const std::vector<Index> bad = triangles_outside(mesh, test);
    if (bad.empty()) return 0;
    const Counts before = count_outside(mesh, goal);
    if (mend_triangles(mesh, fidelity, bad, trial, workers,
                       [&] { return keep_going(0.5 + 0.1 * round); }) == 0)
      break;
    if (!(count_outside(mesh, goal) < before)) break;
  }
  return static_cast<Index>(triangles_outside(mesh, test).size());
}

}  // namespace nonobtuse::refine
