// One evaluation of the restricted Voronoi diagram with all that the paper's own stages need of it.
#pragma once

#include <span>
#include <vector>

#include "mesh/surface.h"
#include "parallel/workers.h"
#include "rdt/closed_ball.h"
#include "rvd/restricted_voronoi.h"

namespace nonobtuse::pipeline {

struct RestrictedDiagram {
  rvd::RestrictedVoronoi voronoi;
  rvd::CellSums cells;                      ///< energy of Eq. 1, areas and centroids
  std::vector<rvd::DualEdge> edges;         ///< pairs of cells that touch, sorted
  std::vector<Triangle> triangles;          ///< of the restricted Delaunay triangulation
  std::vector<rdt::DefectiveCell> defects;  ///< cells that are not discs, or meet twice
};

/// Of the exact diagram: some two to three times the time of the floating-point engine, which
/// knows neither the triangles nor the lengths of the dual edges.
RestrictedDiagram restricted_diagram(const mesh::Surface& surface, std::span<const Vec3> sites,
                                     const parallel::Workers& workers);

/// Triangles with an angle of 90 degrees and more, and with one below 30.
struct BadTriangles {
  Index obtuse = 0;
  Index small = 0;
};

/// In doubles: for ranking and watching iterates, not for a certificate.
BadTriangles count_bad_triangles(std::span<const Vec3> sites, std::span<const Triangle> triangles);

}  // namespace nonobtuse::pipeline
