// Which triangles are good enough.
#pragma once

#include <vector>

#include "energy/mesh_shape.h"
#include "mesh/editable_mesh.h"

namespace nonobtuse::refine {

/// Bounds that every angle should keep, in degrees.
struct AngleGoal {
  double smallest = 40;
  double largest = 80;
};

/// The promise that holds whatever was asked for; 90 and 30 themselves with a little to spare.
inline constexpr AngleGoal kPromise{30.05, 89.9};

/// Tests triangles against bounds by their cosines.
class AngleTest {
 public:
  explicit AngleTest(const AngleGoal& goal)
      : cos_smallest_(energy::cos_degrees(goal.smallest)),
        cos_largest_(energy::cos_degrees(goal.largest)) {}

  /// Whether all three angles are inside, for squared edges s.
  [[nodiscard]] bool inside(const std::array<double, 3>& s) const {
    for (int k = 0; k < 3; ++k) {
      const double b = s[mesh::next(k)], c = s[mesh::previous(k)];
      const double cosine = (b + c - s[k]) / (2 * std::sqrt(b * c));
      if (!(cosine >= cos_largest_ && cosine <= cos_smallest_)) return false;
    }
    return true;
  }
  [[nodiscard]] bool inside(const Vec3& p0, const Vec3& p1, const Vec3& p2) const {
    return inside(energy::squared_edges(p0, p1, p2));
  }
  [[nodiscard]] bool inside(const mesh::EditableMesh& mesh, Index t) const {
    const Triangle& v = mesh.triangle(t);
    return inside(mesh.positions[v[0]], mesh.positions[v[1]], mesh.positions[v[2]]);
  }

 private:
  double cos_smallest_, cos_largest_;
};

/// Triangles outside the bounds, by index.
inline std::vector<Index> triangles_outside(const mesh::EditableMesh& mesh, const AngleTest& test) {
  std::vector<Index> out;
  for (Index t = 0; t < mesh.triangle_capacity(); ++t)
    if (mesh.alive_triangle(t) && !test.inside(mesh, t)) out.push_back(t);
  return out;
}

/// Triangles with an angle of 90 degrees or more.
Index count_obtuse(const mesh::EditableMesh& mesh);

/// Mean over the triangles of Q = 6/sqrt(3) S/(p h), 1 for equilateral ones.
double mean_quality(const mesh::EditableMesh& mesh);

}  // namespace nonobtuse::refine
