// Trial edits with rollback: a patch is a copy of a neighbourhood, small enough to copy again for
// every attempt; a sequence of edits that proves itself there is replayed on the whole mesh.
#pragma once

#include <compare>
#include <span>
#include <vector>

#include "energy/mesh_shape.h"
#include "mesh/editable_mesh.h"
#include "refine/angle_goal.h"
#include "refine/fidelity.h"

namespace nonobtuse::refine {

/// One edit of the connectivity, by vertices.
struct Edit {
  enum class Kind { Flip, Collapse, Split, CollapseCurve, SplitCurve };
  Kind kind;
  Index a, b;  ///< Flip, Split: the edge ab. Collapse: a disappears into b. The last two: any
               ///< copies of the knots, done on all sides of the curve (curve_edits.h)
};

/// Whether the mesh admits the edit (topology, knots, and that no triangle turns over).
bool edit_possible(const mesh::EditableMesh& mesh, const Knots& knots, const Edit& edit);
/// Applies it; a Split puts the new vertex at the middle. Returns the new vertices.
std::vector<Index> apply_edit(mesh::EditableMesh& mesh, Knots& knots, const Edit& edit);
/// The same, and hands the samples of the triangles that change to those that replace them.
std::vector<Index> apply_edit(mesh::EditableMesh& mesh, Fidelity& fidelity, const Edit& edit);

/// How good a patch or mesh is: compared in the order of the members, smaller is better.
struct PatchScore {
  Index folded = 0;           ///< triangles turned over against the surface or a neighbour
  Index bad_valence = 0;      ///< summed distance of the valences from the good ones
  Index outside_promise = 0;  ///< triangles
  Index outside_goal = 0;     ///< triangles
  double energy = 0;
  [[nodiscard]] bool operator<(const PatchScore& other) const;
};

class Patch {
 public:
  /// Copies the triangles that touch a vertex within `rings` rings of `center`; rings go on across
  /// curves, and of a knot all sectors are copied.
  Patch(const mesh::EditableMesh& mesh, const Fidelity& fidelity, std::span<const Index> center,
        int rings);

  mesh::EditableMesh mesh;
  Fidelity fidelity;
  std::vector<Index> vertex;    ///< local -> global; grows by splits
  std::vector<Index> triangle;  ///< local -> global, of the triangles copied
  std::vector<Edit> edits;      ///< done so far, in local vertices

  /// Local index of a global vertex of the patch, before any edits.
  [[nodiscard]] Index local(Index global) const;
  /// Valence of local vertex v in the whole mesh.
  [[nodiscard]] int valence(Index v) const { return mesh.valence(v) + hidden_[v]; }
  /// Whether v is on the boundary of the whole mesh.
  [[nodiscard]] bool boundary(Index v) const { return boundary_[v]; }
  /// Whether all triangles of v are in the patch, so that it may move and edges at it be edited.
  [[nodiscard]] bool inner(Index v) const { return inner_[v]; }
  [[nodiscard]] int defect(Index v) const { return fidelity.valences.defect(v, valence(v)); }
  [[nodiscard]] int total_defect() const;
  /// Edits that only touch what the patch knows entirely.
  [[nodiscard]] bool possible(const Edit& edit) const;
  /// Connectivity only: the samples are not handed on. For searching.
  void apply(const Edit& edit);
  /// With the samples.
  void apply_with_samples(const Edit& edit);
  /// Vertices that may move: inner ones, those on curves only if they slide.
  [[nodiscard]] std::vector<Index> inner_vertices() const;

  [[nodiscard]] PatchScore score(const energy::ShapeWeights& shape, const AngleTest& promise,
                                 const AngleTest& goal) const;
  /// Replays the edits on the whole mesh and takes over the positions. Returns the global
  /// triangles concerned.
  std::vector<Index> commit(mesh::EditableMesh& whole, Fidelity& whole_fidelity);

 private:
  void remember(const Edit& edit, const std::vector<Index>& made);
  [[nodiscard]] bool inner_knot(Index v) const;

  std::vector<int> hidden_;  // neighbours outside the patch
  std::vector<char> boundary_, inner_;
  std::vector<Index> knot_;  // local -> global
};

/// Triangles of the mesh that are turned over against the surface under their vertices, or folded
/// onto a neighbour (normals more than 143 degrees apart).
bool is_folded(const mesh::EditableMesh& mesh, const Fidelity& fidelity, Index t);

}  // namespace nonobtuse::refine
