// Edits of a feature curve: a knot more or less on it, in all sectors at once.
#pragma once

#include <vector>

#include "mesh/editable_mesh.h"
#include "refine/fidelity.h"
#include "refine/knots.h"

namespace nonobtuse::refine {

/// The boundary edges between copies of the knots of a and b: one for each side of the curve.
std::vector<mesh::Edge> curve_sides(const mesh::EditableMesh& mesh, const Knots& knots, Index a,
                                    Index b);

/// Whether the edge of a curve between the knots of a and b can be split.
bool can_split_curve(const mesh::EditableMesh& mesh, const Knots& knots, Index a, Index b);
/// Splits it on all sides; the new knot lies halfway by arc length. Returns the new vertices.
std::vector<Index> split_curve(mesh::EditableMesh& mesh, Knots& knots, Index a, Index b);
/// The same with samples, planes and weights.
std::vector<Index> split_curve(mesh::EditableMesh& mesh, Fidelity& fidelity, Index a, Index b);

/// Whether the knot of `removed`, which must slide, can disappear into its neighbour, that of
/// `kept`: topology on all sides, no triangle turns over, no edge comes into being twice, and at
/// least two other knots stay on a closed curve.
bool can_collapse_curve(const mesh::EditableMesh& mesh, const Knots& knots, Index removed,
                        Index kept);
/// Contracts all sides; copies of the kept knot stay where they are.
void collapse_curve(mesh::EditableMesh& mesh, Knots& knots, Index removed, Index kept);
/// The same with samples and planes.
void collapse_curve(mesh::EditableMesh& mesh, Fidelity& fidelity, Index removed, Index kept);

}  // namespace nonobtuse::refine
