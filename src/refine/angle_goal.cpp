#include "refine/angle_goal.h"

namespace nonobtuse::refine {

Index count_obtuse(const mesh::EditableMesh& mesh) {
  Index count = 0;
  for (Index t = 0; t < mesh.triangle_capacity(); ++t) {
    if (!mesh.alive_triangle(t)) continue;
    const Triangle& v = mesh.triangle(t);
    const auto s =
        energy::squared_edges(mesh.positions[v[0]], mesh.positions[v[1]], mesh.positions[v[2]]);
    if (s[0] >= s[1] + s[2] || s[1] >= s[2] + s[0] || s[2] >= s[0] + s[1]) ++count;
  }
  return count;
}

double mean_quality(const mesh::EditableMesh& mesh) {
  double sum = 0;
  for (Index t = 0; t < mesh.triangle_capacity(); ++t) {
    if (!mesh.alive_triangle(t)) continue;
    const Triangle& v = mesh.triangle(t);
    const Vec3 p = mesh.positions[v[0]], q = mesh.positions[v[1]], r = mesh.positions[v[2]];
    const double a = distance(q, r), b = distance(r, p), c = distance(p, q);
    const double half = 0.5 * (a + b + c), longest = std::max(a, std::max(b, c));
    sum += 6 / std::sqrt(3.0) * 0.5 * length(area_vector(p, q, r)) / (half * longest);
  }
  return mesh.triangle_count() > 0 ? sum / mesh.triangle_count() : 0;
}

}  // namespace nonobtuse::refine
