// The cases of marching cubes (Lorensen & Cline 1987), derived instead of listed: on each face of
// the cell every run of inside corners is cut off by one segment, the segments form loops, the
// loops are filled by fans. The rule for a face depends on the signs of its corners alone, so that
// neighbouring cells agree on it and the surface has no cracks.
#pragma once

#include <array>
#include <vector>

namespace nonobtuse::sample {

/// Corner c of a cell lies at (c & 1, c >> 1 & 1, c >> 2 & 1).
struct CellEdge {
  int corner;  ///< the end with the smaller coordinate
  int axis;    ///< 0, 1, 2: the other end is corner + (1 << axis)
};

/// The twelve edges of a cell.
const std::array<CellEdge, 12>& cell_edges();

/// Triangles of one case: indices of cell edges, oriented with the outside in front.
using CellTriangles = std::vector<std::array<int, 3>>;

/// triangles[signs]: bit c of signs is set where corner c is inside.
std::array<CellTriangles, 256> marching_cubes_table();

}  // namespace nonobtuse::sample
