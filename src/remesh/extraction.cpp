// Closed-ball property: Edelsbrunner, Shah 1997. Localized cells: Yan et al. 2014.
#include "remesh/extraction.h"

#include <algorithm>

#include "nonobtuse/error.h"
#include "rdt/closed_ball.h"
#include "rdt/label_guided_collapse.h"
#include "rdt/restricted_delaunay.h"
#include "rvd/candidate_lists.h"
#include "rvd/localized_cells.h"
#include "rvd/restricted_voronoi.h"
#include "spatial/closest_point.h"

namespace nonobtuse::pipeline {

namespace {

// The localized diagram of some sites, its dual, and what is wrong with it.
struct Cells {
  rvd::RestrictedVoronoi diagram;
  rvd::LocalizedCells localized;
  std::vector<Index> feet;
  std::vector<Triangle> triangles;
  Index defects = 0;
};

Cells cells_of(const mesh::Surface& surface, const std::vector<Vec3>& sites,
               const parallel::Workers& workers) {
  Cells c;
  c.diagram = rvd::restricted_voronoi(surface, sites,
                                      rvd::facet_candidates(surface, sites, workers), workers);
  c.feet = rvd::cell_feet(surface, sites, c.diagram);
  c.localized = rvd::localized_cells(surface, sites, c.diagram, c.feet);
  c.triangles = rdt::restricted_delaunay(c.diagram, c.localized.owner);
  c.defects =
      static_cast<Index>(rdt::closed_ball_defects(surface, c.diagram, c.localized.owner,
                                                  static_cast<Index>(sites.size()), c.triangles)
                             .size());
  return c;
}

// Moves every site towards the centroid of its localized cell and onto the nearest facet of that
// cell: it cannot jump to another sheet.
void localized_lloyd_step(const mesh::Surface& surface, const Cells& cells, double relaxation,
                          std::vector<Vec3>& sites) {
  const rvd::CellSums sums = rvd::cell_sums(surface, sites, cells.diagram, cells.localized.owner);
  std::vector<double> nearest(sites.size(), 1e300);
  std::vector<Vec3> moved = sites;
  for (Index f = 0; f < static_cast<Index>(surface.triangles.size()); ++f) {
    const Triangle& t = surface.triangles[f];
    for (Index p = cells.diagram.facet_start[f]; p < cells.diagram.facet_start[f + 1]; ++p) {
      const Index i = cells.localized.owner[p];
      const Vec3 target = sites[i] + relaxation * (sums.centroid[i] - sites[i]);
      const auto closest = spatial::closest_point_on_triangle(
          target, surface.vertices[t[0]], surface.vertices[t[1]], surface.vertices[t[2]]);
      if (closest.squared_distance < nearest[i]) {
        nearest[i] = closest.squared_distance;
        moved[i] = closest.point;
      }
    }
  }
  sites = std::move(moved);
}

Extraction dual_mesh(Cells cells, std::vector<Vec3> sites, ExtractionRoute route) {
  Extraction result;
  result.mesh = mesh::EditableMesh(std::move(sites), std::move(cells.triangles));
  result.foot = std::move(cells.feet);
  result.route = route;
  return result;
}

// Sites with an empty cell (coincident with another) still need a foot.
void complete_feet(const mesh::Surface& surface, const std::vector<Vec3>& sites,
                   std::vector<Index>& feet) {
  for (std::size_t i = 0; i < sites.size(); ++i) {
    if (feet[i] >= 0) continue;
    double nearest = 1e300;
    for (std::size_t f = 0; f < surface.triangles.size(); ++f) {
      const Triangle& t = surface.triangles[f];
      const double d =
          spatial::closest_point_on_triangle(sites[i], surface.vertices[t[0]],
                                             surface.vertices[t[1]], surface.vertices[t[2]])
              .squared_distance;
      if (d < nearest) {
        nearest = d;
        feet[i] = static_cast<Index>(f);
      }
    }
  }
}

constexpr int kLocalizedIterations = 30;

}  // namespace

Extraction extract(const mesh::Surface& surface, std::vector<Vec3> sites,
                   const parallel::Workers& workers, parallel::Monitor& monitor) {
  monitor.tick(0);
  Cells cells = cells_of(surface, sites, workers);
  if (cells.defects == 0 && cells.localized.orphans == 0)
    return dual_mesh(std::move(cells), std::move(sites), ExtractionRoute::Dual);
  for (int step = 0; step < kLocalizedIterations; ++step) {
    if (!monitor.tick(0.8 * step / kLocalizedIterations)) break;
    localized_lloyd_step(surface, cells, 1.5, sites);
    cells = cells_of(surface, sites, workers);
  }
  if (cells.defects == 0)
    return dual_mesh(std::move(cells), std::move(sites), ExtractionRoute::Repaired);
  complete_feet(surface, sites, cells.feet);
  rdt::CollapsedMesh collapsed = rdt::label_guided_collapse(surface, sites, cells.feet);
  monitor.tick(1);
  Extraction result;
  result.mesh = std::move(collapsed.mesh);
  result.foot = std::move(collapsed.foot);
  result.route = ExtractionRoute::Collapsed;
  return result;
}

}  // namespace nonobtuse::pipeline
