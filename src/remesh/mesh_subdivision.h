// From a coarse mesh on the surface to one with four times the triangles.
#pragma once

#include "mesh/surface.h"
#include "remesh/mesh_tessellation.h"

namespace nonobtuse::pipeline {

/// Every triangle in four: new vertices lie on the surface over the middles of the edges and have
/// valence six, the old ones keep theirs. Then edges are split, the longest first, or contracted,
/// the shortest first, until there are `count` vertices. Topology as before; compact, along a
/// space-filling curve. `coarse` must be closed and `count` about what its vertices and edges are.
MeshOnSurface subdivided(const mesh::Surface& surface, const MeshOnSurface& coarse, Index count);

}  // namespace nonobtuse::pipeline
