// Sets of vertices and triangles around given ones, as sorted lists.
#pragma once

#include <vector>

#include "mesh/editable_mesh.h"

namespace nonobtuse::refine {

/// Vertices of the triangles and of `rings` rings around them, by index.
std::vector<Index> dilated(const mesh::EditableMesh& mesh, const std::vector<Index>& triangles,
                           int rings);
/// Adds to a list of vertices those of `rings` rings around them; sorts it.
void add_rings(const mesh::EditableMesh& mesh, std::vector<Index>& vertices, int rings);
/// All triangles of the vertices, by index.
std::vector<Index> triangles_around(const mesh::EditableMesh& mesh,
                                    const std::vector<Index>& vertices);
void sort_unique(std::vector<Index>& list);

}  // namespace nonobtuse::refine
