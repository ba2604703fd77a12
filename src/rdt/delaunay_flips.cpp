// Delaunay criterion by cotangents: angles a, b sum to more than 180 degrees iff
// cot a + cot b < 0.
#include "rdt/delaunay_flips.h"

#include <algorithm>

namespace nonobtuse::rdt {

namespace {

using mesh::Edge;
using mesh::EditableMesh;

class Flipper {
 public:
  Flipper(const mesh::Surface& surface, const std::vector<Index>& foot, EditableMesh& mesh)
      : surface_(surface), foot_(foot), mesh_(mesh) {}

  bool improve(Edge e) {
    const Edge o = mesh_.twin(e);
    if (!o.valid()) return false;
    const Index p = mesh_.opposite_vertex(e);
    const Index q = mesh_.opposite_vertex(o);
    const Index a = mesh_.tail(e);
    const Index b = mesh_.head(e);
    if (!(cotangent_sum(p, q, a, b) < -1e-9) || !mesh_.can_flip(e)) return false;
    const int before = against({p, a, b}) + against({q, b, a});
    const int after = against({p, a, q}) + against({q, b, p});
    if (after > before) return false;
    if (fold({p, a, q}, {q, b, p}) < std::min(0.5, fold({p, a, b}, {q, b, a}))) return false;
    mesh_.flip(e);
    return true;
  }

 private:
  [[nodiscard]] Vec3 area(const Triangle& t) const {
    return area_vector(mesh_.positions[t[0]], mesh_.positions[t[1]], mesh_.positions[t[2]]);
  }
  [[nodiscard]] double cotangent_sum(Index p, Index q, Index a, Index b) const {
    const auto& x = mesh_.positions;
    const Vec3 pa = x[a] - x[p];
    const Vec3 pb = x[b] - x[p];
    const Vec3 qa = x[a] - x[q];
    const Vec3 qb = x[b] - x[q];
    const double sin_p = length(cross(pa, pb));
    const double sin_q = length(cross(qa, qb));
    // Without dividing: the sign of cot p + cot q, relative to the squared edge lengths.
    const double scale = squared_length(pa) + squared_length(qb);
    return (dot(pa, pb) * sin_q + dot(qa, qb) * sin_p) / (scale * scale + 1e-300);
  }
  [[nodiscard]] int against(const Triangle& t) const {
    return dot(area(t), reference_normal(surface_, foot_, t)) <= 0 ? 1 : 0;
  }
  // Cosine of the angle between two triangles' normals; 1 for a flat edge.
  [[nodiscard]] double fold(const Triangle& s, const Triangle& t) const {
    return dot(normalized(area(s)), normalized(area(t)));
  }

  const mesh::Surface& surface_;
  const std::vector<Index>& foot_;
  EditableMesh& mesh_;
};

}  // namespace

Vec3 reference_normal(const mesh::Surface& surface, const std::vector<Index>& foot,
                      const Triangle& t) {
  return normalized(surface.normals[foot[t[0]]] + surface.normals[foot[t[1]]] +
                    surface.normals[foot[t[2]]]);
}

Index delaunay_flips(const mesh::Surface& surface, const std::vector<Index>& foot,
                     EditableMesh& mesh, int sweeps) {
  Flipper flipper(surface, foot, mesh);
  Index total = 0;
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    Index flips = 0;
    for (Index t = 0; t < mesh.triangle_capacity(); ++t)
      for (int k = 0; k < 3 && mesh.alive_triangle(t); ++k)
        if (mesh.adjacent(t, k) > t && flipper.improve({t, k})) ++flips;
    total += flips;
    if (flips == 0) break;
  }
  return total;
}

}  // namespace nonobtuse::rdt
