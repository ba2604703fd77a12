// The edges of any indexed mesh, manifold or not, with all their triangles.
#pragma once

#include <span>
#include <vector>

#include "nonobtuse/mesh.h"

namespace nonobtuse::quality {

/// One triangle's side of an edge: the edge opposite its corner `corner`.
struct EdgeSide {
  Index triangle = -1;
  int corner = 0;
  bool forward = false;  ///< the triangle runs from the edge's lower vertex to its higher one
};

/// An edge and the triangles that have it, in order of index.
struct SharedEdge {
  Index low = -1;
  Index high = -1;
  std::span<const EdgeSide> sides;
};

/// All edges in order of (low, high). Sides from a vertex to itself, of triangles that name a
/// vertex twice, are left out.
class EdgeList {
 public:
  /// Indices must be in range. O(#F log(largest valence)).
  EdgeList(std::span<const Triangle> triangles, std::size_t vertex_count);

  [[nodiscard]] std::size_t size() const { return ends_.size(); }
  [[nodiscard]] SharedEdge operator[](std::size_t e) const {
    const std::size_t begin = e == 0 ? 0 : ends_[e - 1];
    const Side& first = sides_[begin];
    return {first.low, first.high, {edge_sides_.data() + begin, ends_[e] - begin}};
  }

 private:
  struct Side {
    Index low, high;
  };
  std::vector<Side> sides_;
  std::vector<EdgeSide> edge_sides_;  // beside sides_
  std::vector<std::size_t> ends_;     // of each edge in sides_
};

}  // namespace nonobtuse::quality
