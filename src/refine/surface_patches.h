// The surface and the mesh cut along feature curves fall into patches: connected components. A
// sample of one patch has nothing to do with a triangle of another, however near, so that nothing
// is drawn across a crease or through a thin plate.
#pragma once

#include <memory>
#include <vector>

#include "mesh/editable_mesh.h"
#include "mesh/surface.h"
#include "parallel/workers.h"
#include "spatial/triangle_bvh.h"

namespace nonobtuse::refine {

/// Connected components of the surface: #F, numbered by lowest facet.
std::vector<Index> surface_patches(const mesh::Surface& surface);
/// For every vertex the surface's patch that its component of the mesh lies on: the one most of its
/// area is nearest to. `of_facet` as surface_patches gives it.
std::vector<Index> mesh_patches(const mesh::EditableMesh& mesh, const mesh::Surface& surface,
                                const spatial::TriangleBvh& surface_bvh,
                                const std::vector<Index>& of_facet,
                                const parallel::Workers& workers);

/// Which facets and vertices belong together. Empty: all do.
class PatchLabels {
 public:
  std::shared_ptr<const std::vector<Index>> of_facet;  ///< #F of the surface
  std::vector<Index> of_vertex;                        ///< #V of the mesh

  [[nodiscard]] bool empty() const { return of_vertex.empty(); }
  [[nodiscard]] bool agree(Index facet, Index vertex) const {
    return empty() || (*of_facet)[facet] == of_vertex[vertex];
  }
  [[nodiscard]] bool same_patch(Index v, Index w) const {
    return empty() || of_vertex[v] == of_vertex[w];
  }
  /// A new vertex beside another.
  void add_beside(Index v) {
    if (!empty()) of_vertex.push_back(of_vertex[v]);
  }
};

}  // namespace nonobtuse::refine
