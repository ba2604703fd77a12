// One evaluation of the restricted Voronoi diagram with all that the paper's own stages need of it.
#pragma once

#include <span>
#include <vector>

#include "energy/short_dual_penalty.h"
#include "mesh/surface.h"
#include "parallel/workers.h"

namespace nonobtuse::remesh {

struct RestrictedDiagram {
  double energy = 0;                     ///< Eq. 1
  std::vector<double> mass;              ///< #X: area of each cell
  std::vector<Vec3> centroid;            ///< #X by 3; the site itself where the cell is empty
  std::vector<energy::DualEdge> edges;   ///< neighbouring cells i < j, sorted
  std::vector<Triangle> triangles;       ///< of the restricted Delaunay triangulation
};

RestrictedDiagram restricted_diagram(const mesh::Surface& surface, std::span<const Vec3> sites,
                                     const parallel::Workers& workers);

}  // namespace nonobtuse::remesh
