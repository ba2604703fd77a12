// A manifold triangle mesh whose edges can be flipped, split and collapsed without ever leaving
// the manifolds: every edit is checked combinatorially (link condition: Dey, Edelsbrunner, Guha,
// Nekhayev, Topology preserving edge contraction, 1999) and preserves the topology.
#pragma once

#include <array>
#include <vector>

#include "mesh/surface.h"
#include "nonobtuse/mesh.h"

namespace nonobtuse::mesh {

/// An edge named from one side: the edge of `triangle` opposite its corner `corner`.
struct Edge {
  Index triangle = -1;
  int corner = 0;
  [[nodiscard]] bool valid() const { return triangle >= 0; }
};

class EditableMesh {
 public:
  EditableMesh() = default;
  /// Takes a manifold, consistently oriented mesh (boundary allowed), as `clean` leaves it.
  EditableMesh(std::vector<Vec3> vertices, std::vector<Triangle> triangles);

  std::vector<Vec3> positions;  ///< #V by 3; free to move at any time
  /// #V: the vertex's knot on a curve network, -1 for none; or empty if no vertex has one. Edits
  /// and `compact` keep it; new vertices have none.
  std::vector<Index> knot;

  [[nodiscard]] Index vertex_capacity() const { return static_cast<Index>(positions.size()); }
  [[nodiscard]] Index triangle_capacity() const { return static_cast<Index>(triangles_.size()); }
  [[nodiscard]] Index vertex_count() const { return vertex_count_; }      ///< alive
  [[nodiscard]] Index triangle_count() const { return triangle_count_; }  ///< alive
  [[nodiscard]] bool alive_vertex(Index v) const { return vertex_triangle_[v] >= 0; }
  [[nodiscard]] bool alive_triangle(Index t) const { return triangles_[t][0] >= 0; }
  [[nodiscard]] const Triangle& triangle(Index t) const { return triangles_[t]; }
  [[nodiscard]] const std::vector<Triangle>& triangles() const { return triangles_; }
  /// Triangle across the edge of t opposite corner k; -1 at the boundary.
  [[nodiscard]] Index adjacent(Index t, int k) const { return adjacent_[t][k]; }
  /// Corner of t at vertex v; v must be in t.
  [[nodiscard]] int corner_of(Index t, Index v) const {
    const Triangle& c = triangles_[t];
    return c[0] == v ? 0 : c[1] == v ? 1 : 2;
  }
  /// The same edge named from the other side (invalid at the boundary).
  [[nodiscard]] Edge twin(Edge e) const {
    const Index u = adjacent_[e.triangle][e.corner];
    return u < 0 ? Edge{} : Edge{u, previous(corner_of(u, head(e)))};
  }
  [[nodiscard]] Index opposite_vertex(Edge e) const { return triangles_[e.triangle][e.corner]; }
  [[nodiscard]] Index tail(Edge e) const { return triangles_[e.triangle][next(e.corner)]; }
  [[nodiscard]] Index head(Edge e) const { return triangles_[e.triangle][previous(e.corner)]; }
  /// Some triangle of v; for a boundary vertex the one from which walking counter-clockwise
  /// (across the edge opposite the corner `next(k)`) meets all the others.
  [[nodiscard]] Index triangle_of(Index v) const { return vertex_triangle_[v]; }
  [[nodiscard]] bool on_boundary(Index v) const {
    const Index t = vertex_triangle_[v];
    return adjacent_[t][previous(corner_of(t, v))] < 0;
  }
  [[nodiscard]] int valence(Index v) const { return valence_[v]; }  ///< number of neighbours
  /// Triangles around v, counter-clockwise (boundary: from the first to the last).
  void triangles_around(Index v, std::vector<Index>& out) const;
  /// Neighbours of v, counter-clockwise (boundary: one more than triangles).
  void neighbors(Index v, std::vector<Index>& out) const;
  /// The edge between a and b, named from the side in which it runs from a to b if there is one;
  /// invalid if a and b are not joined.
  [[nodiscard]] Edge find_edge(Index a, Index b) const;

  /// A flip replaces the edge by the other diagonal of its two triangles. Possible if the edge is
  /// interior, the new edge does not exist yet and no interior valence falls below 3 (boundary: 2).
  [[nodiscard]] bool can_flip(Edge e) const;
  /// Flips; the triangles keep their indices: both now contain the new diagonal.
  /// Returns the new edge (named from e.triangle), so that flip(returned) is the inverse up to
  /// the naming of corners and triangles.
  Edge flip(Edge e);

  /// Whether the edge can be contracted so that `removed` disappears into the other end: the link
  /// condition with its boundary form; a boundary vertex may only go along a boundary edge, a
  /// loop keeps at least 3 edges, a closed component at least 4 vertices.
  [[nodiscard]] bool can_collapse(Edge e, Index removed) const;
  /// Contracts; the surviving vertex keeps its position.
  void collapse(Edge e, Index removed);

  /// Splits the edge at `position`; returns the new vertex. Two new triangles (one at a boundary).
  Index split_edge(Edge e, const Vec3& position);
  /// Splits a triangle in three; returns the new vertex.
  Index split_triangle(Index t, const Vec3& position);

  /// Drops what was removed and renumbers in order; returns old vertex of each new one.
  std::vector<Index> compact();
  [[nodiscard]] TriangleMesh to_mesh() const;  ///< compact copy

  /// Throws std::logic_error naming the first broken invariant (for tests and debug builds).
  void check_invariants() const;

 private:
  std::vector<Triangle> triangles_;  // [-1,-1,-1] where removed
  std::vector<std::array<Index, 3>> adjacent_;
  std::vector<Index> vertex_triangle_;  // -1 where removed
  std::vector<int> valence_;
  Index vertex_count_ = 0;
  Index triangle_count_ = 0;

  // Declares two names of one edge to be twins; one of them may be invalid (boundary).
  void join(Edge e, Edge other);
  // Sets triangle_of(v), starting the search at its triangle t.
  void set_first_triangle(Index v, Index t);
  // Removes triangle t, whose corner `apex` lies opposite a contracted edge, by joining the
  // neighbours across its two other edges.
  void close_up(Index t, int apex);
  Index add_vertex(const Vec3& position, int valence);
  Index add_triangle(const Triangle& corners);
};

}  // namespace nonobtuse::mesh
