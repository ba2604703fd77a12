// Corners with a face angle below the promise: how they are settled, and the whole call on them.
#include "features/narrow_corners.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "features/feature_graph.h"
#include "nonobtuse/certificate.h"
#include "nonobtuse/remesh.h"

namespace nonobtuse::features {
namespace {

// A flat triangle with `degrees` between sides of the given lengths, as a fan around a point of its
// own: every side is one edge.
TriangleMesh flat_triangle(double degrees, double first, double second) {
  const double a = degrees * 3.14159265358979323846 / 180;
  TriangleMesh m;
  m.vertices = {{0, 0, 0}, {first, 0, 0}, {second * std::cos(a), second * std::sin(a), 0}};
  m.vertices.push_back((m.vertices[0] + m.vertices[1] + m.vertices[2]) / 3.0);
  m.triangles = {{0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
  return m;
}

// The same one thick, with both lids: it has two such corners.
TriangleMesh wedge(double degrees, double length) {
  TriangleMesh m = flat_triangle(degrees, length, length);
  m.vertices.pop_back();
  for (int i = 0; i < 3; ++i) m.vertices.push_back(m.vertices[i] + Vec3{0, 0, 1});
  m.triangles = {{0, 2, 1}, {3, 4, 5}, {0, 1, 4}, {0, 4, 3},
                 {1, 2, 5}, {1, 5, 4}, {2, 0, 3}, {2, 3, 5}};
  return m;
}

struct Settled {
  mesh::Surface surface;
  std::vector<FirstEdge> edges;
};

Settled settle(const TriangleMesh& m, double reach) {
  Settled s{mesh::make_surface(m.vertices, m.triangles), {}};
  EdgeFlags flags(m.triangles.size(), 0);
  flag_boundaries(m.triangles, static_cast<Index>(m.vertices.size()), flags);
  FeatureGraph graph = feature_graph(s.surface, flags, {1, 1, 1, 0});
  s.edges = settle_narrow_corners(s.surface, flags, graph, reach, {});
  for (const FirstEdge& e : s.edges) EXPECT_EQ(graph.corner[e.end], 1);
  EXPECT_EQ(graph.corner.size(), s.surface.vertices.size());
  EXPECT_NEAR(s.surface.area, mesh::make_surface(m.vertices, m.triangles).area, 1e-12);
  return s;
}

double length_of(const Settled& s, const FirstEdge& e) {
  return distance(s.surface.vertices[e.corner], s.surface.vertices[e.end]);
}

TEST(NarrowCorners, FirstEdgesAreEquallyLong) {
  const Settled s = settle(flat_triangle(20, 10, 9), 1);
  ASSERT_EQ(s.edges.size(), 2u);
  for (const FirstEdge& e : s.edges) {
    EXPECT_EQ(e.corner, 0);
    EXPECT_NEAR(length_of(s, e), 1, 1e-12);
  }
}

TEST(NarrowCorners, OnShortCurvesThereIsRoomForAnotherEdge) {
  // 40 degrees are enough, if only the knots were not bound to be where the sides end.
  const Settled s = settle(flat_triangle(40, 1, 1.5), 1);
  Index found = 0;
  for (const FirstEdge& e : s.edges) {
    if (e.corner != 0) continue;
    ++found;
    EXPECT_NEAR(length_of(s, e), 1.5 / 2.6, 1e-9);  // the other end of that side is narrow, too
  }
  EXPECT_EQ(found, 2);
}

TEST(NarrowCorners, WideOnesAndThoseWithRoomStayAsTheyAre) {
  EXPECT_TRUE(settle(flat_triangle(40, 10, 9), 1).edges.empty());
  EXPECT_TRUE(settle(flat_triangle(61, 10, 10), 1).edges.empty());
}

// Everything but the triangles at the corner keeps the promise, and these have no obtuse angle.
void expect_promise_elsewhere(const TriangleMesh& input, Index n, std::size_t corners) {
  RemeshOptions options;
  options.vertices = n;
  const RemeshResult result = remesh(input, options);
  const Certificate promise = certify(result.mesh, {30, 90});
  EXPECT_EQ(result.narrow_corners.size(), corners);
  EXPECT_LE(promise.too_small.size(), corners);
  EXPECT_EQ(promise.too_large.size(), 0u);
  EXPECT_TRUE(certified_but_for_narrow_corners(result.mesh, promise, result.narrow_corners));
  EXPECT_EQ(static_cast<Index>(result.mesh.vertices.size()), n);
}

TEST(NarrowCorners, OnlyTheirOwnTriangleMissesThePromise) {
  for (const double degrees : {10.0, 18.0, 27.0}) {
    SCOPED_TRACE(degrees);
    expect_promise_elsewhere(flat_triangle(degrees, 10, 10), 400, 1);
  }
}

TEST(NarrowCorners, OfAWedgeToo) { expect_promise_elsewhere(wedge(20, 3), 700, 2); }

}  // namespace
}  // namespace nonobtuse::features
