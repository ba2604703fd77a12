#include "remesh/restricted_diagram.h"

#include "rdt/restricted_delaunay.h"
#include "rvd/candidate_lists.h"

namespace nonobtuse::pipeline {

RestrictedDiagram restricted_diagram(const mesh::Surface& surface, std::span<const Vec3> sites,
                                     const parallel::Workers& workers) {
  const rvd::RestrictedVoronoi diagram = rvd::restricted_voronoi(
      surface, sites, rvd::facet_candidates(surface, sites, workers), workers);
  RestrictedDiagram result;
  result.cells = rvd::cell_sums(surface, sites, diagram, diagram.site);
  result.edges = rvd::dual_edges(surface, sites, diagram);
  result.triangles = rdt::restricted_delaunay(diagram, diagram.site);
  result.defects = rdt::closed_ball_defects(surface, diagram, diagram.site,
                                            static_cast<Index>(sites.size()), result.triangles);
  return result;
}

}  // namespace nonobtuse::pipeline
