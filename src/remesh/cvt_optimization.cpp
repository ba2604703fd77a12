#include "remesh/cvt_optimization.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

#include "energy/cvt.h"
#include "optimize/lbfgs.h"
#include "remesh/initial_sampling.h"
#include "remesh/mass_balance.h"
#include "remesh/restricted_diagram.h"
#include "spatial/hilbert_order.h"

namespace nonobtuse::pipeline {
namespace {

constexpr std::size_t kChunk = 4096;
constexpr int kPairs = 7;
constexpr double kSufficientDecrease = 1e-4;
constexpr int kBacktracks = 5;
constexpr Index kFewestToQuarter = 64;
constexpr int kEvaluationsBeforeBalance = 3;

// A point of the descent with all that is known there.
struct Iterate {
  std::vector<Vec3> sites;
  rvd::CellIntegrals cells;
  std::vector<Vec3> gradient;
};

void evaluate(rvd::CellEvaluator& evaluator, Iterate& at, std::span<const char> fixed,
              const parallel::Workers& workers) {
  evaluator.evaluate(at.sites, at.cells);
  at.gradient.resize(at.sites.size());
  energy::cvt_gradient(at.sites, at.cells, at.gradient, workers);
  for (std::size_t i = 0; i < fixed.size(); ++i)
    if (fixed[i] != 0) at.gradient[i] = {};
}

std::vector<Vec3> difference(const std::vector<Vec3>& a, const std::vector<Vec3>& b,
                             const parallel::Workers& workers) {
  std::vector<Vec3> d(a.size());
  workers.for_each(a.size(), kChunk, [&](std::size_t i) { d[i] = a[i] - b[i]; });
  return d;
}

// The inverse of the Hessian's part that keeps the cells fixed, diag(2 m_i): Lloyd's step. Cells
// that are nearly empty count as a hundredth of the mean (with sizing: of what a cell of the right
// size has there), since their mass says nothing.
void divide_by_mass(const rvd::CellIntegrals& cells, std::span<const Vec3> in, std::span<Vec3> out,
                    const parallel::Workers& workers) {
  const double total = std::accumulate(cells.mass.begin(), cells.mass.end(), 0.0);
  const double least = 0.01 * total / static_cast<double>(cells.mass.size());
  if (!cells.expected_mass.empty()) {
    workers.for_each(in.size(), kChunk, [&](std::size_t i) {
      const double expected = cells.expected_mass[i] > 0 ? cells.expected_mass[i] : 100 * least;
      out[i] = in[i] / (2 * std::max(cells.mass[i], 0.01 * expected));
    });
    return;
  }
  workers.for_each(in.size(), kChunk,
                   [&](std::size_t i) { out[i] = in[i] / (2 * std::max(cells.mass[i], least)); });
}

}  // namespace

double minimize_cvt(rvd::CellEvaluator& evaluator, std::vector<Vec3>& sites, int evaluations,
                    double tolerance, const parallel::Workers& workers,
                    const std::function<bool(const DescentState&)>& callback,
                    std::span<const char> fixed) {
  optimize::LbfgsHistory history(kPairs);
  Iterate here;
  here.sites = sites;
  evaluate(evaluator, here, fixed, workers);
  Iterate trial;
  std::vector<Vec3> direction(sites.size());
  double step = 1;
  double energy_at_stride = here.cells.energy;
  for (int k = 1; k < evaluations; ++k) {
    if (callback && !callback({k, here.cells.energy, here.sites})) break;
    if (k % kStride == 0) {
      if (energy_at_stride - here.cells.energy < tolerance * here.cells.energy) break;
      energy_at_stride = here.cells.energy;
    }
    if (step == 1)
      history.direction(
          here.gradient, direction,
          [&](std::span<const Vec3> in, std::span<Vec3> out) {
            divide_by_mass(here.cells, in, out, workers);
          },
          workers);
    const double slope = optimize::dot(here.gradient, direction, workers);
    if (!(slope < 0)) break;  // stationary
    trial.sites.resize(sites.size());
    workers.for_each(sites.size(), kChunk,
                     [&](std::size_t i) { trial.sites[i] = here.sites[i] + step * direction[i]; });
    evaluate(evaluator, trial, fixed, workers);
    if (trial.cells.energy <= here.cells.energy + kSufficientDecrease * step * slope) {
      history.add(difference(trial.sites, here.sites, workers),
                  difference(trial.gradient, here.gradient, workers), workers);
      std::swap(here, trial);
      step = 1;
    } else if (step > std::ldexp(1.0, -kBacktracks)) {
      step /= 2;
    } else if (history.size() > 0) {
      history.clear();  // Lloyd's step, which comes next, cannot raise the energy
      step = 1;
    } else {
      break;  // rounding's floor
    }
  }
  sites = std::move(here.sites);
  return here.cells.energy;
}

namespace {

struct Sites {
  std::vector<Vec3> points;
  std::vector<Index> component;
};

// How many sites turn into the quota when the midpoints of all edges join them: V + E of a
// triangulation with Euler characteristic x and b boundary edges is 4 V - 3 x - b.
std::vector<Index> quarter(const std::vector<Index>& quota, const Components& components) {
  std::vector<Index> coarse;
  for (Index c = 0; c < components.count(); ++c) {
    if (quota[c] < kFewestToQuarter) {
      coarse.push_back(quota[c]);
      continue;
    }
    const double spacing = std::sqrt(2 / std::sqrt(3.0) * 4 * components.area[c] / quota[c]);
    const double b = components.boundary_length[c] / spacing;
    const double v = std::round((quota[c] + 3.0 * components.euler[c] + b) / 4);
    coarse.push_back(static_cast<Index>(std::clamp(v, 8.0, 0.5 * quota[c])));
  }
  return coarse;
}

void sort_along_curve(Sites& sites) {
  Sites sorted;
  for (const Index i : spatial::hilbert_order(sites.points)) {
    sorted.points.push_back(sites.points[i]);
    sorted.component.push_back(sites.component[i]);
  }
  sites = std::move(sorted);
}

struct Link {
  double length2;
  std::array<Index, 2> ends;
};

// Adds `wanted` points on the links of one component: their midpoints, without those of the
// shortest where there are too many; the longest get two where there are too few.
void insert_on_links(std::vector<Link> links, Index wanted, Index component, Sites& sites) {
  std::sort(links.begin(), links.end(), [](const Link& a, const Link& b) {
    return a.length2 != b.length2 ? a.length2 > b.length2 : a.ends < b.ends;
  });
  const auto available = static_cast<Index>(links.size());
  for (Index k = 0; k < std::min(available, wanted); ++k) {
    const Vec3 a = sites.points[links[k].ends[0]];
    const Vec3 b = sites.points[links[k].ends[1]];
    if (k < wanted - available) {
      sites.points.push_back((2.0 * a + b) / 3);
      sites.points.push_back((a + 2.0 * b) / 3);
      sites.component.push_back(component);
    } else {
      sites.points.push_back(0.5 * (a + b));
    }
    sites.component.push_back(component);
  }
}

// From the coarse sites to quota[c] sites on each component.
void insert_midpoints(const mesh::Surface& surface, const Components& components,
                      const std::vector<Index>& quota, std::uint64_t seed,
                      const std::vector<std::array<Index, 2>>& adjacent, Sites& sites) {
  std::vector<Index> missing = quota;
  for (const Index c : sites.component) --missing[c];
  std::vector<std::vector<Link>> links(components.count());
  for (const auto& [i, j] : adjacent)
    if (sites.component[i] == sites.component[j])
      links[sites.component[i]].push_back(
          {squared_distance(sites.points[i], sites.points[j]), {i, j}});
  for (Index c = 0; c < components.count(); ++c) {
    const Index wanted = std::min(missing[c], 2 * static_cast<Index>(links[c].size()));
    insert_on_links(std::move(links[c]), wanted, c, sites);
    missing[c] -= wanted;
  }
  // Cells without neighbours, as with too few sites: fresh samples.
  if (std::any_of(missing.begin(), missing.end(), [](Index m) { return m > 0; })) {
    const SampledSites more = sample_strata(surface, components, missing, seed + 1);
    sites.points.insert(sites.points.end(), more.points.begin(), more.points.end());
    sites.component.insert(sites.component.end(), more.component.begin(), more.component.end());
  }
  sort_along_curve(sites);
}

bool is_started(const CvtOptions& options, const std::vector<Index>& quota) {
  return quota.size() == 1 && static_cast<Index>(options.start.sites.size()) == quota[0];
}

Sites first_sites(const mesh::Surface& surface, const Components& components,
                  const std::vector<Index>& quota, const CvtOptions& options) {
  if (is_started(options, quota))
    return {options.start.sites, std::vector<Index>(options.start.sites.size(), 0)};
  SampledSites samples = sample_strata(surface, components, quota, options.seed);
  return {std::move(samples.points), std::move(samples.component)};
}

// Ever more rarely, since the exact diagram takes several times as long as an evaluation.
bool is_recorded(int iteration) {
  return iteration <= 20 || (iteration <= 100 && iteration % 5 == 0) || iteration % 50 == 0;
}

// Notes the energy and, from the exact diagram, the bad triangles.
void record(const mesh::Surface& surface, const DescentState& state,
            const parallel::Workers& workers, parallel::Monitor& monitor) {
  if (!monitor.recording()) return;
  const RestrictedDiagram diagram = restricted_diagram(surface, state.sites, workers);
  const BadTriangles bad = count_bad_triangles(state.sites, diagram.triangles);
  monitor.record(state.evaluations - 1, state.energy, bad.obtuse, bad.small);
}

// One level: how far to descend, and what of the progress it is.
struct Level {
  int evaluations;
  double tolerance;
  bool recorded;
  double from, to;
};

double descend(const mesh::Surface& surface, rvd::CellEvaluator& evaluator,
               std::vector<Vec3>& sites, const Level& level, const parallel::Workers& workers,
               parallel::Monitor& monitor) {
  int made = 1;
  const double energy =
      minimize_cvt(evaluator, sites, level.evaluations, level.tolerance, workers,
                   [&](const DescentState& state) {
                     made = state.evaluations + 1;
                     if (level.recorded && is_recorded(state.evaluations - 1))
                       record(surface, state, workers, monitor);
                     return monitor.tick(level.from + (level.to - level.from) * state.evaluations /
                                                          std::max(level.evaluations, 1));
                   });
  if (level.recorded) record(surface, {made, energy, sites}, workers, monitor);
  return energy;
}

// Pairs of sites whose cells touch, whatever was tried last.
std::vector<std::array<Index, 2>> adjacent_sites(rvd::CellEvaluator& evaluator,
                                                 const std::vector<Vec3>& sites) {
  rvd::CellIntegrals cells;
  evaluator.evaluate(sites, cells);
  return evaluator.adjacent_cells();
}

}  // namespace

TouchingSites optimize_level(const mesh::Surface& surface, const CvtOptions& options,
                             const parallel::Workers& workers, parallel::Monitor& monitor) {
  const Components components = connected_components(surface);
  Sites sites = first_sites(surface, components, share_sites(components, options.sites), options);
  TouchingSites result{std::move(sites.points)};
  if (monitor.cancelled()) return result;
  rvd::CellEvaluator evaluator(surface, static_cast<Index>(result.sites.size()), workers);
  descend(surface, evaluator, result.sites,
          {options.iterations, options.tolerance, options.recorded, 0, 1}, workers, monitor);
  if (!monitor.cancelled()) result.adjacent = adjacent_sites(evaluator, result.sites);
  return result;
}

std::vector<Vec3> optimize_cvt(const mesh::Surface& surface, const CvtOptions& options,
                               const parallel::Workers& workers, parallel::Monitor& monitor) {
  const Components components = connected_components(surface);
  std::vector<std::vector<Index>> quotas{share_sites(components, options.sites)};
  for (int level = 0; level < options.coarse_levels; ++level) {
    std::vector<Index> coarse = quarter(quotas.back(), components);
    if (coarse == quotas.back()) break;
    quotas.push_back(std::move(coarse));
  }
  const double total =
      std::max(1.0, options.iterations +
                        options.coarse_iterations * (static_cast<double>(quotas.size()) - 1));
  double done = 0;

  Sites sites = first_sites(surface, components, quotas.back(), options);
  std::size_t level = quotas.size();
  if (level > 1 && is_started(options, quotas.back()) && !options.start.adjacent.empty()) {
    done += options.coarse_iterations / total;
    level -= 1;
    insert_midpoints(surface, components, quotas[level - 1], options.seed, options.start.adjacent,
                     sites);
  }
  while (level-- > 0) {
    rvd::CellEvaluator evaluator(surface, static_cast<Index>(sites.points.size()), workers);
    const int evaluations = level == 0 ? options.iterations : options.coarse_iterations;
    const double share = evaluations / total;
    if (options.balanced && level + 1 < quotas.size() && surface.size.empty() &&
        !monitor.cancelled()) {
      // Midpoints of edges come too few where coarse cells reached around a finger.
      balance_masses(evaluator, sites.component, sites.points);
      minimize_cvt(evaluator, sites.points, kEvaluationsBeforeBalance, 0, workers,
                   [&](const DescentState&) { return monitor.tick(done); });
      balance_masses(evaluator, sites.component, sites.points);
    }
    if (!monitor.cancelled())
      descend(surface, evaluator, sites.points,
              {evaluations, level == 0 ? options.tolerance : options.coarse_tolerance,
               options.recorded && level == 0, done, done + share},
              workers, monitor);
    done += share;
    if (level > 0)
      insert_midpoints(surface, components, quotas[level - 1], options.seed,
                       adjacent_sites(evaluator, sites.points), sites);
  }
  return std::move(sites.points);
}

}  // namespace nonobtuse::pipeline
