#include "remesh/valence_optimization.h"

#include "refine/flips.h"

namespace nonobtuse::pipeline {

Index optimize_valence(const mesh::Surface&, mesh::EditableMesh& mesh, const parallel::Workers&,
                       parallel::Monitor&) {
  Index bad = 0;
  for (Index v = 0; v < mesh.vertex_capacity(); ++v)
    bad += mesh.alive_vertex(v) && !mesh.on_boundary(v) &&
           !refine::good_valence(mesh.valence(v), false);
  return bad;
}

}  // namespace nonobtuse::pipeline
