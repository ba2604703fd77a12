#include "refine/sheet_separation.h"

#include <algorithm>
#include <cmath>

#include "refine/crossing_triangles.h"
#include "refine/neighborhood.h"
#include "refine/relaxation.h"

namespace nonobtuse::refine {
namespace {

constexpr int kRounds = 8;
constexpr double kPush = 0.04;  // outwards per round, where the size is 1
constexpr double kEmphasis = 2;

}  // namespace

Index separate_sheets(mesh::EditableMesh& mesh, Fidelity& fidelity, const TrialOptions& options,
                      const parallel::Workers& workers,
                      const std::function<bool(double)>& keep_going) {
  const AngleTest goal(options.goal);
  std::vector<std::pair<Index, Index>> pairs = crossing_triangles(mesh, fidelity.knots, workers);
  if (pairs.empty()) return 0;
  const std::size_t outside = triangles_outside(mesh, goal).size();
  std::size_t least = pairs.size();
  mesh::EditableMesh best_mesh = mesh;
  Fidelity best_fidelity = fidelity;
  for (int round = 0; round < kRounds && !pairs.empty(); ++round) {
    if (!keep_going(static_cast<double>(round) / kRounds)) break;
    std::vector<Index> places;
    for (const auto& [a, b] : pairs) places.push_back(a), places.push_back(b);
    sort_unique(places);
    for (Index t : places) {
      for (TangentPlane& plane : fidelity.edge_planes[t])
        plane.push_out(kPush * std::sqrt(fidelity.size.area(mesh.triangle(t))), kEmphasis);
      fidelity.update_triangle(mesh, t);
    }
    for (Index v : dilated(mesh, places, 0)) {
      fidelity.vertex_planes[v].push_out(kPush * fidelity.size.at(v), kEmphasis);
      fidelity.update_vertex(mesh, v);
    }
    std::vector<Index> active = dilated(mesh, places, 2);
    fidelity.knots.add_copies(mesh, active);
    relax(mesh, fidelity, active, {options.shape, 6, options.on_surface}, workers);
    fidelity.rewalk(mesh, triangles_around(mesh, active));
    pairs = crossing_triangles(mesh, fidelity.knots, workers);
    if (pairs.size() >= least || triangles_outside(mesh, goal).size() > outside) continue;
    least = pairs.size();
    best_mesh = mesh;
    best_fidelity = fidelity;
  }
  mesh = std::move(best_mesh);
  fidelity = std::move(best_fidelity);
  return static_cast<Index>(least);
}

}  // namespace nonobtuse::refine
