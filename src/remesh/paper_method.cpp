#include "remesh/paper_method.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "energy/short_dual_penalty.h"
#include "energy/triangle_penalties.h"
#include "numeric/vec3.h"
#include "optimize/lbfgs.h"
#include "remesh/extraction.h"
#include "remesh/restricted_diagram.h"
#include "remesh/surface_projection.h"
#include "remesh/valence_optimization.h"
#include "remesh/valence_resampling.h"

namespace nonobtuse::pipeline {

namespace {

// What is best: fewest cells that are no discs (there the triangles are no manifold), then fewest
// obtuse triangles, then fewest small angles, then least energy.
struct Score {
  std::size_t defects = 0;
  Index obtuse = 0;
  Index small = 0;
  double energy = 0;

  friend bool operator<(const Score& a, const Score& b) {
    return std::tie(a.defects, a.obtuse, a.small, a.energy) <
           std::tie(b.defects, b.obtuse, b.small, b.energy);
  }
};

struct Evaluation {
  Score score;
  std::vector<Vec3> gradient;    // tangential
  std::vector<double> diagonal;  // of the Hessian, positive
  std::vector<double> mass;      // cells' areas
  std::vector<Index> blocked;    // sites of defective cells and their neighbours
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

std::vector<Index> blocked_sites(const RestrictedDiagram& diagram) {
  if (diagram.defects.empty()) return {};
  std::vector<bool> defective(diagram.cells.mass.size(), false);
  for (const rdt::DefectiveCell& d : diagram.defects) defective[d.site] = true;
  std::vector<Index> blocked;
  for (const rdt::DefectiveCell& d : diagram.defects) blocked.push_back(d.site);
  for (const rvd::DualEdge& e : diagram.edges) {
    if (defective[e.site]) blocked.push_back(e.other);
    if (defective[e.other]) blocked.push_back(e.site);
  }
  return blocked;
}

// The CVT energy with its penalties.
class PenalizedEnergy {
 public:
  PenalizedEnergy(const mesh::Surface& surface, const PaperOptions& options,
                  const parallel::Workers& workers)
      : surface_(surface), options_(options), workers_(workers) {}

  [[nodiscard]] Evaluation evaluate(const PlacedSites& x) {
    const RestrictedDiagram diagram = restricted_diagram(surface_, x.sites, workers_);
    const rvd::CellSums& cells = diagram.cells;
    const std::size_t n = x.sites.size();
    if (hinge_scale_ < 0) hinge_scale_ = 6.23 * cells.energy / static_cast<double>(n);
    Evaluation result{.score = {.defects = diagram.defects.size(), .energy = cells.energy},
                      .gradient = std::vector<Vec3>(n),
                      .diagonal = std::vector<double>(n),
                      .mass = cells.mass,
                      .blocked = blocked_sites(diagram)};
    for (std::size_t i = 0; i < n; ++i) {
      result.gradient[i] = 2 * cells.mass[i] * (x.sites[i] - cells.centroid[i]);
      result.diagonal[i] = 2 * cells.mass[i];
    }
    add_penalties(x, diagram, result);
    for (std::size_t i = 0; i < n; ++i)
      result.gradient[i] -= dot(result.gradient[i], x.normals[i]) * x.normals[i];
    count_bad_triangles(x.sites, diagram.triangles, result.score);
    return result;
  }

 private:
  void add_penalties(const PlacedSites& x, const RestrictedDiagram& diagram,
                     Evaluation& result) const {
    const double unit = surface_.area / static_cast<double>(x.sites.size());
    if (options_.short_dual > 0) {
      const std::vector<double> weights =
          energy::short_dual_weights(x.sites, diagram.edges, options_.relative_epsilon);
      std::span<const Vec3> normals;
      if (options_.tangential) normals = x.normals;
      result.score.energy += energy::add_short_dual_penalty(x.sites, diagram.edges, weights,
                                                            normals, options_.short_dual * unit,
                                                            result.gradient, result.diagonal);
    }
    if (options_.circumcentre > 0 || options_.hinge > 0) {
      const energy::ShapeWeights weights{
          0, options_.circumcentre * unit, options_.hinge * hinge_scale_,
          energy::cos_degrees(options_.hinge_large), energy::cos_degrees(options_.hinge_small)};
      result.score.energy += energy::add_triangle_penalties(x.sites, diagram.triangles, weights,
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

// L-BFGS with every trial step on the surface; returns the best sites seen.
PlacedSites minimize(PlacedSites start, int iterations, const SurfaceProjection& projection,
                     PenalizedEnergy& energy, const parallel::Workers& workers,
                     parallel::Monitor& monitor) {
  Iterate at{std::move(start), {}};
  at.evaluation = energy.evaluate(at.placed);
  PlacedSites best = at.placed;
  Score best_score = at.evaluation.score;
  Patience patience(best_score);
  optimize::LbfgsHistory history(7);
  for (int iteration = 0; iteration < iterations; ++iteration) {
    const double done = static_cast<double>(iteration) / iterations;
    if (!monitor.tick(done, best_score.obtuse)) break;
    const std::vector<Vec3> direction = step_direction(history, at.placed, at.evaluation, workers);
    Iterate next = line_search(at, direction, projection, energy, workers);
    history.add(differences(next.placed.sites, at.placed.sites),
                differences(next.evaluation.gradient, at.evaluation.gradient), workers);
    at = std::move(next);
    if (at.evaluation.score < best_score) {
      best_score = at.evaluation.score;
      best = at.placed;
    }
    if (patience.exhausted(best_score)) break;
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
  optimize_valence(surface, extraction.mesh, workers, monitor);
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
  PenalizedEnergy energy(surface, options, workers);
  return minimize(std::move(placed), options.iterations, projection, energy, workers, monitor)
      .sites;
}

}  // namespace nonobtuse::pipeline
