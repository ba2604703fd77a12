// Slivers: each candidate's distance is computed for itself, so that no lost sign can name a far
// feature.
#include "spatial/closest_point.h"

namespace nonobtuse::spatial {

ClosestPoint closest_point_on_sliver(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  ClosestPoint best = closest_point_on_segment(p, a, b);
  ClosestPoint side = closest_point_on_segment(p, b, c);
  if (side.squared_distance < best.squared_distance) {
    best = side;
    best.barycentric = {0, side.barycentric.x, side.barycentric.y};
  }
  side = closest_point_on_segment(p, c, a);
  if (side.squared_distance < best.squared_distance) {
    best = side;
    best.barycentric = {side.barycentric.y, 0, side.barycentric.x};
  }
  // Areas from cross products lose (l / h) ulps, not their square.
  const Vec3 n = area_vector(a, b, c);
  const double u = dot(n, cross(b - p, c - p));
  const double v = dot(n, cross(c - p, a - p));
  const double w = dot(n, cross(a - p, b - p));
  const double sum = u + v + w;
  if (!(u >= 0 && v >= 0 && w >= 0 && sum > 0)) return best;
  const Vec3 weights = Vec3{u, v, w} / sum;
  const Vec3 q = weights.x * a + weights.y * b + weights.z * c;
  const double d = squared_distance(p, q);
  return d < best.squared_distance ? ClosestPoint{q, weights, d} : best;
}

}  // namespace nonobtuse::spatial
