#include "spatial/triangle_bvh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "numeric/random.h"

namespace nonobtuse::spatial {
namespace {

using numeric::Random;

Vec3 random_point(Random& random, double size = 1) {
  const double x = random.uniform();
  const double y = random.uniform();
  const double z = random.uniform();
  return size * Vec3{x - 0.5, y - 0.5, z - 0.5};
}

// Triangles of many sizes and shapes, some degenerate, some twice.
TriangleMesh random_soup(std::uint64_t seed, int count) {
  Random random(seed);
  TriangleMesh mesh;
  for (int t = 0; t < count; ++t) {
    const Index n = static_cast<Index>(mesh.vertices.size());
    const Vec3 a = random_point(random);
    const Vec3 b = a + random_point(random, random.uniform() < 0.5 ? 0.1 : 1e-3);
    Vec3 c = a + random_point(random, 0.1);
    const std::uint64_t kind = random.below(8);
    if (kind == 0) c = a;
    if (kind == 1) c = a + 0.3 * (b - a);
    if (kind == 2) c = a + 0.3 * (b - a) + random_point(random, 1e-12);
    mesh.vertices.insert(mesh.vertices.end(), {a, b, c});
    mesh.triangles.push_back({n, n + 1, n + 2});
    if (kind == 3) mesh.triangles.push_back({n + 1, n, n + 2});
  }
  return mesh;
}

// n by n squares, two triangles each, all corners at integers: full of ties.
TriangleMesh grid(int n) {
  TriangleMesh mesh;
  for (int y = 0; y <= n; ++y)
    for (int x = 0; x <= n; ++x) mesh.vertices.push_back({double(x), double(y), 0});
  for (int y = 0; y < n; ++y)
    for (int x = 0; x < n; ++x) {
      const Index v = y * (n + 1) + x;
      mesh.triangles.push_back({v, v + 1, v + n + 2});
      mesh.triangles.push_back({v, v + n + 2, v + n + 1});
    }
  return mesh;
}

ClosestPoint closest_to(const TriangleMesh& mesh, Index t, const Vec3& p) {
  const auto& [a, b, c] = mesh.triangles[t];
  return closest_point_on_triangle(p, mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]);
}

template <class Accept>
TriangleBvh::Hit brute_force(const TriangleMesh& mesh, const Vec3& p, double limit,
                             const Accept& accept) {
  TriangleBvh::Hit best;
  best.squared_distance = limit;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Index index = static_cast<Index>(t);
    const ClosestPoint q = closest_to(mesh, index, p);
    if (accept(index) && q.squared_distance < best.squared_distance)
      best = {index, q.point, q.barycentric, q.squared_distance};
  }
  return best;
}

void expect_equal(const TriangleBvh::Hit& a, const TriangleBvh::Hit& b) {
  EXPECT_EQ(a.triangle, b.triangle);
  EXPECT_EQ(a.squared_distance, b.squared_distance);
  EXPECT_EQ(a.point, b.point);
  EXPECT_EQ(a.barycentric, b.barycentric);
}

void compare_with_brute_force(const TriangleMesh& mesh, const std::vector<Vec3>& points) {
  const parallel::Workers workers(2);
  const TriangleBvh bvh(mesh.vertices, mesh.triangles, workers);
  const auto odd = [](Index t) { return t % 2 == 1; };
  for (const Vec3& p : points) {
    const auto hit = bvh.closest(p);
    expect_equal(hit, brute_force(mesh, p, std::numeric_limits<double>::infinity(),
                                  [](Index) { return true; }));
    const double limit = 1.5 * hit.squared_distance;
    expect_equal(bvh.closest_if(p, limit, odd), brute_force(mesh, p, limit, odd));
    EXPECT_EQ(bvh.closest(p, hit.squared_distance).triangle, -1);  // strictly nearer only
  }
}

