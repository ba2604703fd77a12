// Closest point on a triangle: Voronoi regions of its features (Ericson, Real-Time Collision
// Detection, 2005, section 5.1.5), with a slower and safer way for slivers, where the regions'
// signs are lost to rounding.
#pragma once

#include "numeric/vec3.h"

namespace nonobtuse::spatial {

struct ClosestPoint {
  Vec3 point;
  Vec3 barycentric;  ///< weights of a, b, c: >= 0, sum 1 up to rounding
  double squared_distance = 0;
};

/// The point of segment (a, b) nearest to p; the third weight is 0. Total: a may equal b.
inline ClosestPoint closest_point_on_segment(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 ab = b - a;
  const double along = dot(p - a, ab);
  const double whole = squared_length(ab);
  if (!(along > 0)) return {a, {1, 0, 0}, squared_distance(p, a)};
  if (along >= whole) return {b, {0, 1, 0}, squared_distance(p, b)};
  const double t = along / whole;
  const Vec3 q = a + t * ab;
  return {q, {1 - t, t, 0}, squared_distance(p, q)};
}

/// The same for triangles of (almost) no area: the best of the sides and of the projection.
ClosestPoint closest_point_on_sliver(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c);

/// The point of triangle (a, b, c) nearest to p. Total: the triangle may be degenerate.
inline ClosestPoint closest_point_on_triangle(const Vec3& p, const Vec3& a, const Vec3& b,
                                              const Vec3& c) {
  const Vec3 ab = b - a;
  const Vec3 ac = c - a;
  const Vec3 ap = p - a;
  const double d1 = dot(ab, ap);
  const double d2 = dot(ac, ap);
  if (d1 <= 0 && d2 <= 0) return {a, {1, 0, 0}, squared_length(ap)};

  const Vec3 bp = p - b;
  const double d3 = dot(ab, bp);
  const double d4 = dot(ac, bp);
  if (d3 >= 0 && d4 <= d3) return {b, {0, 1, 0}, squared_length(bp)};

  const Vec3 cp = p - c;
  const double d5 = dot(ab, cp);
  const double d6 = dot(ac, cp);
  if (d6 >= 0 && d5 <= d6) return {c, {0, 0, 1}, squared_length(cp)};

  // In a triangle of height h and length l the signs below carry an error of (l / h)^2 ulps.
  const Vec3 normal = cross(ab, ac);
  if (squared_length(normal) <= 1e-9 * squared_length(ab) * squared_length(ac))
    return closest_point_on_sliver(p, a, b, c);

  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) {
    const double t = d1 / (d1 - d3);
    const Vec3 q = a + t * ab;
    return {q, {1 - t, t, 0}, squared_distance(p, q)};
  }
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) {
    const double t = d2 / (d2 - d6);
    const Vec3 q = a + t * ac;
    return {q, {1 - t, 0, t}, squared_distance(p, q)};
  }
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 >= d3 && d5 >= d6) {
    const double t = (d4 - d3) / ((d4 - d3) + (d5 - d6));
    const Vec3 q = b + t * (c - b);
    return {q, {0, 1 - t, t}, squared_distance(p, q)};
  }
  const double sum = va + vb + vc;
  const double v = vb / sum;
  const double w = vc / sum;
  const Vec3 q = a + v * ab + w * ac;
  return {q, {std::max(0.0, 1 - v - w), v, w}, squared_distance(p, q)};
}

}  // namespace nonobtuse::spatial
