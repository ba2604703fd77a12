#include "refine/valence_rule.h"

#include "refine/fidelity.h"

namespace nonobtuse::refine {

void ValenceRule::measure(const mesh::EditableMesh& mesh) {
  ranges_.clear();
  for (Index v = 0; v < mesh.vertex_capacity(); ++v)
    if (mesh.alive_vertex(v) && mesh.on_boundary(v)) measure(mesh, v);
}

void ValenceRule::measure(const mesh::EditableMesh& mesh, Index v) {
  double degrees = 0;
  for_ring(mesh, v, [&](Index t, int k) {
    const std::array<Vec3, 3> p = corners(mesh, t);
    degrees += mesh::corner_degrees(p[k], p[mesh::next(k)], p[mesh::previous(k)]);
  });
  set(v, mesh.on_boundary(v) ? mesh::sector_valence(degrees) : mesh::ValenceRange{});
}

void ValenceRule::set(Index v, const mesh::ValenceRange& range) {
  if (v >= static_cast<Index>(ranges_.size())) ranges_.resize(v + 1);
  ranges_[v] = range;
}

}  // namespace nonobtuse::refine
