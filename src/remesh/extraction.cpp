// Edelsbrunner, Shah 1997 (closed-ball property).
#include "remesh/extraction.h"

#include <algorithm>

#include "nonobtuse/error.h"
#include "rdt/closed_ball.h"
#include "rdt/restricted_delaunay.h"
#include "rvd/candidate_lists.h"
#include "rvd/localized_cells.h"
#include "rvd/restricted_voronoi.h"

namespace nonobtuse::pipeline {

Extraction extract(const mesh::Surface& surface, std::vector<Vec3> sites,
                   const parallel::Workers& workers, parallel::Monitor& monitor) {
  monitor.tick(0);
  const Index count = static_cast<Index>(sites.size());
  const rvd::RestrictedVoronoi diagram = rvd::restricted_voronoi(
      surface, sites, rvd::facet_candidates(surface, sites, workers), workers);
  std::vector<Triangle> triangles = rdt::restricted_delaunay(diagram);
  const auto defects = rdt::closed_ball_defects(surface, diagram, count, triangles);
  if (!defects.empty())
    throw TooFewVertices("The cells of " + std::to_string(defects.size()) + " sites are not discs.",
                         count);
  Extraction result;
  result.foot = rvd::cell_feet(surface, sites, diagram);
  result.mesh = mesh::EditableMesh(std::move(sites), std::move(triangles));
  return result;
}

}  // namespace nonobtuse::pipeline
