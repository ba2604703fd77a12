#include "remesh/restricted_diagram.h"

#include "numeric/vec3.h"
#include "rdt/restricted_delaunay.h"
#include "rvd/candidate_lists.h"

namespace nonobtuse::pipeline {

RestrictedDiagram restricted_diagram(const mesh::Surface& surface, std::span<const Vec3> sites,
                                     const parallel::Workers& workers) {
  RestrictedDiagram result;
  result.voronoi = rvd::restricted_voronoi(surface, sites,
                                           rvd::facet_candidates(surface, sites, workers), workers);
  const rvd::RestrictedVoronoi& diagram = result.voronoi;
  result.cells = rvd::cell_sums(surface, sites, diagram, diagram.site);
  result.edges = rvd::dual_edges(surface, sites, diagram);
  result.triangles = rdt::restricted_delaunay(diagram, diagram.site);
  result.defects = rdt::closed_ball_defects(surface, diagram, diagram.site,
                                            static_cast<Index>(sites.size()), result.triangles);
  return result;
}

BadTriangles count_bad_triangles(std::span<const Vec3> sites, std::span<const Triangle> triangles) {
  BadTriangles result;
  for (const Triangle& t : triangles) {
    bool obtuse = false;
    bool small = false;
    for (int k = 0; k < 3; ++k) {
      const Vec3& apex = sites[t[k]];
      const Vec3 u = sites[t[mesh::next(k)]] - apex;
      const Vec3 v = sites[t[mesh::previous(k)]] - apex;
      const double c = dot(u, v);
      obtuse |= c <= 0;
      small |= c > 0 && c * c > 0.75 * squared_length(u) * squared_length(v);
    }
    result.obtuse += obtuse;
    result.small += small;
  }
  return result;
}

}  // namespace nonobtuse::pipeline
