// Part of nonobtuse, MIT licence. The mesh that goes in and comes out.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace nonobtuse {

/// Index of a vertex, triangle or seed; -1 means "none".
using Index = std::int32_t;

/// A point or vector in space, in the units of the mesh it belongs to.
struct Vec3 {
  double x = 0;
  double y = 0;
  double z = 0;

  friend constexpr bool operator==(const Vec3&, const Vec3&) = default;
};

/// Three vertex indices, counter-clockwise seen from outside.
using Triangle = std::array<Index, 3>;

/// An indexed triangle mesh: `vertices` is #V by 3, `triangles` #F by 3 with entries in [0, #V).
struct TriangleMesh {
  std::vector<Vec3> vertices;
  std::vector<Triangle> triangles;
};

}  // namespace nonobtuse
