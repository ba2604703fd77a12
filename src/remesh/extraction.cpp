// Closed-ball property: Edelsbrunner, Shah 1997. Localized cells: Yan et al. 2014.
#include "remesh/extraction.h"

#include <limits>
#include <utility>

#include "nonobtuse/error.h"
#include "rdt/label_guided_collapse.h"
#include "remesh/localized_cvt.h"
#include "spatial/closest_point.h"

namespace nonobtuse::pipeline {

namespace {

Extraction dual_mesh(SiteCells cells, std::vector<Vec3> sites, ExtractionRoute route) {
  Extraction result;
  result.mesh = mesh::EditableMesh(std::move(sites), std::move(cells.triangles));
  result.foot = std::move(cells.feet);
  result.route = route;
  return result;
}

}  // namespace

void complete_feet(const mesh::Surface& surface, const std::vector<Vec3>& sites,
                   std::vector<Index>& feet) {
  for (std::size_t i = 0; i < sites.size(); ++i) {
    if (feet[i] >= 0) continue;
    double nearest = std::numeric_limits<double>::infinity();
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

Extraction extract(const mesh::Surface& surface, std::vector<Vec3> sites,
                   const parallel::Workers& workers, parallel::Monitor& monitor) {
  monitor.tick(0);
  SiteCells cells = site_cells(surface, sites, workers);
  if (cells.defects.empty() && cells.localized.orphans == 0)
    return dual_mesh(std::move(cells), std::move(sites), ExtractionRoute::Dual);
  localize_sites(surface, sites, cells, workers, monitor);
  if (cells.defects.empty())
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
