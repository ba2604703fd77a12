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

}  // namespace nonobtuse::refine
