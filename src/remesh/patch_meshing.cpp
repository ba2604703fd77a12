// Sites that are held still: Yan & Wonka 2016, Sec. 4.2 (features), with knots assigned by
// identity instead of by snapping sites whose cells meet a crease.
#include "remesh/patch_meshing.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "rdt/label_guided_collapse.h"
#include "remesh/cvt_optimization.h"
#include "remesh/extraction.h"
#include "remesh/initial_sampling.h"
#include "remesh/localized_cvt.h"
#include "spatial/hilbert_order.h"

namespace nonobtuse::pipeline {

namespace {

constexpr Index kFewestToQuarter = 64;
constexpr Index kFewestCoarse = 8;

struct Sites {
  std::vector<Vec3> points;
  std::vector<char> fixed;

  void add(const Vec3& p, bool is_fixed) {
    points.push_back(p);
    fixed.push_back(is_fixed ? 1 : 0);
  }
  void sort_along_curve() {
    Sites sorted;
    for (const Index i : spatial::hilbert_order(points)) sorted.add(points[i], fixed[i] != 0);
    *this = std::move(sorted);
  }
  [[nodiscard]] std::vector<Vec3> free() const {
    std::vector<Vec3> result;
    for (std::size_t i = 0; i < points.size(); ++i)
      if (fixed[i] == 0) result.push_back(points[i]);
    return result;
  }
};

class PatchCvt {
 public:
  PatchCvt(const Patch& patch, const std::vector<char>& coarse, std::uint64_t seed,
           const parallel::Workers& workers, parallel::Monitor& monitor)
      : patch_(patch), seed_(seed), workers_(workers), monitor_(monitor) {
    std::vector<char> seen(coarse.size(), 0);
    for (std::size_t v = 0; v < patch.knot.size(); ++v) {
      const Index k = patch.knot[v];
      if (k < 0 || seen[k] != 0) continue;
      seen[k] = 1;
      knots_.push_back(patch.surface.vertices[v]);
      coarse_.push_back(coarse[k]);
    }
  }

  // The interior sites.
  std::vector<Vec3> run() {
    const CvtOptions options;
    const Index coarse = coarse_count();
    Sites sites;
    if (coarse >= kFewestCoarse && patch_.interior >= kFewestToQuarter) {
      for (std::size_t k = 0; k < knots_.size(); ++k)
        if (coarse_[k] != 0) sites.add(knots_[k], true);
      sample(coarse, sites);
      sites.sort_along_curve();
      descend(sites, options.coarse_iterations, options.coarse_tolerance);
      sites = refined(sites);
    } else {
      for (const Vec3& p : knots_) sites.add(p, true);
      sample(patch_.interior, sites);
      sites.sort_along_curve();
    }
    descend(sites, options.iterations, options.tolerance);
    return sites.free();
  }

  [[nodiscard]] const std::vector<Vec3>& knots() const { return knots_; }

 private:
  // How many interior sites turn into those wanted when the midpoints of all edges but those of
  // the boundary join them: of 3 V + 2 b - 3 x edges of V interior and b boundary vertices.
  [[nodiscard]] Index coarse_count() const {
    const auto b = static_cast<double>(std::count(coarse_.begin(), coarse_.end(), 1));
    return static_cast<Index>(std::round((patch_.interior + 3.0 * patch_.euler - b) / 4));
  }

  void sample(Index count, Sites& sites) const {
    const Components whole = connected_components(patch_.surface);
    for (const Vec3& p : sample_strata(patch_.surface, whole, {count}, seed_).points)
      sites.add(p, false);
  }

  void descend(Sites& sites, int iterations, double tolerance) {
    rvd::CellEvaluator evaluator(patch_.surface, static_cast<Index>(sites.points.size()), workers_);
    if (!monitor_.cancelled())
      minimize_cvt(
          evaluator, sites.points, iterations, tolerance, workers_,
          [&](const DescentState&) { return !monitor_.cancelled(); }, sites.fixed);
    rvd::CellIntegrals cells;  // adjacency of the sites kept, whatever was tried last
    evaluator.evaluate(sites.points, cells);
    adjacent_ = evaluator.adjacent_cells();
  }

