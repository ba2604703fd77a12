#include "remesh/paper_method.h"

#include <cmath>
#include <tuple>
#include <utility>

#include "numeric/symmetric_matrix.h"
#include "numeric/vec3.h"
#include "optimize/lbfgs.h"
#include "remesh/extraction.h"
#include "remesh/penalized_energy.h"
#include "remesh/surface_projection.h"
#include "remesh/valence_optimization.h"
#include "remesh/valence_resampling.h"

namespace nonobtuse::pipeline {

namespace {

// The L-BFGS direction in the tangent planes, no site moved by more than half of its cell's size:
// penalties are stiff where triangles are bad, and a long step there only flips them.
std::vector<Vec3> step_direction(const optimize::LbfgsHistory& history, const PlacedSites& at,
                                 const Evaluation& here, const parallel::Workers& workers) {
  std::vector<Vec3> d(at.sites.size());
  history.direction(
      here.gradient, d,
      [&](std::span<const Vec3> in, std::span<Vec3> out) {
        for (std::size_t i = 0; i < in.size(); ++i)
          out[i] = numeric::solve_tangential(here.hessian[i], at.normals[i], in[i]);
      },
      workers);
  for (std::size_t i = 0; i < d.size(); ++i) {
    d[i] -= dot(d[i], at.normals[i]) * at.normals[i];
    const double limit = 0.5 * std::sqrt(here.cell_area[i]);
    const double l = length(d[i]);
    if (l > limit) d[i] *= limit / l;
  }
  return d;
}

std::vector<Vec3> differences(std::span<const Vec3> a, std::span<const Vec3> b) {
  std::vector<Vec3> d(a.size());
  for (std::size_t i = 0; i < a.size(); ++i) d[i] = a[i] - b[i];
  return d;
}

struct Iterate {
  PlacedSites placed;
  Evaluation evaluation;
};

// Where the surface is thin a step may let a cell reach through to the other side: the sites of
// such cells, and their neighbours, stay where they were.
void hold_blocked_sites(const Iterate& from, PenalizedEnergy& energy, Iterate& trial) {
  for (int attempt = 0; attempt < 3; ++attempt) {
    if (trial.evaluation.score.defects <= from.evaluation.score.defects) return;
    for (const Index i : trial.evaluation.blocked) {
      trial.placed.sites[i] = from.placed.sites[i];
      trial.placed.normals[i] = from.placed.normals[i];
    }
    trial.evaluation = energy.evaluate(trial.placed);
  }
}

// One step along the direction. Armijo's rule, but the step is taken after two halvings all the
// same: the gradient of Eq. 4 ignores how w changes, so that near the minimum the energy may rise
// however short the step (8 halvings cost twice the time and gained nothing).
Iterate line_search(const Iterate& from, std::span<const Vec3> direction,
                    const SurfaceProjection& projection, PenalizedEnergy& energy,
                    const parallel::Workers& workers) {
  constexpr int kMaxHalvings = 2;
  const double slope = optimize::dot(from.evaluation.gradient, direction, workers);
  Iterate trial;
  double step = 1;
  for (int halvings = 0; halvings <= kMaxHalvings; ++halvings, step *= 0.5) {
    trial.placed = projection.step(from.placed, direction, step);
    trial.evaluation = energy.evaluate(trial.placed);
    hold_blocked_sites(from, energy, trial);
    const double allowed = from.evaluation.score.energy + 1e-4 * step * slope;
    if (trial.evaluation.score.energy <= allowed) break;
  }
  return trial;
}

// Tells when nothing is left to gain: no bad triangle, and the best energy has not fallen by 1e-4
// of itself within five iterations.
class Patience {
 public:
  explicit Patience(const Score& start) : reference_(start) {}

  bool exhausted(const Score& best) {
    Score notable = reference_;
    notable.energy *= 1 - 1e-4;
    if (best < notable) {
      reference_ = best;
      waited_ = 0;
    } else {
      ++waited_;
    }
    return waited_ >= 5 && best.obtuse == 0 && best.small == 0;
  }

