// Valence optimisation and refinement on perturbed spheres and tori: bounds reached, counts and
// topology kept, the same bytes for any number of threads, valid when cancelled.
#include "remesh/refinement.h"

#include <gtest/gtest.h>

#include <cstring>

#include "refine/test_surfaces.h"
#include "remesh/valence_optimization.h"
#include "spatial/triangle_bvh.h"

namespace nonobtuse {
namespace {

using pipeline::RefinementOptions;

struct Outcome {
  mesh::EditableMesh mesh;
  Index bad_valences = 0;
  Index outside = 0;
};

Outcome run(test::Case c, const RefinementOptions& options = {}, int threads = 1,
            const Context& context = {}) {
  const parallel::Workers workers(threads);
  parallel::Monitor monitor(context);
  Outcome o;
  const spatial::TriangleBvh bvh(c.surface.vertices, c.surface.triangles, workers);
  o.bad_valences = pipeline::optimize_valence(c.surface, bvh, c.mesh, workers, monitor);
  o.outside = pipeline::refine(c.surface, bvh, c.mesh, options, workers, monitor);
  o.mesh = std::move(c.mesh);
  return o;
}

test::Case bumpy_torus(const std::function<Vec3(Vec3)>& map = {}) {
  return test::make_case(test::torus(90, 36), test::torus(60, 24, 0.8), map);
}

void expect_same_bytes(const mesh::EditableMesh& a, const mesh::EditableMesh& b) {
  ASSERT_EQ(a.positions.size(), b.positions.size());
  EXPECT_EQ(a.triangles(), b.triangles());
  EXPECT_EQ(std::memcmp(a.positions.data(), b.positions.data(), a.positions.size() * sizeof(Vec3)),
            0);
}

TEST(Refine, BringsPerturbedSurfacesInsideTheBounds) {
  for (int which = 0; which < 2; ++which) {
    test::Case c =
        which == 0 ? bumpy_torus() : test::make_case(test::sphere(32), test::sphere(16, 0.7));
    const Index n = c.mesh.vertex_count(), chi = test::euler_characteristic(c.mesh);
    const auto [start_least, start_most] = test::angle_range(c.mesh);
    ASSERT_LT(start_least, 35);
    ASSERT_GT(start_most, 90);
    const Outcome o = run(std::move(c));
    EXPECT_EQ(o.bad_valences, 0);
    EXPECT_EQ(o.outside, 0);
    const auto [least, most] = test::angle_range(o.mesh);
    EXPECT_GE(least, 40);
    EXPECT_LE(most, 80);
    EXPECT_EQ(test::bad_valence_count(o.mesh), 0);
    EXPECT_EQ(o.mesh.vertex_count(), n);
    EXPECT_EQ(o.mesh.vertex_capacity(), n);
    EXPECT_EQ(test::euler_characteristic(o.mesh), chi);
    EXPECT_NO_THROW(o.mesh.check_invariants());
  }
}

TEST(Refine, StaysNearTheSurface) {
  const Outcome o = run(test::make_case(test::sphere(64), test::sphere(16, 0.5)));
  const double radius = std::sqrt(o.mesh.vertex_count() / 12.566370614359172);
  double sum = 0;
  for (const Vec3& p : o.mesh.positions) {
    EXPECT_NEAR(length(p), radius, 0.25);  // in units of about an edge
    sum += (length(p) - radius) * (length(p) - radius);
  }
  EXPECT_LT(std::sqrt(sum / o.mesh.vertex_count()), 0.05);
}

TEST(Refine, OnSurfaceKeepsVerticesOnIt) {
  test::Case c = test::make_case(test::sphere(32), test::sphere(16, 0.5));
  const parallel::Workers workers(1);
  const spatial::TriangleBvh bvh(c.surface.vertices, c.surface.triangles, workers);
  RefinementOptions options;
  options.on_surface = true;
  const Outcome o = run(std::move(c), options);
  for (const Vec3& p : o.mesh.positions) EXPECT_LT(bvh.closest(p).squared_distance, 1e-20);
  const auto [least, most] = test::angle_range(o.mesh);
  EXPECT_GE(least, 40);
  EXPECT_LE(most, 80);
}

TEST(Refine, ReachesTighterBounds) {
  RefinementOptions options;
  options.min_angle = 44;
  options.max_angle = 76;
  const Outcome o = run(test::make_case(test::sphere(32), test::sphere(16, 0.5)), options);
  EXPECT_EQ(o.outside, 0);
  EXPECT_GE(test::angle_range(o.mesh).first, 44);
  EXPECT_LE(test::angle_range(o.mesh).second, 76);
}

TEST(Refine, SameBytesForAnyNumberOfThreads) {
  const Outcome one = run(bumpy_torus());
  for (int threads : {2, 5}) expect_same_bytes(run(bumpy_torus(), {}, threads).mesh, one.mesh);
}

TEST(Refine, RotationChangesNothingThatMatters) {
  const auto rotate = [](Vec3 p) {
    return Vec3{0.36 * p.x + 0.48 * p.y - 0.8 * p.z, -0.8 * p.x + 0.6 * p.y,
                0.48 * p.x + 0.64 * p.y + 0.6 * p.z};
  };
  const Outcome o = run(bumpy_torus(rotate));
  EXPECT_EQ(o.outside, 0);
  EXPECT_EQ(o.bad_valences, 0);
}

TEST(Refine, BoundaryStaysAndTopologyHolds) {
  // A sphere with a hole: the triangles above a plane are left out.
  test::Soup surface = test::sphere(32), start = test::sphere(16, 0.3);
  for (test::Soup* s : {&surface, &start}) {
    std::vector<Triangle> kept;
    std::vector<Index> renamed(s->vertices.size(), -1);
    std::vector<Vec3> used;
    for (Triangle t : s->triangles) {
      if (s->vertices[t[0]].z + s->vertices[t[1]].z + s->vertices[t[2]].z > 2.1) continue;
      for (Index& v : t) {
        if (renamed[v] < 0)
          renamed[v] = static_cast<Index>(used.size()), used.push_back(s->vertices[v]);
        v = renamed[v];
      }
      kept.push_back(t);
    }
    s->triangles = kept;
    s->vertices = used;
  }
  test::Case c = test::make_case(surface, start);
  const mesh::EditableMesh before = c.mesh;
  const Outcome o = run(std::move(c));
  EXPECT_EQ(test::euler_characteristic(o.mesh), test::euler_characteristic(before));
  EXPECT_EQ(o.mesh.vertex_count(), before.vertex_count());
  EXPECT_NO_THROW(o.mesh.check_invariants());
  Index boundary = 0;
  for (Index v = 0; v < o.mesh.vertex_capacity(); ++v) boundary += o.mesh.on_boundary(v);
  EXPECT_GT(boundary, 0);
}

TEST(Refine, CancelledAtAnyTimeItReturnsAValidMesh) {
  for (int ticks : {0, 1, 3, 7, 12}) {
    int left = ticks;
    Context context;
    context.progress = [&](const Progress&) { return left-- > 0; };
    test::Case c = bumpy_torus();
    const Index n = c.mesh.vertex_count(), chi = test::euler_characteristic(c.mesh);
    const Outcome o = run(std::move(c), {}, 1, context);
    EXPECT_EQ(o.mesh.vertex_count(), n);
    EXPECT_EQ(test::euler_characteristic(o.mesh), chi);
    EXPECT_NO_THROW(o.mesh.check_invariants());
    for (const Vec3& p : o.mesh.positions) EXPECT_TRUE(is_finite(p));
  }
}

TEST(Refine, SurfaceOfTwelveTriangles) {
  test::Soup cube{
      {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {0, 0, 1}, {1, 0, 1}, {0, 1, 1}, {1, 1, 1}},
      {{0, 2, 1},
       {1, 2, 3},
       {4, 5, 6},
       {5, 7, 6},
       {0, 1, 4},
       {1, 5, 4},
       {2, 6, 3},
       {3, 6, 7},
       {0, 4, 2},
       {2, 4, 6},
       {1, 3, 5},
       {3, 7, 5}}};
  test::Soup start = test::sphere(16);
  for (Vec3& p : start.vertices) {
    const double m = std::max(std::abs(p.x), std::max(std::abs(p.y), std::abs(p.z)));
    p = 0.5 * (p / m + Vec3{1, 1, 1});
  }
  const Outcome o = run(test::make_case(cube, start));
  EXPECT_EQ(test::euler_characteristic(o.mesh), 2);
  const auto [least, most] = test::angle_range(o.mesh);
  EXPECT_GE(least, 30);
  EXPECT_LT(most, 90);
}

TEST(OptimizeValence, MendsRandomFlips) {
  for (std::uint64_t seed : {1, 2, 3}) {
    test::Case c = test::make_case(test::sphere(32), test::sphere(16, 0.2));
    // Flips at random places make valences of 3, 4, 8 and 9.
    for (std::uint64_t i = 0; i < 120; ++i) {
      numeric::Random random(seed, i);
      const mesh::Edge e{static_cast<Index>(random.below(c.mesh.triangle_count())),
                         static_cast<int>(random.below(3))};
      if (c.mesh.can_flip(e)) c.mesh.flip(e);
    }
    const Index n = c.mesh.vertex_count();
    ASSERT_GT(test::bad_valence_count(c.mesh), 20);
    const parallel::Workers workers(1);
    const Context context;
    parallel::Monitor monitor(context);
    const spatial::TriangleBvh bvh(c.surface.vertices, c.surface.triangles, workers);
    const Index left = pipeline::optimize_valence(c.surface, bvh, c.mesh, workers, monitor);
    EXPECT_EQ(left, 0);
    EXPECT_EQ(test::bad_valence_count(c.mesh), 0);
    EXPECT_EQ(c.mesh.vertex_count(), n);
    EXPECT_EQ(test::euler_characteristic(c.mesh), 2);
    EXPECT_NO_THROW(c.mesh.check_invariants());
  }
}

}  // namespace
}  // namespace nonobtuse
