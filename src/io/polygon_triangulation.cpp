#include "io/polygon_triangulation.h"

#include <algorithm>
#include <cmath>

#include "numeric/vec3.h"

namespace nonobtuse::io {

namespace {

struct Point {
  double x;
  double y;
};

// Twice the signed area.
double orient(const Point& a, const Point& b, const Point& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

// Signed area over the sum of squared edges: positive for a counter-clockwise triangle, largest
// for the equilateral one.
double shape(const Point& a, const Point& b, const Point& c) {
  const auto squared = [](const Point& p, const Point& q) {
    return (p.x - q.x) * (p.x - q.x) + (p.y - q.y) * (p.y - q.y);
  };
  const double sum = squared(a, b) + squared(b, c) + squared(c, a);
  return sum > 0 ? orient(a, b, c) / sum : 0;
}

// The corners in the coordinate plane nearest to the polygon's (Newell normal), counter-clockwise,
// scaled by a power of two so that no product overflows.
std::vector<Point> project(const std::vector<Vec3>& vertices, const Index* corners,
                           std::size_t count) {
  double largest = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3& p = vertices[corners[i]];
    largest = std::max({largest, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
  }
  int exponent = 0;
  std::frexp(largest, &exponent);
  const auto at = [&](std::size_t i) {
    const Vec3& p = vertices[corners[i]];
    return Vec3{std::ldexp(p.x, -exponent), std::ldexp(p.y, -exponent), std::ldexp(p.z, -exponent)};
  };
  const Vec3 origin = at(0);
  Vec3 normal;
  for (std::size_t i = 1; i + 1 < count; ++i) normal += cross(at(i) - origin, at(i + 1) - origin);
  const Vec3 size{std::abs(normal.x), std::abs(normal.y), std::abs(normal.z)};
  std::vector<Point> points(count);
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3 p = at(i) - origin;
    if (size.z >= size.x && size.z >= size.y)
      points[i] = normal.z >= 0 ? Point{p.x, p.y} : Point{p.y, p.x};
    else if (size.x >= size.y)
      points[i] = normal.x >= 0 ? Point{p.y, p.z} : Point{p.z, p.y};
    else
      points[i] = normal.y >= 0 ? Point{p.z, p.x} : Point{p.x, p.z};
  }
  return points;
}

class EarClipper {
 public:
  EarClipper(const Index* corners, std::vector<Point> points, std::vector<Triangle>& out)
      : corners_(corners), points_(std::move(points)), out_(out) {
    for (std::size_t i = 0; i < points_.size(); ++i) ring_.push_back(i);
  }

  void run() {
    while (ring_.size() > 4) clip(best_ear());
    // Of the last four, the diagonal whose worse triangle is better.
    const auto worse = [&](std::size_t i) { return std::min(shape_at(i), shape_at((i + 2) % 4)); };
    if (ring_.size() == 4) clip(worse(1) >= worse(0) ? 1 : 0);
    clip(1);
  }

 private:
  [[nodiscard]] std::size_t before(std::size_t i) const {
    return i == 0 ? ring_.size() - 1 : i - 1;
  }
  [[nodiscard]] std::size_t after(std::size_t i) const { return i + 1 == ring_.size() ? 0 : i + 1; }
  [[nodiscard]] const Point& point(std::size_t i) const { return points_[ring_[i]]; }
  [[nodiscard]] double shape_at(std::size_t i) const {
    return shape(point(before(i)), point(i), point(after(i)));
  }

  // No other corner in the closed triangle cut off at i; copies of its corners do not count.
  [[nodiscard]] bool is_empty(std::size_t i) const {
    const Point& a = point(before(i));
    const Point& b = point(i);
    const Point& c = point(after(i));
    for (std::size_t j = 0; j < ring_.size(); ++j) {
      if (j == i || j == before(i) || j == after(i)) continue;
      const Point& p = point(j);
      const auto same = [&](const Point& q) { return p.x == q.x && p.y == q.y; };
      if (same(a) || same(b) || same(c)) continue;
      if (orient(a, b, p) >= 0 && orient(b, c, p) >= 0 && orient(c, a, p) >= 0) return false;
    }
    return true;
  }

  // The best-shaped ear of a small polygon, the next one of a large polygon (quadratic in total
  // where corners are mostly convex). If rounding or a self-crossing hides every ear, the
  // best-shaped corner.
  [[nodiscard]] std::size_t best_ear() const {
    constexpr std::size_t small = 32;
    std::size_t best = ring_.size();
    std::size_t fallback = 0;
    for (std::size_t i = 0; i < ring_.size(); ++i) {
      const std::size_t candidate = ring_.size() > small ? (next_ + i) % ring_.size() : i;
      const double s = shape_at(candidate);
      if (s > shape_at(fallback)) fallback = candidate;
      if (s <= 0 || (best != ring_.size() && s <= shape_at(best)) || !is_empty(candidate)) continue;
      best = candidate;
      if (ring_.size() > small) break;
    }
    return best == ring_.size() ? fallback : best;
  }

  void clip(std::size_t i) {
    out_.push_back({corners_[ring_[before(i)]], corners_[ring_[i]], corners_[ring_[after(i)]]});
    ring_.erase(ring_.begin() + static_cast<std::ptrdiff_t>(i));
    next_ = i + 1;
  }

  const Index* corners_;
  std::vector<Point> points_;
  std::vector<Triangle>& out_;
  std::vector<std::size_t> ring_;  // corners left
  std::size_t next_ = 0;
};

}  // namespace

void triangulate_polygon(const std::vector<Vec3>& vertices, const Index* corners, std::size_t count,
                         std::vector<Triangle>& out) {
  EarClipper(corners, project(vertices, corners, count), out).run();
}

}  // namespace nonobtuse::io
