#include "refine/angle_sweeps.h"

#include <algorithm>

#include "refine/flips.h"
#include "refine/relaxation.h"

namespace nonobtuse::refine {
namespace {

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

Index sweep_angles(mesh::EditableMesh& mesh, Fidelity& fidelity, const AngleGoal& goal,
                   bool on_surface, const parallel::Workers& workers,
                   const std::function<bool(double)>& keep_going) {
  const AngleTest aim({goal.smallest + 2, goal.largest - 2}), test(goal);
  RelaxationOptions options;
  options.on_surface = on_surface;
  options.shape = energy::hinged(kHinge, goal.smallest + 3, goal.largest - 3);
  std::vector<Index> bad = triangles_outside(mesh, aim);
  std::size_t least = bad.size();
  for (int sweep = 0, idle = 0; sweep < kSweeps && idle < kPatience && !bad.empty(); ++sweep) {
    if (!keep_going(static_cast<double>(sweep) / kSweeps)) break;
    const std::vector<Index> active = dilated(mesh, bad, 2);
    relax(mesh, fidelity, active, options, workers);
    std::vector<Index> touched = triangles_of(mesh, active);
    fidelity.rewalk(mesh, touched);
    flip_edges(mesh, fidelity, options.shape, &touched);
    bad = triangles_outside(mesh, aim);
    idle = bad.size() < least ? 0 : idle + 1;
    least = std::min(least, bad.size());
  }
  return static_cast<Index>(triangles_outside(mesh, test).size());
}

}  // namespace nonobtuse::refine
