// Closest point on a triangle, in barycentric coordinates, many points against one triangle.
// (Ericson, Real-Time Collision Detection, 2005, section 5.1.5, as a clamped quadratic.)
#pragma once

#include <array>

#include "numeric/vec3.h"

namespace nonobtuse::refine {

/// A point of a triangle nearest to a query.
struct ClosestPoint {
  std::array<double, 3> barycentric{1, 0, 0};
  double squared_distance = 0;

  /// Corners whose weight is exactly zero: the point lies on the opposite edges.
  [[nodiscard]] bool interior() const {
    return barycentric[0] > 0 && barycentric[1] > 0 && barycentric[2] > 0;
  }
};

/// What does not depend on the query. Works for triangles without area.
class TriangleFrame {
 public:
  TriangleFrame(const Vec3& p0, const Vec3& p1, const Vec3& p2)
      : p0_(p0),
        e1_(p1 - p0),
        e2_(p2 - p0),
        d11_(dot(e1_, e1_)),
        d12_(dot(e1_, e2_)),
        d22_(dot(e2_, e2_)) {
    const double det = d11_ * d22_ - d12_ * d12_;
    flat_ = !(det > 1e-14 * d11_ * d22_);
    inverse_ = flat_ ? 0 : 1 / det;
  }

  [[nodiscard]] ClosestPoint closest(const Vec3& y) const {
    const Vec3 v = y - p0_;
    const double a = dot(v, e1_), b = dot(v, e2_);
    const double s = (d22_ * a - d12_ * b) * inverse_;
    const double t = (d11_ * b - d12_ * a) * inverse_;
    ClosestPoint c;
    if (!flat_ && s > 0 && t > 0 && s + t < 1)
      c.barycentric = {1 - s - t, s, t};
    else
      c.barycentric = clamped(a, b);
    c.squared_distance = squared_length(v - c.barycentric[1] * e1_ - c.barycentric[2] * e2_);
    return c;
  }

 private:
  static double ratio(double numerator, double denominator) {
    return numerator <= 0 ? 0 : numerator >= denominator ? 1 : numerator / denominator;
  }

  // The nearest point of the three edges: right for every query whose foot lies outside.
  [[nodiscard]] std::array<double, 3> clamped(double a, double b) const {
    const double s = ratio(a, d11_);  // on edge p0 p1; distances less |v|^2
    const double f1 = d11_ * s * s - 2 * a * s;
    const double t = ratio(b, d22_);  // on edge p0 p2
    const double f2 = d22_ * t * t - 2 * b * t;
    const double w = ratio(b - a - d12_ + d11_, d11_ - 2 * d12_ + d22_);  // on edge p1 p2
    const double u = 1 - w;
    const double f3 = d11_ * u * u + 2 * d12_ * u * w + d22_ * w * w - 2 * a * u - 2 * b * w;
    if (f1 <= f2 && f1 <= f3) return {1 - s, s, 0};
    if (f2 <= f3) return {1 - t, 0, t};
    return {0, u, w};
  }

  Vec3 p0_, e1_, e2_;
  double d11_, d12_, d22_, inverse_ = 0;
  bool flat_ = false;
};

}  // namespace nonobtuse::refine
