// Vertices on feature curves. The mesh is cut along them, so that a knot has a copy in every
// sector; all copies lie at one place, and where the knot may slide, that place has one unknown:
// its arc along the curve.
#pragma once

#include <vector>

#include "mesh/curve_network.h"
#include "mesh/editable_mesh.h"

namespace nonobtuse::refine {

/// A knot of the network with its vertices and its neighbours along the curve.
struct SlidingKnot {
  mesh::Knot place;           ///< the arc need not be canonical
  Index before = -1;          ///< neighbour at lower arcs; -1: the curve's end
  Index after = -1;           ///< neighbour at higher arcs
  bool slides = false;        ///< on a curve, and all its copies are known here
  std::vector<Index> copies;  ///< vertices, by index; may be empty
};

class Knots {
 public:
  Knots() = default;
  /// The knots of all vertices. Keeps a pointer to the curves, which must outlive this.
  Knots(const mesh::CurveNetwork& network, const mesh::EditableMesh& mesh);
  /// Those of some vertices of a mesh, renumbered: vertex i is `vertices[i]` there. Only knots with
  /// all copies `inner` (by new index) slide. `old` receives the number that each had.
  Knots(const Knots& whole, const mesh::EditableMesh& mesh, const std::vector<Index>& vertices,
        const std::vector<char>& inner, std::vector<Index>& old);

  std::vector<SlidingKnot> all;  ///< #K

  [[nodiscard]] bool empty() const { return all.empty(); }
  [[nodiscard]] const mesh::Curve& curve(Index knot) const {
    return network_->curves[all[knot].place.curve];
  }
  [[nodiscard]] const mesh::CurveNetwork* network() const { return network_; }
  /// The knot of a vertex if it slides, else -1.
  [[nodiscard]] Index sliding(const mesh::EditableMesh& mesh, Index v) const {
    const Index knot = empty() ? -1 : mesh.knot[v];
    return knot >= 0 && all[knot].slides ? knot : -1;
  }
  /// One vertex for all copies: the first of them; a vertex without knot itself.
  [[nodiscard]] Index representative(const mesh::EditableMesh& mesh, Index v) const {
    const Index knot = empty() ? -1 : mesh.knot[v];
    return knot >= 0 ? all[knot].copies.front() : v;
  }

  /// Length along the curve to the neighbour (or end of the curve) before and after.
  [[nodiscard]] double room_before(Index knot) const;
  [[nodiscard]] double room_after(Index knot) const;
  /// A step along the curve, shortened so that the order is kept and, if the neighbours do the
  /// same, knots stay `spacing` apart (or as near as they are).
  [[nodiscard]] double limited(Index knot, double step, double spacing) const;
  /// Puts all copies to the point at `arc`.
  void move(mesh::EditableMesh& mesh, Index knot, double arc);
  /// Brings all arcs into canonical form.
  void make_canonical();
  /// Writes the knots back to the network they come from.
  void store(mesh::CurveNetwork& network) const;

  /// A new knot without copies between two neighbours (-1: the curve's end); returns its number.
  Index insert(const mesh::Knot& place, Index before, Index after);
  /// Takes a knot out of its curve; its number stays unused.
  void remove(Index knot);

  /// Whether an edge between a and b may come into being: not between two copies of one knot, nor
  /// where they or other copies of their knots are joined already, since the edges would become
  /// one.
  [[nodiscard]] bool edge_allowed(const mesh::EditableMesh& mesh, Index a, Index b) const;
  /// Whether a free vertex may disappear into b: none of its neighbours meets b a second time.
  [[nodiscard]] bool collapse_allowed(const mesh::EditableMesh& mesh, Index removed, Index b) const;
  /// Adds all other copies of the vertices' knots; sorts. Returns whether there were any.
  bool add_copies(const mesh::EditableMesh& mesh, std::vector<Index>& vertices) const;

 private:
  const mesh::CurveNetwork* network_ = nullptr;

  void link_neighbors();
};

}  // namespace nonobtuse::refine
