// Counts for any indexed mesh, by joining triangles and corners across edges.
#include <numeric>
#include <vector>

#include "nonobtuse/quality.h"
#include "quality/edges.h"
#include "quality/validity.h"

namespace nonobtuse {

namespace {

// Disjoint sets with path halving; the root is the least member.
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t count) : parent_(count) {
    std::iota(parent_.begin(), parent_.end(), std::size_t{0});
  }
  std::size_t find(std::size_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(std::size_t i, std::size_t j) {
    i = find(i);
    j = find(j);
    if (i < j) parent_[j] = i;
    if (j < i) parent_[i] = j;
  }
  bool is_root(std::size_t i) { return find(i) == i; }

 private:
  std::vector<std::size_t> parent_;
};

// Corner of a side's triangle at the edge's vertex `v`.
std::size_t corner_at(const quality::EdgeSide& side, const std::vector<Triangle>& triangles,
                      Index v) {
  const int k = triangles[side.triangle][(side.corner + 1) % 3] == v ? (side.corner + 1) % 3
                                                                     : (side.corner + 2) % 3;
  return std::size_t{3} * side.triangle + k;
}

// A fan is a set of corners of one vertex joined across edges; a boundary loop, a set of fans
// joined by boundary edges: the loops of the surface cut open at vertices of several fans.
Index count_boundary_loops(const TriangleMesh& mesh, const quality::EdgeList& edges,
                           DisjointSets& fans) {
  DisjointSets loops(3 * mesh.triangles.size());
  std::vector<char> on_boundary(3 * mesh.triangles.size(), 0);
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const quality::SharedEdge edge = edges[e];
    if (edge.sides.size() != 1) continue;
    const std::size_t i = fans.find(corner_at(edge.sides[0], mesh.triangles, edge.low));
    const std::size_t j = fans.find(corner_at(edge.sides[0], mesh.triangles, edge.high));
    on_boundary[i] = on_boundary[j] = 1;
    loops.join(i, j);
  }
  Index count = 0;
  for (std::size_t c = 0; c < on_boundary.size(); ++c)
    if (on_boundary[c] != 0 && loops.is_root(c)) ++count;
  return count;
}

}  // namespace

Topology measure_topology(const TriangleMesh& mesh) {
  quality::require_measurable(mesh);
  const quality::EdgeList edges(mesh.triangles, mesh.vertices.size());
  Topology result;
  result.triangles = static_cast<Index>(mesh.triangles.size());
  result.edges = static_cast<Index>(edges.size());

  DisjointSets components(mesh.triangles.size());
  DisjointSets fans(3 * mesh.triangles.size());
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const auto [low, high, sides] = edges[e];
    if (sides.size() > 2) ++result.nonmanifold_edges;
    if (sides.size() == 2 && sides[0].forward == sides[1].forward) result.oriented = false;
    for (std::size_t s = 1; s < sides.size(); ++s) {
      components.join(sides[0].triangle, sides[s].triangle);
      for (const Index v : {low, high})
        fans.join(corner_at(sides[0], mesh.triangles, v), corner_at(sides[s], mesh.triangles, v));
    }
  }
  std::vector<int> fans_of(mesh.vertices.size(), 0);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (components.is_root(t)) ++result.components;
    for (std::size_t k = 0; k < 3; ++k)
      if (fans.is_root(3 * t + k)) ++fans_of[mesh.triangles[t][k]];
  }
  for (const int count : fans_of) {
    if (count > 0) ++result.vertices;
    if (count > 1) ++result.nonmanifold_vertices;
  }
  result.boundary_loops = count_boundary_loops(mesh, edges, fans);
  result.euler_characteristic = std::int64_t{result.vertices} - result.edges + result.triangles;
  return result;
}

}  // namespace nonobtuse
