#include "nonobtuse/quality.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "meshes.h"
#include "nonobtuse/certificate.h"
#include "nonobtuse/error.h"
#include "quality/angles.h"

namespace nonobtuse::quality {
namespace {

TEST(Angles, KnownTriangles) {
  const TriangleShape equilateral = shape_of({1, 0, 0}, {0, 1, 0}, {0, 0, 1});
  EXPECT_NEAR(equilateral.quality, 1, 1e-15);
  for (const double angle : equilateral.angles) EXPECT_NEAR(angle, 60, 1e-13);

  // Q = 6/sqrt(3) S/(p h) of the half square: S = 1/2, p = 1 + sqrt(2)/2, h = sqrt(2).
  const TriangleShape half_square = shape_of({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  const double root = std::numbers::sqrt2;
  EXPECT_NEAR(half_square.quality, 6 / std::sqrt(3.0) * 0.5 / ((1 + root / 2) * root), 1e-15);
  EXPECT_EQ(half_square.angles[0], 90);

  EXPECT_EQ(shape_of({0, 0, 0}, {1, 0, 0}, {3, 0, 0}).angles[1], 180);
  EXPECT_EQ(shape_of({0, 0, 0}, {1, 0, 0}, {3, 0, 0}).quality, 0);
  EXPECT_EQ(shape_of({1, 1, 1}, {1, 1, 1}, {1, 1, 1}).quality, 0);
}

TEST(Angles, AnglesSumUpAtAnyScale) {
  for (const double scale : {1.0, 1e-300, 1e-310, 1e300}) {
    numeric::Random random(4);
    for (int i = 0; i < 100; ++i) {
      const auto point = [&] {
        const double x = random.uniform();
        const double y = random.uniform();
        return scale * Vec3{x, y, random.uniform()};
      };
      const Vec3 a = point();
      const Vec3 b = point();
      const TriangleShape shape = shape_of(a, b, point());
      EXPECT_NEAR(shape.angles[0] + shape.angles[1] + shape.angles[2], 180, 1e-12);
      EXPECT_GT(shape.quality, 0);
      EXPECT_LT(shape.quality, 1);
    }
  }
}

TEST(Angles, FiguresOfAMesh) {
  const TriangleMesh mesh = plane(6, 4, 0);
  const AngleQuality q = measure_angles(mesh);
  EXPECT_EQ(q.triangles, 48);
  EXPECT_EQ(q.obtuse, 48);  // right is not acute
  EXPECT_EQ(q.small, 0);
  EXPECT_EQ(q.percent_obtuse, 100);
  EXPECT_NEAR(q.min_angle, 45, 1e-13);
  EXPECT_NEAR(q.mean_min_angle, 45, 1e-12);
  EXPECT_EQ(q.max_angle, 90);
  // All inner vertices have 6 neighbours; on the boundary two corners have 2, all others 3 or 4.
  EXPECT_NEAR(q.percent_valence_567, 100.0 * 33 / 35, 1e-12);
  EXPECT_EQ(count_obtuse(mesh.vertices, mesh.triangles, parallel::Workers(2)), 48);
  EXPECT_EQ(measure_angles(icosphere(2)).percent_valence_567, 100);
}

TEST(Topology, SpherePlaneAndTorus) {
  const Topology sphere = measure_topology(icosphere(2));
  EXPECT_EQ(sphere.euler_characteristic, 2);
  EXPECT_EQ(sphere.edges, 480);
  EXPECT_EQ(sphere.components, 1);
  EXPECT_EQ(sphere.boundary_loops, 0);
  EXPECT_TRUE(sphere.oriented);

  TriangleMesh holed = plane(6, 6, 0);
  // Two square holes that touch in one vertex: cut open there they are one loop, beside the outer.
  const auto drop = [&](int x, int y) {
    const Index v = y * 7 + x;
    std::erase_if(holed.triangles,
                  [&](const Triangle& t) { return t[0] == v && (t[1] == v + 1 || t[2] == v + 7); });
  };
  drop(2, 2);
  drop(3, 3);
  const Topology plane_with_holes = measure_topology(holed);
  EXPECT_EQ(plane_with_holes.boundary_loops, 2);
  EXPECT_EQ(plane_with_holes.nonmanifold_vertices, 1);
  EXPECT_EQ(plane_with_holes.components, 1);

  TriangleMesh torus = plane(7, 5, 0);
  for (Triangle& t : torus.triangles)
    for (Index& v : t) v = (v / 8) % 5 * 8 + (v % 8) % 7;
  const Topology t = measure_topology(torus);
  EXPECT_EQ(t.vertices, 35);  // unused ones do not count
  EXPECT_EQ(t.euler_characteristic, 0);
  EXPECT_EQ(t.boundary_loops, 0);
  EXPECT_EQ(t.nonmanifold_edges + t.nonmanifold_vertices, 0);
}

TEST(Topology, NotManifoldNotOriented) {
  TriangleMesh fan{{{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}},
                   {{0, 1, 2}, {0, 1, 3}, {0, 1, 4}}};
  EXPECT_EQ(measure_topology(fan).nonmanifold_edges, 1);
  fan.triangles.pop_back();
  EXPECT_EQ(measure_topology(fan).nonmanifold_edges, 0);
  EXPECT_FALSE(measure_topology(fan).oriented);
  // Two spheres that share one vertex.
  TriangleMesh hourglass = together(icosphere(1), icosphere(1));
  for (Triangle& t : hourglass.triangles)
    for (Index& v : t)
      if (v == 42) v = 0;
  const Topology t = measure_topology(hourglass);
  EXPECT_EQ(t.nonmanifold_vertices, 1);
  EXPECT_EQ(t.components, 2);
  EXPECT_EQ(t.euler_characteristic, 3);
}

TEST(Distance, ParallelPlanes) {
  // Lengths are exact, and so are both distances: the smaller plane lies over the larger.
  const SurfaceDistance d = measure_distance(plane(4, 4, 3), plane(4, 4, 0));
  EXPECT_EQ(d.hausdorff, 3);
  EXPECT_NEAR(d.rms, 3, 1e-12);
  EXPECT_DOUBLE_EQ(d.diagonal, std::sqrt(32.0));
  const SurfaceDistance part = measure_distance(plane(4, 4, 0), plane(8, 4, 0));
  EXPECT_NEAR(part.hausdorff_to_reference, 0, 1e-14);
  EXPECT_NEAR(part.rms_to_reference, 0, 1e-14);
  EXPECT_EQ(part.hausdorff_from_reference, 4);
  // Mean over the right half of (x - 4)^2 is 16 / 3, and half of the surface is there.
  EXPECT_NEAR(part.rms_from_reference, std::sqrt(8.0 / 3), 1e-3);
  EXPECT_EQ(part.hausdorff, part.hausdorff_from_reference);
  EXPECT_EQ(part.rms, part.rms_from_reference);
}

TEST(Distance, SphereAndScaledSphere) {
  const TriangleMesh sphere = icosphere(3);
  const SurfaceDistance d = measure_distance(transformed(sphere, 1.25), sphere);
  EXPECT_NEAR(d.hausdorff, 0.25, 2e-3);
  EXPECT_NEAR(d.rms, 0.25, 3e-3);
}

TEST(Distance, ScalesShiftsAndThreads) {
  const TriangleMesh a = icosphere(2);
  const TriangleMesh b = transformed(icosphere(3), 1.1, {0.125, 0, 0});
  const SurfaceDistance d = measure_distance(a, b);
  for (const double scale : {0x1p-1000, 0x1p900}) {
    const SurfaceDistance s = measure_distance(transformed(a, scale), transformed(b, scale));
    EXPECT_EQ(s.hausdorff, scale * d.hausdorff);
    EXPECT_EQ(s.rms, scale * d.rms);
  }
  const Vec3 far{1e6, -1e6, 1e6};
  const SurfaceDistance s = measure_distance(transformed(a, 1, far), transformed(b, 1, far));
  EXPECT_NEAR(s.hausdorff, d.hausdorff, 1e-6);
  EXPECT_NEAR(s.rms, d.rms, 1e-3 * d.rms);
  for (const int threads : {2, 3}) {
    Context context;
    context.threads = threads;
    const SurfaceDistance t = measure_distance(a, b, context);
    EXPECT_EQ(t.hausdorff, d.hausdorff);
    EXPECT_EQ(t.rms_to_reference, d.rms_to_reference);
    EXPECT_EQ(t.rms_from_reference, d.rms_from_reference);
  }
  // The same up to the noise of the samples for another order of everything.
  const SurfaceDistance p = measure_distance(permuted(a, 1), permuted(b, 2));
  EXPECT_NEAR(p.rms, d.rms, 1e-3 * d.rms);
  EXPECT_NEAR(p.hausdorff, d.hausdorff, 1e-3 * d.hausdorff);
}

TEST(Distance, OfEveryVertex) {
  const TriangleMesh ground = plane(4, 4, 0);
  TriangleMesh points = plane(4, 4, 3);
  points.vertices[0] = {-3, 0, -4};
  const std::vector<double> d = vertex_distances(points, ground);
  ASSERT_EQ(d.size(), points.vertices.size());
  EXPECT_EQ(d[0], 5);
  for (std::size_t v = 1; v < d.size(); ++v) EXPECT_EQ(d[v], 3);
  // The largest of both sides never exceeds the distance of the surfaces, which takes them in.
  const TriangleMesh a = icosphere(2), b = transformed(icosphere(3), 1.1, {0.125, 0, 0});
  const std::vector<double> ab = vertex_distances(a, b);
  EXPECT_LE(*std::max_element(ab.begin(), ab.end()),
            measure_distance(a, b).hausdorff_to_reference * (1 + 1e-12));
  EXPECT_THROW((void)vertex_distances(a, {}), InvalidInput);
}

TEST(Distance, NeedsTriangles) {
  EXPECT_THROW((void)measure_distance({}, icosphere(0)), InvalidInput);
  EXPECT_THROW((void)measure_distance(icosphere(0), {}), InvalidInput);
}

TEST(Measure, FlippedTriangles) {
  const TriangleMesh reference = icosphere(3);
  TriangleMesh mesh = icosphere(2);
  EXPECT_EQ(measure(mesh, &reference).flipped, 0);
  for (const std::size_t t : {3u, 77u, 200u}) std::swap(mesh.triangles[t][0], mesh.triangles[t][1]);
  const QualityReport report = measure(mesh, &reference);
  EXPECT_EQ(report.flipped, 3);
  EXPECT_FALSE(report.topology.oriented);
  EXPECT_EQ(report.self_intersections, 0);
  ASSERT_TRUE(report.distance.has_value());
}

TEST(Measure, TakesAnyIndexableMesh) {
  // A soup with repeated corners, a fold, an unused vertex and an edge of three triangles.
  const TriangleMesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {9, 9, 9}, {1, 1, 0}, {0, 0, 1}},
                          {{0, 1, 2}, {0, 0, 1}, {1, 1, 1}, {0, 1, 4}, {1, 0, 5}, {0, 1, 2}}};
  const QualityReport report = measure(mesh, &mesh);
  EXPECT_EQ(report.angles.triangles, 6);
  EXPECT_EQ(report.topology.vertices, 5);
  EXPECT_GE(report.topology.nonmanifold_edges, 1);
  EXPECT_GT(report.self_intersections, 0);
  EXPECT_NEAR(report.distance->hausdorff, 0, 1e-14);
  EXPECT_EQ(measure({}).angles.triangles, 0);
  TriangleMesh bad = mesh;
  bad.triangles[2][1] = -1;
  EXPECT_THROW((void)measure(bad), InvalidInput);
}

}  // namespace
}  // namespace nonobtuse::quality