  // All knots, the coarse interior sites, and midpoints, the longest edges' first.
  [[nodiscard]] Sites refined(const Sites& coarse) const {
    struct Link {
      double length2;
      std::array<Index, 2> ends;
    };
    std::vector<Link> links;
    for (const auto& [i, j] : adjacent_)
      if (coarse.fixed[i] == 0 || coarse.fixed[j] == 0)
        links.push_back({squared_distance(coarse.points[i], coarse.points[j]), {i, j}});
    std::sort(links.begin(), links.end(), [](const Link& a, const Link& b) {
      return a.length2 != b.length2 ? a.length2 > b.length2 : a.ends < b.ends;
    });
    Sites sites;
    for (const Vec3& p : knots_) sites.add(p, true);
    Index missing = patch_.interior;
    for (const Vec3& p : coarse.free()) {
      sites.add(p, false);
      --missing;
    }
    for (const Link& link : links) {
      if (missing == 0) break;
      sites.add(0.5 * (coarse.points[link.ends[0]] + coarse.points[link.ends[1]]), false);
      --missing;
    }
    if (missing > 0) {
      const Components whole = connected_components(patch_.surface);
      for (const Vec3& p : sample_strata(patch_.surface, whole, {missing}, seed_ + 1).points)
        sites.add(p, false);
    }
    sites.sort_along_curve();
    return sites;
  }

  const Patch& patch_;
  std::uint64_t seed_;
  const parallel::Workers& workers_;
  parallel::Monitor& monitor_;
  std::vector<Vec3> knots_;  // each once, however many copies the patch has
  std::vector<char> coarse_;
  std::vector<std::array<Index, 2>> adjacent_;
};

// Interior sites moved to where the cells are discs, as far as that goes, and the facets under
// them.
std::vector<Index> settle(const Patch& patch, const std::vector<Vec3>& knots,
                          std::vector<Vec3>& interior, const parallel::Workers& workers,
                          parallel::Monitor& monitor) {
  std::vector<Vec3> sites = knots;
  sites.insert(sites.end(), interior.begin(), interior.end());
  std::vector<char> fixed(sites.size(), 0);
  std::fill_n(fixed.begin(), knots.size(), 1);
  SiteCells cells = site_cells(patch.surface, sites, workers);
  if (!cells.defects.empty() || cells.localized.orphans > 0)
    localize_sites(patch.surface, sites, cells, workers, monitor, fixed);
  const auto first = static_cast<std::ptrdiff_t>(knots.size());
  interior.assign(sites.begin() + first, sites.end());
  std::vector<Index> feet(cells.feet.begin() + first, cells.feet.end());
  complete_feet(patch.surface, interior, feet);
  return feet;
}

}  // namespace

PatchMesh mesh_patch(const Patch& patch, const std::vector<char>& coarse, std::uint64_t seed,
                     const parallel::Workers& workers, parallel::Monitor& monitor) {
  std::vector<Vec3> interior;
  std::vector<Index> feet;
  if (patch.interior > 0) {
    PatchCvt cvt(patch, coarse, seed, workers, monitor);
    interior = cvt.run();
    feet = settle(patch, cvt.knots(), interior, workers, monitor);
  }
  std::vector<Index> knot_vertices;
  for (std::size_t v = 0; v < patch.knot.size(); ++v)
    if (patch.knot[v] >= 0) knot_vertices.push_back(static_cast<Index>(v));
  rdt::CollapsedMesh collapsed =
      rdt::label_guided_collapse(patch.surface, knot_vertices, interior, feet);
  for (Index& k : collapsed.mesh.knot)
    if (k >= 0) k = patch.knot[knot_vertices[k]];
  return {std::move(collapsed.mesh), std::move(collapsed.foot)};
}

}  // namespace nonobtuse::pipeline
