// The closed-ball property (Edelsbrunner, Shah, Triangulating topological spaces, 1997): where
// every cell is a disc and every restricted edge one arc, the dual is homeomorphic to the surface.
#pragma once

#include <span>
#include <vector>

#include "mesh/surface.h"
#include "nonobtuse/mesh.h"
#include "rvd/restricted_voronoi.h"

namespace nonobtuse::rdt {

enum class CellDefect {
  Empty,       ///< the site owns nothing
  Pieces,      ///< several connected parts
  Handle,      ///< connected, but not a disc (Euler characteristic other than 1)
  DoubleEdge,  ///< a disc that meets another cell, or the boundary, twice, or too few others
};

struct DefectiveCell {
  Index site = -1;
  CellDefect kind = CellDefect::Empty;
};

/// Cells that break the closed-ball property, by site, the first reason each; `owner` as for
/// restricted_delaunay, `triangles` as it gives them. Empty: the triangles are a manifold
/// homeomorphic to the surface, a vertex for every site. A cell at the boundary must meet it in one
/// arc.
std::vector<DefectiveCell> closed_ball_defects(const mesh::Surface& surface,
                                               const rvd::RestrictedVoronoi& diagram,
                                               std::span<const Index> owner, Index site_count,
                                               const std::vector<Triangle>& triangles);

}  // namespace nonobtuse::rdt
