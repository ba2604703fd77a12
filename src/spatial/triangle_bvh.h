// Closest points on a triangle mesh by a bounding volume hierarchy in doubles: binary, built by the
// binned surface area heuristic (Wald, On fast Construction of SAH-based Bounding Volume
// Hierarchies, 2007), searched nearest box first.
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "nonobtuse/mesh.h"
#include "parallel/workers.h"
#include "spatial/box.h"
#include "spatial/closest_point.h"

namespace nonobtuse::spatial {

/// Holds copies of the triangles: the mesh may change or go afterwards. Queries are thread-safe and
/// give what trying every triangle in order of index would give, bit for bit: the nearest, and of
/// those at equal distance the one of lowest index.
class TriangleBvh {
 public:
  struct Hit {
    Index triangle = -1;
    Vec3 point;
    Vec3 barycentric;  ///< weights of the triangle's corners 0, 1, 2
    double squared_distance = std::numeric_limits<double>::infinity();
  };

  TriangleBvh() = default;  // empty: no query finds anything
  /// Coordinates must be below 1e150 in size, indices in range; degenerate triangles are fine.
  /// O(#F log #F).
  TriangleBvh(std::span<const Vec3> vertices, std::span<const Triangle> triangles,
              const parallel::Workers& workers);

  /// The point of the mesh nearest to p among those strictly nearer than sqrt(limit); with none,
  /// `triangle` is -1 and `squared_distance` the limit. A good limit makes the search faster.
  [[nodiscard]] Hit closest(const Vec3& p,
                            double limit = std::numeric_limits<double>::infinity()) const;

  /// The same among the triangles t with accept(t). `accept` is asked only of triangles that would
  /// be the nearest so far.
  template <class Accept>
  [[nodiscard]] Hit closest_if(const Vec3& p, double limit, const Accept& accept) const;

  /// Calls visit(t) for every triangle whose bounding box overlaps `box` (touching included), in
  /// an order that depends on the mesh alone.
  template <class Visit>
  void for_overlapping(const Box& box, const Visit& visit) const;

  /// The triangles in the hierarchy's order, in which neighbours in space are near each other.
  [[nodiscard]] const std::vector<Index>& order() const { return order_; }

 private:
  friend class TriangleBvhBuilder;

  // Siblings are neighbours: an inner node's children are `first` and `first + 1`. A leaf holds the
  // triangles order_[first, first + count).
  struct Node {
    Box box;
    Index first = 0;
    Index count = 0;
  };
  template <class Accept>
  void test_leaf(const Node& leaf, const Vec3& p, const Accept& accept, Hit& best) const;

  static constexpr int kMaxDepth = 96;
  // Boxes are enlarged by some ulps of the largest coordinate, and distances to them shortened, so
  // that a box is never farther than the rounded distance to any triangle in it.
  static constexpr double kShorten = 1 - 0x1p-48;

  std::vector<Node> nodes_;
  std::vector<Index> order_;
  std::vector<std::array<Vec3, 3>> corners_;  // of order_[i]
};

template <class Accept>
TriangleBvh::Hit TriangleBvh::closest_if(const Vec3& p, double limit, const Accept& accept) const {
  Hit best;
  best.squared_distance = limit;
  if (nodes_.empty()) return best;
  struct Postponed {
    double bound;
    Index node;
  };
  Postponed stack[kMaxDepth];  // not initialised: it is larger than what most queries touch
  std::size_t top = 0;
  Index current = 0;
  const auto bound_of = [&](Index node) { return kShorten * nodes_[node].box.squared_distance(p); };
  if (bound_of(0) > limit) return best;
  while (true) {
    const Node& node = nodes_[current];
    if (node.count == 0) {
      Postponed near{bound_of(node.first), node.first};
      Postponed far{bound_of(node.first + 1), node.first + 1};
      if (far.bound < near.bound) std::swap(near, far);
      if (far.bound <= best.squared_distance) stack[top++] = far;
      if (near.bound <= best.squared_distance) {
        current = near.node;
        continue;
      }
    } else {
      test_leaf(node, p, accept, best);
    }
    while (top > 0 && stack[top - 1].bound > best.squared_distance) --top;
    if (top == 0) return best;
    current = stack[--top].node;
  }
}

template <class Accept>
void TriangleBvh::test_leaf(const Node& leaf, const Vec3& p, const Accept& accept,
                            Hit& best) const {
  for (Index i = leaf.first; i < leaf.first + leaf.count; ++i) {
    const auto& [a, b, c] = corners_[i];
    const ClosestPoint q = closest_point_on_triangle(p, a, b, c);
    const bool nearer = q.squared_distance < best.squared_distance ||
                        (q.squared_distance == best.squared_distance && order_[i] < best.triangle);
    if (nearer && accept(order_[i])) best = {order_[i], q.point, q.barycentric, q.squared_distance};
  }
}

template <class Visit>
void TriangleBvh::for_overlapping(const Box& box, const Visit& visit) const {
  if (nodes_.empty()) return;
  std::array<Index, kMaxDepth> stack;
  std::size_t top = 0;
  stack[top++] = 0;
  while (top > 0) {
    const Node& node = nodes_[stack[--top]];
    if (!node.box.overlaps(box)) continue;
    if (node.count == 0) {
      stack[top++] = node.first + 1;
      stack[top++] = node.first;
      continue;
    }
    for (Index i = node.first; i < node.first + node.count; ++i) {
      Box own;
      for (const Vec3& corner : corners_[i]) own.add(corner);
      if (own.overlaps(box)) visit(order_[i]);
    }
  }
}

}  // namespace nonobtuse::spatial
