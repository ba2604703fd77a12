// Removes vertices that are too many by edge collapses which keep the topology.
#pragma once

#include <vector>

#include "mesh/editable_mesh.h"
#include "mesh/surface.h"

namespace nonobtuse::rdt {

/// Collapses short edges under the link condition until `count` vertices are left or none can go;
/// compacts `mesh` and `foot`. Vertices with a knot stay. First only where no triangle turns against the surface or crosses
/// another; where that is not enough, without the crossing guard, then without any.
void reduce_vertices(const mesh::Surface& surface, Index count, mesh::EditableMesh& mesh,
                     std::vector<Index>& foot);

}  // namespace nonobtuse::rdt
