// Edge flips that lower shape plus fidelity and never spoil a valence.
#pragma once

#include <vector>

#include "energy/mesh_shape.h"
#include "mesh/editable_mesh.h"
#include "refine/fidelity.h"

namespace nonobtuse::refine {

/// Whether flipping e keeps the valences in order (or mends them), joins no two knots twice and
/// does not turn a triangle over: the new triangles agree with the old ones and with each other.
bool flip_allowed(const mesh::EditableMesh& mesh, const Fidelity& fidelity, mesh::Edge e);

/// Flips edges while that lowers the energy, in order of index; at most a few rounds. With
/// `triangles`, only edges of these (and what flips make of their surroundings) are tried. The
/// planes of the triangles flipped are walked anew. Returns the number of flips.
Index flip_edges(mesh::EditableMesh& mesh, Fidelity& fidelity, const energy::ShapeWeights& shape,
                 const std::vector<Index>* triangles = nullptr);

}  // namespace nonobtuse::refine
