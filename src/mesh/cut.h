// Cutting a complex of triangles open along edges, so that what is left is a manifold with
// boundary: every fan of triangles around a vertex gets its own copy of it.
#pragma once

#include <vector>

#include "mesh/topology.h"

namespace nonobtuse::mesh {

struct Cut {
  std::vector<Triangle> triangles;  ///< #F by 3, in the order given
  /// Vertex before the cut of each vertex after it; the first #V are the vertices themselves.
  std::vector<Index> original;
};

/// Cuts along the edges for which `along(first, last)`, called with the sides of each edge of two
/// faces, says so, and along every edge that has not two faces; with edges of three or more faces
/// and vertices where several fans touch, the result is a manifold. The first fan (by triangle) of
/// a vertex keeps its number. `sides` as from `edge_sides`.
template <class Along>
Cut cut_along(const std::vector<Triangle>& triangles, Index vertex_count,
              const std::vector<EdgeSide>& sides, const Along& along);

/// The same along nothing but edges of three or more faces.
Cut cut_to_manifold(const std::vector<Triangle>& triangles, Index vertex_count,
                    const std::vector<EdgeSide>& sides);

/// Corners of triangles grouped into fans around their vertices: union-find over #F by 3 corners
/// (3 t + k). At first every corner is a fan of its own.
class CornerFans {
 public:
  /// The triangles must outlive this.
  explicit CornerFans(const std::vector<Triangle>& triangles);
  /// Joins the corners of two triangles at both ends of their common edge.
  void join(const EdgeSide& a, const EdgeSide& b);
  /// One vertex per fan.
  [[nodiscard]] Cut copies(Index vertex_count);

 private:
  [[nodiscard]] Index root(Index corner);
  const std::vector<Triangle>& triangles_;
  std::vector<Index> parent_;
};

template <class Along>
Cut cut_along(const std::vector<Triangle>& triangles, Index vertex_count,
              const std::vector<EdgeSide>& sides, const Along& along) {
  CornerFans fans(triangles);
  for_each_edge(sides, [&](const EdgeSide* first, const EdgeSide* last) {
    if (last - first == 2 && !along(first, last)) fans.join(first[0], first[1]);
  });
  return fans.copies(vertex_count);
}

}  // namespace nonobtuse::mesh
