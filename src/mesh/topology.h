// What a set of triangles is before it is known to be a surface: edges with any number of faces,
// the orientation of components, fans around vertices.
#pragma once

#include <vector>

#include "mesh/surface.h"
#include "nonobtuse/mesh.h"

namespace nonobtuse::mesh {

/// One side of an edge: the edge of `triangle` opposite `corner`, its ends sorted.
struct EdgeSide {
  Index low = 0;
  Index high = 0;
  Index triangle = 0;
  int corner = 0;
  bool upward = false;  ///< whether the triangle runs along it from low to high

  [[nodiscard]] bool same_edge(const EdgeSide& other) const {
    return low == other.low && high == other.high;
  }
};

/// The 3 #F sides, those of one edge side by side, sorted by (low, high, triangle).
/// Triangles have three distinct vertices in [0, vertex_count). O(#F log valence).
std::vector<EdgeSide> edge_sides(const std::vector<Triangle>& triangles, Index vertex_count);

/// Calls visit(first, last) for the range of sides of every edge.
template <class Visit>
void for_each_edge(const std::vector<EdgeSide>& sides, const Visit& visit) {
  for (std::size_t i = 0; i < sides.size();) {
    std::size_t j = i + 1;
    while (j < sides.size() && sides[j].same_edge(sides[i])) ++j;
    visit(sides.data() + i, sides.data() + j);
    i = j;
  }
}

struct Orientation {
  std::vector<char> turned;  ///< #F: 1 where the triangle disagrees with its component's majority
  Index count = 0;           ///< of turned triangles
  Index first = -1;          ///< the first of them
  Index contradiction = -1;  ///< a triangle where orientations clash: not orientable; else -1
};

/// Propagates orientation across edges of two triangles; of each component the majority keeps its
/// own (at a tie, that of its first triangle).
Orientation consistent_orientation(std::size_t triangle_count, const std::vector<EdgeSide>& sides);

}  // namespace nonobtuse::mesh
