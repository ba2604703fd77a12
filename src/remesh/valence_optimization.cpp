// The paper resamples a vertex of bad valence at random in its ring; that does not always end.
// Here the connectivity is edited deliberately, on copies of the neighbourhood, and a sequence of
// edits is kept if it lowers the defect and the relaxed neighbourhood is sound.
#include "remesh/valence_optimization.h"

#include <cstdint>

#include "refine/angle_goal.h"
#include "refine/valence_mending.h"

namespace nonobtuse::pipeline {
namespace {

constexpr Index kSamplesPerVertex = 3;
// Budget of the trials beside creases and boundaries.
constexpr std::int64_t kTrialWork = 40000;
constexpr std::int64_t kTrialWorkPerVertex = 200;
constexpr Index kManyVertices = 10000;  // whose places are not searched again and again

}  // namespace

Index optimize_valence(const mesh::Surface& surface, const spatial::TriangleBvh& bvh,
                       mesh::EditableMesh& mesh, const parallel::Workers& workers,
                       parallel::Monitor& monitor, mesh::CurveNetwork* curves) {
  refine::ValenceRule rule;
  rule.measure(mesh);
  const auto initial = static_cast<double>(refine::bad_valences(mesh, rule).size());
  if (initial == 0) return 0;
  // Few samples are enough to hold tips and ridges. Planes are searched where edits happen.
  refine::Fidelity fidelity(surface, bvh);
  if (!surface.size.empty()) fidelity.size.measure(mesh);
  fidelity.attach_curves(mesh, curves, workers);
  fidelity.samples = refine::sample_surface(surface, kSamplesPerVertex * mesh.vertex_count());
  fidelity.search_samples(mesh, workers);
  fidelity.vertex_planes.resize(mesh.vertex_capacity());
  fidelity.vertex_weights.resize(mesh.vertex_capacity());
  fidelity.edge_planes.resize(mesh.triangle_capacity());
  fidelity.edge_weights.resize(mesh.triangle_capacity());
  refine::TrialOptions options;
  options.shape = energy::hinged(10, 35, 86);
  options.goal = {35, 86};
  refine::TrialBudget budget(kTrialWork + kTrialWorkPerVertex * mesh.vertex_count());
  if (mesh.vertex_count() > kManyVertices) budget.places.emplace();
  if (curves) options.budget = &budget;
  double attempts = 0;
  const Index left = refine::mend_valences(mesh, fidelity, options, false, workers, [&] {
    attempts += 1;
    return monitor.tick_counting(attempts / (attempts + initial),
                                 [&] { return refine::count_obtuse(mesh); });
  });
  if (curves) fidelity.knots.store(*curves);
  mesh.compact();
  return left;
}

}  // namespace nonobtuse::pipeline
