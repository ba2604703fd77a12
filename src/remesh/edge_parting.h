// Edges of a mesh cut along feature curves that gluing would make one edge of four faces.
#pragma once

#include "mesh/editable_mesh.h"

namespace nonobtuse::pipeline {

/// Flips interior edges whose ends, knots or free vertices, are joined by another edge too: across
/// a narrow patch, or where a patch lies on both sides of a curve. Returns how many places are left
/// in which edges become one; in a `manifold` two curves that join the same knots by an edge each
/// are such, too.
Index part_edges(bool manifold, mesh::EditableMesh& mesh);

}  // namespace nonobtuse::pipeline
