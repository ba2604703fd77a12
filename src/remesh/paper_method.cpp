#include "remesh/paper_method.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>
#include <utility>

#include "energy/angle_hinge_rvd.h"
#include "energy/circumcentre_rvd.h"
#include "energy/short_dual_penalty.h"
#include "numeric/vec3.h"
#include "optimize/lbfgs.h"
#include "remesh/restricted_diagram.h"
#include "remesh/surface_projection.h"
#include "remesh/valence_resampling.h"

namespace nonobtuse::remesh {

namespace {

// What is best: fewest obtuse triangles, then fewest small angles, then least energy.
struct Score {
  Index obtuse = 0;
  Index small = 0;
  double energy = 0;

  friend bool operator<(const Score& a, const Score& b) {
    return std::tie(a.obtuse, a.small, a.energy) < std::tie(b.obtuse, b.small, b.energy);
  }
};

struct Evaluation {
  Score score;
  std::vector<Vec3> gradient;    // tangential
  std::vector<double> diagonal;  // of the Hessian, positive
  std::vector<double> mass;      // cells' areas
};

// Triangles with an angle above 90 and below 30 degrees. In doubles: this only ranks iterates.
void count_bad_triangles(std::span<const Vec3> sites, std::span<const Triangle> triangles,
                         Score& score) {
  for (const Triangle& t : triangles) {
    bool obtuse = false;
    bool small = false;
    for (int k = 0; k < 3; ++k) {
      const Vec3& apex = sites[t[k]];
      const Vec3 u = sites[t[(k + 1) % 3]] - apex;
      const Vec3 v = sites[t[(k + 2) % 3]] - apex;
      const double c = dot(u, v);
      obtuse |= c <= 0;
      small |= c > 0 && c * c > 0.75 * squared_length(u) * squared_length(v);
    }
    score.obtuse += obtuse;
    score.small += small;
  }
}

// The CVT energy with its penalties.
class PenalizedEnergy {
 public:
  PenalizedEnergy(const mesh::Surface& surface, const PaperOptions& options,
                  const parallel::Workers& workers)
      : surface_(surface), options_(options), workers_(workers) {}

  [[nodiscard]] Evaluation evaluate(const PlacedSites& x) {
    RestrictedDiagram cells = restricted_diagram(surface_, x.sites, workers_);
    const std::size_t n = x.sites.size();
    if (hinge_scale_ < 0) hinge_scale_ = options_.hinge * 6.23 * cells.energy / n;
    Evaluation result{{0, 0, cells.energy}, std::vector<Vec3>(n), std::vector<double>(n), {}};
    for (std::size_t i = 0; i < n; ++i) {
      result.gradient[i] = 2 * cells.mass[i] * (x.sites[i] - cells.centroid[i]);
      result.diagonal[i] = 2 * cells.mass[i];
    }
    add_penalties(x, cells.edges, cells.triangles, result);
    for (std::size_t i = 0; i < n; ++i)
      result.gradient[i] -= dot(result.gradient[i], x.normals[i]) * x.normals[i];
    count_bad_triangles(x.sites, cells.triangles, result.score);
    result.mass = std::move(cells.mass);
    return result;
  }

 private:
  void add_penalties(const PlacedSites& x, std::span<const energy::DualEdge> edges,
                     std::span<const Triangle> triangles, Evaluation& result) const {
    const double unit = surface_.area / static_cast<double>(x.sites.size());
    if (options_.short_dual > 0) {
      const std::vector<double> weights =
          energy::short_dual_weights(x.sites, edges, options_.relative_epsilon);
      std::span<const Vec3> normals;
      if (options_.tangential) normals = x.normals;
      result.score.energy +=
          energy::add_short_dual_penalty(x.sites, edges, weights, normals,
                                         options_.short_dual * unit, result.gradient,
                                         result.diagonal);
    }
    if (options_.circumcentre > 0)
      result.score.energy +=
          energy::add_circumcentre_term(x.sites, triangles, options_.circumcentre * unit,
                                        result.gradient, result.diagonal);
    if (options_.hinge > 0) {
      const double degree = std::numbers::pi / 180;
      const energy::HingeThresholds limits{std::cos(options_.hinge_large * degree),
                                           std::cos(options_.hinge_small * degree)};
      result.score.energy += energy::add_angle_hinge(x.sites, triangles, limits, hinge_scale_,
                                                     result.gradient, result.diagonal);
    }
  }

  const mesh::Surface& surface_;
  const PaperOptions& options_;
  const parallel::Workers& workers_;
  double hinge_scale_ = -1;  // from the first CVT energy: the same function at every evaluation
};

// The L-BFGS direction in the tangent planes, no site moved by more than half of its cell's size:
// penalties are stiff where triangles are bad, and a long step there only flips them.
std::vector<Vec3> step_direction(const optimize::LbfgsHistory& history, const PlacedSites& at,
                                 const Evaluation& here, const parallel::Workers& workers) {
  std::vector<Vec3> d(at.sites.size());
  history.direction(
      here.gradient, d,
      [&](std::span<const Vec3> in, std::span<Vec3> out) {
        for (std::size_t i = 0; i < in.size(); ++i)
          out[i] = here.diagonal[i] > 0 ? in[i] / here.diagonal[i] : Vec3{};
      },
      workers);
  for (std::size_t i = 0; i < d.size(); ++i) {
    d[i] -= dot(d[i], at.normals[i]) * at.normals[i];
    const double limit = 0.5 * std::sqrt(here.mass[i]);
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

}  // namespace

std::vector<Vec3> optimize_paper_nob(const mesh::Surface& surface, std::vector<Vec3> sites,
                                     const PaperOptions& options, const parallel::Workers& workers,
                                     parallel::Monitor& monitor) {
  const SurfaceProjection projection(surface, workers);
  PenalizedEnergy energy(surface, options, workers);
  PlacedSites at = projection.place(sites);
  const Index left = resample_bad_valences(surface, projection, at, options.valence_rounds,
                                           options.seed, workers, monitor);
#ifdef PAPER_STANDIN
  fprintf(stderr, "bad valences left %d\n", left);
#endif
  Evaluation here = energy.evaluate(at);
  PlacedSites best = at;
  Score best_score = here.score;
  optimize::LbfgsHistory history(7);
  for (int iteration = 0; iteration < options.iterations; ++iteration) {
    const double done = static_cast<double>(iteration) / options.iterations;
    if (!monitor.tick(done, best_score.obtuse)) break;
    const std::vector<Vec3> direction = step_direction(history, at, here, workers);
    const double slope = optimize::dot(here.gradient, direction, workers);
    // Armijo's rule; after a few halvings the step is taken all the same, since the penalty may
    // have jumped at a flip and the next evaluation starts afresh.
    double step = 1;
    PlacedSites trial = projection.step(at, direction, step);
    Evaluation there = energy.evaluate(trial);
    for (int halvings = 0;
         halvings < kMaxHalvings && !(there.score.energy <= here.score.energy + 1e-4 * step * slope);
         ++halvings) {
      step *= 0.5;
      trial = projection.step(at, direction, step);
      there = energy.evaluate(trial);
    }
    history.add(differences(trial.sites, at.sites), differences(there.gradient, here.gradient),
                workers);
    at = std::move(trial);
    here = std::move(there);
    if (here.score < best_score) {
      best_score = here.score;
      best = at;
    }
#ifdef PAPER_STANDIN
    fprintf(stderr, "it %d step %g E %.6f obtuse %d small %d\n", iteration, step, here.score.energy,
            here.score.obtuse, here.score.small);
#endif
  }
  return best.sites;
}

}  // namespace nonobtuse::remesh
