// Points, tangents and projections on polylines, against dense sampling.
#include "mesh/curve_network.h"

#include <gtest/gtest.h>

#include <limits>

#include "mesh/editable_mesh.h"
#include "numeric/random.h"
#include "numeric/vec3.h"
#include "rdt/shapes.h"

namespace {

using namespace nonobtuse;

mesh::Curve random_curve(bool closed, std::uint64_t seed) {
  numeric::Random random(seed);
  std::vector<Vec3> points;
  for (int i = 0; i < 9; ++i) points.push_back({random.uniform(), random.uniform(), 0.5 * i});
  return mesh::make_curve(points, closed);
}

TEST(CurveNetwork, PointsAtTheArcsAreThePoints) {
  for (const bool closed : {false, true}) {
    const mesh::Curve curve = random_curve(closed, 3);
    for (std::size_t i = 0; i < curve.points.size(); ++i)
      EXPECT_LT(distance(mesh::point_at(curve, curve.arc[i]), curve.points[i]), 1e-14);
    if (closed)
      EXPECT_LT(distance(mesh::point_at(curve, curve.length), curve.points.front()), 1e-14);
    else
      EXPECT_EQ(mesh::point_at(curve, curve.length), curve.points.back());
  }
}

TEST(CurveNetwork, TheTangentIsTheDerivative) {
  for (const bool closed : {false, true}) {
    const mesh::Curve curve = random_curve(closed, 4);
    numeric::Random random(5);
    for (int i = 0; i < 200; ++i) {
      const double s = curve.length * random.uniform(), step = 1e-7 * curve.length;
      const Vec3 difference = mesh::point_at(curve, s + step) - mesh::point_at(curve, s);
      if (std::abs(length(difference) - step) > 1e-12) continue;  // across a point of the polyline
      EXPECT_LT(distance(difference / step, mesh::tangent_at(curve, s)), 1e-6);
    }
  }
}

TEST(CurveNetwork, ClosedCurvesGoRound) {
  const mesh::Curve curve = random_curve(true, 6);
  for (const double s : {0.1, 0.77, 0.999}) {
    const Vec3 p = mesh::point_at(curve, s * curve.length);
    for (const int turns : {-2, -1, 1, 3})
      EXPECT_LT(distance(p, mesh::point_at(curve, (s + turns) * curve.length)), 1e-12);
  }
  for (const double s : {-1e-20, -1.0, 1e3, curve.length, 0.0}) {
    EXPECT_GE(mesh::canonical_arc(curve, s), 0);
    EXPECT_LT(mesh::canonical_arc(curve, s), curve.length);
  }
}

TEST(CurveNetwork, ProjectionIsNearest) {
  for (const bool closed : {false, true}) {
    const mesh::Curve curve = random_curve(closed, 7);
    numeric::Random random(8);
    for (int i = 0; i < 100; ++i) {
      const Vec3 p{2 * random.uniform() - 0.5, 2 * random.uniform() - 0.5, 5 * random.uniform()};
      const double center = curve.length * random.uniform();
      const double reach = curve.length * 0.6 * random.uniform();
      const double local = mesh::project(curve, p, center, reach);
      const double whole = mesh::project(curve, p);
      EXPECT_LE(std::abs(local - center), reach + 1e-12);
      double nearest = std::numeric_limits<double>::infinity(), nearest_local = nearest;
      for (int k = 0; k <= 4000; ++k) {
        const double s = curve.length * (k / 2000.0 - 0.5);
        nearest = std::min(nearest, distance(p, mesh::point_at(curve, s)));
        const double t = center + s;
        if (std::abs(s) <= reach && (closed || (t >= 0 && t <= curve.length)))
          nearest_local = std::min(nearest_local, distance(p, mesh::point_at(curve, t)));
      }
      EXPECT_LE(distance(p, mesh::point_at(curve, whole)), nearest + 1e-12);
      EXPECT_LE(distance(p, mesh::point_at(curve, local)), nearest_local + 1e-12);
    }
  }
}

TEST(CurveNetwork, EditsKeepTheKnots) {
  const TriangleMesh input = shapes::square(4);
  mesh::EditableMesh m(input.vertices, input.triangles);
  m.knot.assign(m.vertex_capacity(), -1);
  const auto number = [](const Vec3& p) { return static_cast<Index>(100 * p.x + 10 * p.y); };
  for (Index v = 0; v < m.vertex_capacity(); ++v)
    if (m.on_boundary(v)) m.knot[v] = number(m.positions[v]);
  numeric::Random random(2);
  for (int step = 0; step < 400; ++step) {
    const mesh::Edge e{static_cast<Index>(random.below(m.triangle_capacity())),
                       static_cast<int>(random.below(3))};
    if (!m.alive_triangle(e.triangle)) continue;
    switch (random.below(4)) {
      case 0:
        if (m.can_flip(e)) m.flip(e);
        break;
      case 1:
        if (!m.on_boundary(m.tail(e)) && m.can_collapse(e, m.tail(e))) m.collapse(e, m.tail(e));
        break;
      case 2:
        if (m.twin(e).valid()) m.split_edge(e, {0.3, 0.3, 0.1});
        break;
      default:
        m.compact();
    }
    ASSERT_EQ(m.knot.size(), m.positions.size());
  }
  m.compact();
  for (Index v = 0; v < m.vertex_capacity(); ++v)
    EXPECT_EQ(m.knot[v], m.on_boundary(v) ? number(m.positions[v]) : -1);
}

}  // namespace
