// Yan, Bao, Zhang, Wonka, Low-resolution remeshing using the localized restricted Voronoi diagram,
// 2014; Edelsbrunner, Shah, 1997 (inserting the farthest point of a cell that is not a disc).
#include "remesh/localized_cvt.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <tuple>

#include "rdt/restricted_delaunay.h"
#include "rvd/candidate_lists.h"
#include "spatial/closest_point.h"

namespace nonobtuse::pipeline {

namespace {

constexpr int kMostSteps = 40;
constexpr int kStepsIfValid = 15;   // enough for sites that left the other sheet to settle
constexpr int kStepsIfFew = 3;      // where less than one cell in a thousand reaches through
constexpr int kStepsPerRepair = 4;  // between two relocations
constexpr int kPatience = 12;       // steps without fewer defects: repairs chase each other
constexpr std::size_t kCellsPerDefect = 100;  // fewer: the surface is crumpled everywhere
constexpr std::size_t kManySites = 10000;     // every step takes seconds
constexpr double kRelaxation = 1.5;

void lloyd_step(const mesh::Surface& surface, const SiteCells& cells, const rvd::CellSums& sums,
                std::span<const char> fixed, std::vector<Vec3>& sites) {
  std::vector<double> nearest(sites.size(), std::numeric_limits<double>::infinity());
  std::vector<Vec3> moved = sites;
  for (Index f = 0; f < static_cast<Index>(surface.triangles.size()); ++f) {
    const Triangle& t = surface.triangles[f];
    for (Index p = cells.diagram.facet_start[f]; p < cells.diagram.facet_start[f + 1]; ++p) {
      const Index i = cells.localized.owner[p];
      const Vec3 target = sites[i] + kRelaxation * (sums.centroid[i] - sites[i]);
      const double height = dot(surface.normals[f], target - surface.vertices[t[0]]);
      if (height * height * (1 - 1e-12) >= nearest[i]) continue;
      const auto closest = spatial::closest_point_on_triangle(
          target, surface.vertices[t[0]], surface.vertices[t[1]], surface.vertices[t[2]]);
      if (closest.squared_distance < nearest[i]) {
        nearest[i] = closest.squared_distance;
        moved[i] = closest.point;
      }
    }
  }
  for (std::size_t i = 0; i < fixed.size(); ++i)
    if (fixed[i] != 0) moved[i] = sites[i];
  sites = std::move(moved);
}

// The farthest corner of the cell of each of `of`; the site itself where the cell is empty.
std::vector<Vec3> farthest_points(const mesh::Surface& surface, const std::vector<Vec3>& sites,
                                  const SiteCells& cells, const std::vector<Index>& of) {
  std::vector<Index> rank(sites.size(), -1);
  std::vector<Vec3> points;
  for (const Index i : of) {
    rank[i] = static_cast<Index>(points.size());
    points.push_back(sites[i]);
  }
  std::vector<Vec3> corners;
  for (Index f = 0; f < static_cast<Index>(surface.triangles.size()); ++f)
    for (Index p = cells.diagram.facet_start[f]; p < cells.diagram.facet_start[f + 1]; ++p) {
      const Index i = cells.localized.owner[p];
      if (rank[i] < 0) continue;
      rvd::corner_positions(surface, sites, cells.diagram, f, p, corners);
      Vec3& farthest = points[rank[i]];
      for (const Vec3& c : corners)
        if (squared_distance(c, sites[i]) > squared_distance(farthest, sites[i])) farthest = c;
    }
  return points;
}

// Sites by the size of their cells (with sizing: relative to the target), least first.
std::vector<Index> by_mass(const rvd::CellSums& sums) {
  const std::vector<double>& mass = sums.sites.empty() ? sums.mass : sums.sites;
  std::vector<Index> order(mass.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(),
            [&](Index a, Index b) { return std::tie(mass[a], a) < std::tie(mass[b], b); });
  return order;
}

// Sites without a cell (off the surface, or coincident) go to the farthest points of the largest
// cells. Returns whether there were any.
bool revive_empty_cells(const mesh::Surface& surface, const SiteCells& cells,
                        const rvd::CellSums& sums, std::span<const char> fixed,
                        std::vector<Vec3>& sites) {
  std::vector<Index> empty;
  for (const rdt::DefectiveCell& d : cells.defects)
    if (d.kind == rdt::CellDefect::Empty && (fixed.empty() || fixed[d.site] == 0))
      empty.push_back(d.site);
  if (empty.empty()) return false;
  std::vector<Index> largest = by_mass(sums);
  std::reverse(largest.begin(), largest.end());
  largest.resize(std::min(largest.size(), empty.size()));
  const std::vector<Vec3> targets = farthest_points(surface, sites, cells, largest);
  for (std::size_t k = 0; k < targets.size(); ++k) sites[empty[k]] = targets[k];
  return true;
}

// Moves the sites with the smallest cells to the farthest points of defective ones.
void relocate(const mesh::Surface& surface, const SiteCells& cells, const rvd::CellSums& sums,
              std::span<const char> fixed, std::vector<Vec3>& sites) {
  std::vector<Index> defective;
  for (const rdt::DefectiveCell& d : cells.defects) defective.push_back(d.site);
  const std::vector<Vec3> targets = farthest_points(surface, sites, cells, defective);
  std::vector<char> busy(sites.size(), 0);
  std::vector<double> crowding;  // squared distance; the spacing is about the local size
  for (const rdt::DefectiveCell& d : cells.defects) {
    busy[d.site] = 1;
    const Index foot = cells.feet[d.site];
    const double size = foot < 0 ? 1 : surface.size_at(foot, {1.0 / 3, 1.0 / 3, 1.0 / 3});
    crowding.push_back(0.25 * size * size);
  }
  for (const Triangle& t : cells.triangles)
    if (std::any_of(t.begin(), t.end(), [&](Index v) { return busy[v] == 1; }))
      for (const Index v : t) busy[v] = std::max<char>(busy[v], 2);
  std::vector<Index> order = by_mass(sums);
  order.erase(
      std::remove_if(order.begin(), order.end(),
                     [&](Index i) { return busy[i] != 0 || (!fixed.empty() && fixed[i] != 0); }),
      order.end());
  const std::size_t count = std::min(order.size(), order.size() / 20 + 1);
  for (std::size_t k = 0, d = 0; k < count && d < targets.size(); ++d) {
    const bool crowded = std::any_of(targets.begin(), targets.begin() + d, [&](const Vec3& p) {
      return squared_distance(p, targets[d]) < crowding[d];
    });
    if (!crowded) sites[order[k++]] = targets[d];
  }
}

}  // namespace

SiteCells site_cells(const mesh::Surface& surface, const std::vector<Vec3>& sites,
                     const parallel::Workers& workers) {
  const Index count = static_cast<Index>(sites.size());
  SiteCells c;
  c.diagram = rvd::restricted_voronoi(surface, sites,
                                      rvd::facet_candidates(surface, sites, workers), workers);
  c.feet = rvd::cell_feet(surface, sites, c.diagram);
  // The plain cells, if they are fine: then all are connected.
  c.triangles = rdt::restricted_delaunay(c.diagram, c.diagram.site);
  c.defects = rdt::closed_ball_defects(surface, c.diagram, c.diagram.site, count, c.triangles);
  if (c.defects.empty()) {
    c.localized.owner = c.diagram.site;
    return c;
  }
  c.localized = rvd::localized_cells(surface, sites, c.diagram, c.feet);
  c.triangles = rdt::restricted_delaunay(c.diagram, c.localized.owner);
  c.defects = rdt::closed_ball_defects(surface, c.diagram, c.localized.owner, count, c.triangles);
  return c;
}

void localize_sites(const mesh::Surface& surface, std::vector<Vec3>& sites, SiteCells& cells,
                    const parallel::Workers& workers, parallel::Monitor& monitor,
                    std::span<const char> fixed) {
  std::size_t fewest = cells.defects.size();
  int fewest_at = 0;
  for (int step = 0; step < kMostSteps && step < fewest_at + kPatience; ++step) {
    if (!monitor.tick(0.8 * step / kMostSteps)) return;
    const rvd::CellSums sums = rvd::cell_sums(surface, sites, cells.diagram, cells.localized.owner);
    bool relocated = false;
    if (!revive_empty_cells(surface, cells, sums, fixed, sites)) {
      if (!cells.defects.empty() && step % kStepsPerRepair == kStepsPerRepair - 1) {
        relocate(surface, cells, sums, fixed, sites);
        relocated = true;
      } else {
        lloyd_step(surface, cells, sums, fixed, sites);
      }
    }
    cells = site_cells(surface, sites, workers);
    // On a large crumpled patch repairs only chase each other.
    if (!fixed.empty() && sites.size() > kManySites && relocated &&
        cells.defects.size() >= fewest && cells.defects.size() * kCellsPerDefect > sites.size())
      return;
    if (cells.defects.size() < fewest) {
      fewest = cells.defects.size();
      fewest_at = step + 1;
    }
    const bool few = cells.localized.orphans * 1000 < static_cast<Index>(sites.size());
    if (cells.defects.empty() &&
        (cells.localized.orphans == 0 || step + 1 >= (few ? kStepsIfFew : kStepsIfValid)))
      return;
  }
}

}  // namespace nonobtuse::pipeline