TEST(TriangleBvh, EqualsBruteForceOnSoups) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const TriangleMesh mesh = random_soup(seed, seed < 4 ? 1 + int(seed) : 400);
    Random random(seed, 1);
    std::vector<Vec3> points;
    for (int i = 0; i < 200; ++i) points.push_back(random_point(random, i % 2 == 0 ? 1.2 : 1e3));
    for (int i = 0; i < 50; ++i)
      points.push_back(mesh.vertices[random.below(mesh.vertices.size())]);
    compare_with_brute_force(mesh, points);
  }
}

TEST(TriangleBvh, EqualDistancesGoToTheLowestIndex) {
  const TriangleMesh mesh = grid(17);
  std::vector<Vec3> points;
  for (int y = -1; y <= 36; ++y)
    for (int x = -1; x <= 36; ++x) points.push_back({0.5 * x, 0.5 * y, 0.25 * (x % 3)});
  compare_with_brute_force(mesh, points);
}

TEST(TriangleBvh, FarFromTheOriginAndManyTrianglesInOnePlace) {
  TriangleMesh mesh = random_soup(7, 200);
  for (Vec3& v : mesh.vertices) v += Vec3{1e6, -1e6, 1e6};
  for (int i = 0; i < 300; ++i) mesh.triangles.push_back(mesh.triangles[5]);
  Random random(3);
  std::vector<Vec3> points;
  for (int i = 0; i < 300; ++i) points.push_back(Vec3{1e6, -1e6, 1e6} + random_point(random, 1.2));
  compare_with_brute_force(mesh, points);
}

TEST(TriangleBvh, EmptyFindsNothing) {
  const parallel::Workers workers(1);
  const TriangleBvh bvh({}, {}, workers);
  EXPECT_EQ(bvh.closest({}).triangle, -1);
  bvh.for_overlapping({{-1, -1, -1}, {1, 1, 1}}, [](Index) { FAIL(); });
}

TEST(TriangleBvh, OverlappingBoxesAreAllFound) {
  const TriangleMesh mesh = random_soup(11, 500);
  const parallel::Workers workers(1);
  const TriangleBvh bvh(mesh.vertices, mesh.triangles, workers);
  Random random(12);
  for (int i = 0; i < 200; ++i) {
    Box box;
    box.add(random_point(random));
    box.add(box.low + random_point(random, 0.3));
    std::vector<Index> found;
    bvh.for_overlapping(box, [&](Index t) { found.push_back(t); });
    std::sort(found.begin(), found.end());
    std::vector<Index> expected;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      Box own;
      for (const Index v : mesh.triangles[t]) own.add(mesh.vertices[v]);
      if (own.overlaps(box)) expected.push_back(static_cast<Index>(t));
    }
    EXPECT_EQ(found, expected);
  }
}

// The closest point is characterised by the variational inequality: for every corner x of the
// convex set, (p - q) . (x - q) <= 0.
TEST(ClosestPoint, SatisfiesTheVariationalInequality) {
  const TriangleMesh mesh = random_soup(5, 3000);
  Random random(6);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Index index = static_cast<Index>(t);
    const Triangle& triangle = mesh.triangles[t];
    const Vec3 p = mesh.vertices[triangle[0]] + random_point(random, 0.2);
    const ClosestPoint q = closest_to(mesh, index, p);
    Vec3 sum;
    for (int k = 0; k < 3; ++k) {
      const Vec3& x = mesh.vertices[triangle[k]];
      EXPECT_LE(dot(p - q.point, x - q.point), 1e-11);
      const Vec3& w = q.barycentric;
      EXPECT_GE(k == 0 ? w.x : k == 1 ? w.y : w.z, 0);
      sum += (k == 0 ? w.x : k == 1 ? w.y : w.z) * x;
    }
    EXPECT_NEAR(distance(sum, q.point), 0, 1e-14);
    EXPECT_NEAR(q.barycentric.x + q.barycentric.y + q.barycentric.z, 1, 1e-15);
    EXPECT_EQ(q.squared_distance, squared_distance(p, q.point));
  }
}

}  // namespace
}  // namespace nonobtuse::spatial
