// Oracle: intersection of triangles by clipping in rational arithmetic.
#include "quality/self_intersections.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <boost/multiprecision/cpp_int.hpp>
#include <vector>

#include "meshes.h"
#include "nonobtuse/quality.h"

namespace nonobtuse::quality {
namespace {

using Rational = boost::multiprecision::cpp_rational;
using Corners = std::array<Vec3, 3>;

struct Point {
  Rational x, y, z;
  friend bool operator==(const Point&, const Point&) = default;
};

Point exact(const Vec3& p) { return {Rational(p.x), Rational(p.y), Rational(p.z)}; }
Point operator-(const Point& a, const Point& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
Rational dot(const Point& a, const Point& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
Point cross(const Point& a, const Point& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

// Sutherland-Hodgman: the part of the convex polygon where n . (x - o) >= 0.
std::vector<Point> clipped(const std::vector<Point>& polygon, const Point& o, const Point& n) {
  std::vector<Point> out;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Point& p = polygon[i];
    const Point& q = polygon[(i + 1) % polygon.size()];
    const Rational a = dot(n, p - o);
    const Rational b = dot(n, q - o);
    if (a.sign() >= 0) out.push_back(p);
    if (a.sign() * b.sign() < 0) {
      const Rational t = a / (a - b);
      const Point d = q - p;
      out.push_back({p.x + t * d.x, p.y + t * d.y, p.z + t * d.z});
    }
  }
  return out;
}

// The intersection is a convex polygon; its corners say whether it goes beyond what is shared.
bool oracle(const Corners& s, const Corners& t) {
  std::vector<Point> polygon{exact(s[0]), exact(s[1]), exact(s[2])};
  const Point a = exact(t[0]);
  const Point b = exact(t[1]);
  const Point c = exact(t[2]);
  const Point n = cross(b - a, c - a);
  const Point minus_n = Point{0, 0, 0} - n;
  polygon = clipped(clipped(polygon, a, n), a, minus_n);
  polygon = clipped(polygon, a, cross(n, b - a));
  polygon = clipped(polygon, b, cross(n, c - b));
  polygon = clipped(polygon, c, cross(n, a - c));
  std::vector<Vec3> shared;
  for (const Vec3& p : s)
    if (std::find(t.begin(), t.end(), p) != t.end()) shared.push_back(p);
  return std::any_of(polygon.begin(), polygon.end(), [&](const Point& p) {
    if (shared.size() == 3) return true;
    if (shared.size() == 2) {
      const Point u = exact(shared[1]) - exact(shared[0]);
      const Point w = p - exact(shared[0]);
      const Point off_line = cross(u, w);
      if (off_line.x != 0 || off_line.y != 0 || off_line.z != 0) return true;
      return dot(u, w) < 0 || dot(u, w) > dot(u, u);
    }
    return shared.empty() || !(p == exact(shared[0]));
  });
}

bool has_area(const Corners& t) {
  const Point n = cross(exact(t[1]) - exact(t[0]), exact(t[2]) - exact(t[0]));
  return n.x != 0 || n.y != 0 || n.z != 0;
}

// kind 0: small integers, flat half of the time, so that all special cases come up; 1: generic;
// 2: almost flat.
Vec3 random_point(numeric::Random& random, int kind) {
  if (kind == 0) {
    const auto integer = [&] { return static_cast<double>(random.below(4)); };
    const double x = integer();
    const double y = integer();
    return {x, y, random.below(2) == 0 ? 0 : integer()};
  }
  const double x = random.uniform();
  const double y = random.uniform();
  const double z = random.uniform() - 0.5;
  return {x, y, kind == 1 ? z : 0x1p-50 * z};
}

TEST(TrianglesIntersect, EqualsTheOracle) {
  std::array<std::array<int, 2>, 4> seen{};
  for (std::uint64_t i = 0; i < 6000; ++i) {
    numeric::Random random(1, i);
    const int kind = i % 4 == 3 ? 2 : i % 4 == 2 ? 1 : 0;
    Corners s;
    Corners t;
    for (Vec3& p : s) p = random_point(random, kind);
    for (Vec3& p : t) p = random_point(random, kind);
    for (std::uint64_t k = 0, n = random.below(4); k < n; ++k) t[k] = s[(k + i) % 3];
    std::rotate(t.begin(), t.begin() + static_cast<std::ptrdiff_t>(random.below(3)), t.end());
    if (!has_area(s) || !has_area(t)) continue;
    const bool expected = oracle(s, t);
    EXPECT_EQ(triangles_intersect(s, t), expected) << i;
    EXPECT_EQ(triangles_intersect(t, s), expected) << i;
    const auto shared = std::count_if(s.begin(), s.end(), [&](const Vec3& p) {
      return std::find(t.begin(), t.end(), p) != t.end();
    });
    ++seen[static_cast<std::size_t>(shared)][expected ? 1 : 0];
  }
  for (std::size_t shared = 0; shared < 3; ++shared) {
    EXPECT_GT(seen[shared][0], 50) << shared;
    EXPECT_GT(seen[shared][1], 50) << shared;
  }
  EXPECT_GT(seen[3][1], 50);
}

TEST(TrianglesIntersect, SegmentsThroughTrianglesWithoutArea) {
  const Corners flat{Vec3{0, 0, 0}, Vec3{1, 1, 1}, Vec3{3, 3, 3}};
  EXPECT_TRUE(triangles_intersect(flat, {Vec3{2, 1, 2}, Vec3{2, 4, 2}, Vec3{9, 9, 0}}));
  EXPECT_FALSE(triangles_intersect(flat, {Vec3{4, 4, 4}, Vec3{2, 5, 2}, Vec3{9, 9, 0}}));
  EXPECT_TRUE(triangles_intersect(flat, {Vec3{2, 2, 2}, Vec3{4, 4, 4}, Vec3{5, 5, 5}}));
  EXPECT_FALSE(triangles_intersect(flat, {Vec3{3.5, 3.5, 3.5}, Vec3{4, 4, 4}, Vec3{5, 5, 5}}));
}

Index brute_force(const TriangleMesh& mesh) {
  const auto corners = [&](std::size_t t) {
    const auto& [a, b, c] = mesh.triangles[t];
    return Corners{mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]};
  };
  Index count = 0;
  for (std::size_t s = 0; s < mesh.triangles.size(); ++s)
    for (std::size_t t = s + 1; t < mesh.triangles.size(); ++t)
      if (triangles_intersect(corners(s), corners(t))) ++count;
  return count;
}

TEST(SelfIntersections, ProperMeshesHaveNone) {
  EXPECT_EQ(count_self_intersections(icosphere(3)), 0);
  EXPECT_EQ(count_self_intersections(plane(8, 8, 0)), 0);
  EXPECT_EQ(count_self_intersections(transformed(icosphere(2), 1e300)), 0);
  EXPECT_EQ(count_self_intersections(transformed(icosphere(2), 1e-300)), 0);
  EXPECT_EQ(count_self_intersections({}), 0);
}

TEST(SelfIntersections, CountEqualsBruteForceAndIsInvariant) {
  for (const TriangleMesh& mesh :
       {together(icosphere(2), transformed(icosphere(2), 1, {0.5, 0.25, 0.125})),
        together(plane(5, 5, 0), transformed(plane(5, 5, 0), 1, {0.5, 0, 0})),
        together(plane(5, 5, 0), plane(5, 5, 0))}) {
    const Index expected = brute_force(mesh);
    EXPECT_GT(expected, 0);
    for (const int threads : {1, 3}) {
      Context context;
      context.threads = threads;
      EXPECT_EQ(count_self_intersections(mesh, context), expected);
    }
    EXPECT_EQ(count_self_intersections(permuted(mesh, 5)), expected);
    EXPECT_EQ(count_self_intersections(transformed(mesh, 0x1p-900)), expected);
    EXPECT_EQ(count_self_intersections(transformed(mesh, 0x1p900)), expected);
  }
}

}  // namespace
}  // namespace nonobtuse::quality
