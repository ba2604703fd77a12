// Exact signs of orientations and angles, for any finite doubles: first in doubles with an error
// bound (Shewchuk 1997), then in expansions of the coordinates scaled by a power of two, and where
// their magnitudes lie so far apart that products would underflow, in integers. Thread-safe.
#pragma once

#include "nonobtuse/mesh.h"

namespace nonobtuse::numeric {

/// A point of the plane.
struct Vec2 {
  double x = 0;
  double y = 0;
  friend constexpr bool operator==(const Vec2&, const Vec2&) = default;
};

/// +1 if a, b, c turn counter-clockwise, -1 clockwise, 0 if they lie on a line.
int orient2d(const Vec2& a, const Vec2& b, const Vec2& c);

/// +1 if d lies on the side of plane (a, b, c) to which (b - a) x (c - a) points, -1 on the other,
/// 0 if the four lie on a plane.
int orient3d(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

/// Sign of (p - apex) . (q - apex): +1 if the angle at `apex` is acute, 0 right, -1 obtuse.
int dot_sign(const Vec3& apex, const Vec3& p, const Vec3& q);

/// Sign of u.v^2 - squared_cosine u^2 v^2 with u = p - apex, v = q - apex: for an acute angle, +1
/// if it is below the angle of that cosine. 0 <= squared_cosine <= 1, not below 1e-40 unless 0.
int compare_squared_cosine(const Vec3& apex, const Vec3& p, const Vec3& q, double squared_cosine);

/// Whether a, b, c lie on a line (or coincide).
bool collinear(const Vec3& a, const Vec3& b, const Vec3& c);

/// Drops one coordinate; cyclic, so that orientation is kept: axis 0 gives (y, z).
constexpr Vec2 without(int axis, const Vec3& p) {
  return axis == 0 ? Vec2{p.y, p.z} : axis == 1 ? Vec2{p.z, p.x} : Vec2{p.x, p.y};
}

}  // namespace nonobtuse::numeric
