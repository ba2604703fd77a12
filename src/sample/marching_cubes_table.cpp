// Lorensen & Cline, Marching cubes: a high resolution 3D surface construction algorithm, 1987.
#include "sample/marching_cubes_table.h"

#include <cstddef>

namespace nonobtuse::sample {
namespace {

int edge_between(int a, int b) {
  const int low = a < b ? a : b;
  for (std::size_t e = 0; e < cell_edges().size(); ++e) {
    const CellEdge& edge = cell_edges()[e];
    if (edge.corner == low && (a ^ b) == (1 << edge.axis)) return static_cast<int>(e);
  }
  return -1;
}

// Corners of the face normal to `axis`, counter-clockwise seen from outside the cell.
std::array<int, 4> face_corners(int axis, int side) {
  const int u = 1 << ((axis + 1) % 3);
  const int v = 1 << ((axis + 2) % 3);
  const int base = side << axis;
  if (side == 1) return {base, base + u, base + u + v, base + v};
  return {base, base + v, base + u + v, base + u};
}

// next[e]: the crossed edge that follows crossed edge e on the loop around the inside corners.
std::array<int, 12> link_crossings(int signs) {
  std::array<int, 12> next{};
  next.fill(-1);
  const auto inside = [signs](int corner) { return ((signs >> corner) & 1) != 0; };
  for (int axis = 0; axis < 3; ++axis) {
    for (int side = 0; side < 2; ++side) {
      const std::array<int, 4> face = face_corners(axis, side);
      for (std::size_t k = 0; k < 4; ++k) {
        if (inside(face[k]) || !inside(face[(k + 1) % 4])) continue;
        // The run of inside corners that starts at k + 1 ends before corner `end`.
        std::size_t end = k + 2;
        while (inside(face[end % 4])) ++end;
        const int entry = edge_between(face[k], face[(k + 1) % 4]);
        next[static_cast<std::size_t>(entry)] = edge_between(face[(end - 1) % 4], face[end % 4]);
      }
    }
  }
  return next;
}

CellTriangles fill_loops(std::array<int, 12> next) {
  CellTriangles triangles;
  for (std::size_t start = 0; start < next.size(); ++start) {
    std::vector<int> loop;
    for (std::size_t e = start; next[e] >= 0;) {
      loop.push_back(static_cast<int>(e));
      const int follower = next[e];
      next[e] = -1;
      e = static_cast<std::size_t>(follower);
    }
    for (std::size_t k = 2; k < loop.size(); ++k)
      triangles.push_back({loop[0], loop[k - 1], loop[k]});
  }
  return triangles;
}

}  // namespace

const std::array<CellEdge, 12>& cell_edges() {
  static constexpr std::array<CellEdge, 12> kEdges{{{0, 0},
                                                    {2, 0},
                                                    {4, 0},
                                                    {6, 0},
                                                    {0, 1},
                                                    {1, 1},
                                                    {4, 1},
                                                    {5, 1},
                                                    {0, 2},
                                                    {1, 2},
                                                    {2, 2},
                                                    {3, 2}}};
  return kEdges;
}

std::array<CellTriangles, 256> marching_cubes_table() {
  std::array<CellTriangles, 256> table;
  for (std::size_t signs = 0; signs < table.size(); ++signs)
    table[signs] = fill_loops(link_crossings(static_cast<int>(signs)));
  return table;
}

}  // namespace nonobtuse::sample
