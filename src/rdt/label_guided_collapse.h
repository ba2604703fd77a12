// A mesh with the surface's topology and one vertex per site, by collapsing a copy of the surface:
// bisected until cells are resolved, labelled by a flood from the sites (so that every label is
// connected), and collapsed inside the labels under the link condition. Components, Euler
// characteristic and boundary loops hold by construction; labels decide quality alone.
#pragma once

#include <span>
#include <vector>

#include "mesh/editable_mesh.h"
#include "mesh/surface.h"

namespace nonobtuse::rdt {

struct CollapsedMesh {
  mesh::EditableMesh mesh;  ///< compact; exactly as many vertices as sites
  std::vector<Index> foot;  ///< #V: facet under each vertex
  Index extra = 0;          ///< vertices beyond one per site that the topology needed at first
};

/// `feet` (#X): the facet each site lies on or near; every component of the surface should hold
/// one (others get a tetrahedron's worth of vertices, taken from elsewhere). Vertices on a boundary
/// of the surface stay on it. Throws TooFewVertices where the link condition stops short of #X.
CollapsedMesh label_guided_collapse(const mesh::Surface& surface, std::span<const Vec3> sites,
                                    std::span<const Index> feet);

/// The same with all boundary vertices prescribed. `knots` (#K) are vertices of the surface, at
/// least three on every boundary loop, in any order; `sites` and `feet` (#X) are those of the
/// interior. In the result every boundary loop consists of its knots, in order and in place, and
/// `mesh.knot` (#V) tells which vertex is which (index into `knots`, -1 elsewhere). Knots in the
/// interior are kept in place as well. Where the topology needs more than #K + #X vertices there
/// are more: `mesh` may then be larger, and nothing is thrown.
CollapsedMesh label_guided_collapse(const mesh::Surface& surface, std::span<const Index> knots,
                                    std::span<const Vec3> sites, std::span<const Index> feet);

}  // namespace nonobtuse::rdt