 private:
  Score reference_;
  int waited_ = 0;
};

// Which sites a descent returns.
enum class Keep { FewestBadTriangles, LeastEnergy };

// L-BFGS with every trial step on the surface; returns the best sites seen.
PlacedSites minimize(PlacedSites start, int iterations, const SurfaceProjection& projection,
                     PenalizedEnergy& energy, const parallel::Workers& workers,
                     parallel::Monitor& monitor, Keep keep = Keep::FewestBadTriangles) {
  const auto better = [keep](const Score& a, const Score& b) {
    if (keep == Keep::FewestBadTriangles) return a < b;
    return std::tie(a.defects, a.energy) < std::tie(b.defects, b.energy);
  };
  Iterate at{std::move(start), {}};
  at.evaluation = energy.evaluate(at.placed);
  PlacedSites best = at.placed;
  Score best_score = at.evaluation.score;
  Patience patience(best_score);
  optimize::LbfgsHistory history(7);
  const auto record = [&](int iteration) {
    const Score& s = at.evaluation.score;
    monitor.record(iteration, s.energy, s.obtuse, s.small);
  };
  record(0);
  for (int iteration = 0; iteration < iterations; ++iteration) {
    const double done = static_cast<double>(iteration) / iterations;
    if (!monitor.tick(done, best_score.obtuse)) break;
    const std::vector<Vec3> direction = step_direction(history, at.placed, at.evaluation, workers);
    Iterate next = line_search(at, direction, projection, energy, workers);
    history.add(differences(next.placed.sites, at.placed.sites),
                differences(next.evaluation.gradient, at.evaluation.gradient), workers);
    at = std::move(next);
    record(iteration + 1);
    if (better(at.evaluation.score, best_score)) {
      best_score = at.evaluation.score;
      best = at.placed;
    }
    if (keep == Keep::FewestBadTriangles && patience.exhausted(best_score)) break;
  }
  return best;
}

// The vertices of the sites' mesh once its valences are mended, on the surface; the sites as they
// were where that would cost the topology, since the mended mesh need not be the restricted
// Delaunay triangulation of its vertices.
PlacedSites mend_valences(const mesh::Surface& surface, const SurfaceProjection& projection,
                          PlacedSites placed, const parallel::Workers& workers,
                          parallel::Monitor& monitor) {
  Extraction extraction = extract(surface, placed.sites, workers, monitor);
  const spatial::TriangleBvh bvh(surface.vertices, surface.triangles, workers);
  optimize_valence(surface, bvh, extraction.mesh, workers, monitor);
  PlacedSites mended = projection.place(extraction.mesh.to_mesh().vertices);
  const auto defects = [&](const PlacedSites& x) {
    return restricted_diagram(surface, x.sites, workers).defects.size();
  };
  return defects(mended) <= defects(placed) ? std::move(mended) : std::move(placed);
}

}  // namespace

std::vector<Vec3> optimize_paper_nob(const mesh::Surface& surface, std::vector<Vec3> sites,
                                     const PaperOptions& options, const parallel::Workers& workers,
                                     parallel::Monitor& monitor) {
  const SurfaceProjection projection(surface, workers);
  PlacedSites placed = projection.place(sites);
  if (options.valence == ValenceStep::Edits)
    placed = mend_valences(surface, projection, std::move(placed), workers, monitor);
  if (options.valence == ValenceStep::Resampling)
    resample_bad_valences(surface, projection, placed, options.resampling_rounds, options.seed,
                          workers, monitor);
  PenalizedEnergy energy(surface, options.weights, workers);
  return minimize(std::move(placed), options.iterations, projection, energy, workers, monitor)
      .sites;
}

std::vector<Vec3> optimize_feature_sensitive(const mesh::Surface& surface, std::vector<Vec3> sites,
                                             const PenaltyWeights& weights, int iterations,
                                             const parallel::Workers& workers,
                                             parallel::Monitor& monitor) {
  const SurfaceProjection projection(surface, workers);
  PenalizedEnergy energy(surface, weights, workers);
  const Keep keep = weights.short_dual > 0 || weights.hinge > 0 || weights.circumcentre > 0
                        ? Keep::FewestBadTriangles
                        : Keep::LeastEnergy;
  return minimize(projection.place(sites), iterations, projection, energy, workers, monitor, keep)
      .sites;
}

}  // namespace nonobtuse::pipeline
