// Angles and shape of one triangle, in doubles and, where it decides, exactly.
#pragma once

#include <array>
#include <span>

#include "nonobtuse/mesh.h"
#include "parallel/workers.h"

namespace nonobtuse::quality {

/// Figures of one triangle, in doubles; scale-free.
struct TriangleShape {
  /// Cotangents of the angles at corners 0, 1, 2: +inf at 0 and -inf at 180 degrees. A corner at
  /// which two vertices coincide has +inf.
  std::array<double, 3> cotangents{};
  std::array<double, 3> angles{};  ///< degrees
  double quality = 0;              ///< Q = 6/sqrt(3) S/(p h); 0 without area
};
TriangleShape shape_of(const Vec3& a, const Vec3& b, const Vec3& c);

/// Whether every angle is below a bound in (60, 90] degrees, or at least one in [0, 60]: exact at
/// 0, 30, 45, 60 and 90 degrees, and elsewhere never true by error: the bound's squared cosine is
/// taken some ulps on the safe side. A triangle without area is outside every bound.
class AngleBounds {
 public:
  AngleBounds(double min_angle, double max_angle);

  [[nodiscard]] bool below_max(const Vec3& a, const Vec3& b, const Vec3& c) const;
  [[nodiscard]] bool above_min(const Vec3& a, const Vec3& b, const Vec3& c) const;

 private:
  double squared_cosine_min_;  // of min_angle, at most the true one
  double squared_cosine_max_;  // of max_angle, at least the true one
};

/// Number of triangles with an angle >= 90 degrees, decided exactly; about 10 ns a triangle.
Index count_obtuse(std::span<const Vec3> vertices, std::span<const Triangle> triangles,
                   const parallel::Workers& workers);

}  // namespace nonobtuse::quality
