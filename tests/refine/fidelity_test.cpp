// Fidelity: gradients by finite differences, samples against brute force, sheets kept apart.
#include "refine/fidelity.h"

#include <gtest/gtest.h>

#include "refine/global_descent.h"
#include "refine/relaxation.h"
#include "refine/test_surfaces.h"

namespace nonobtuse {
namespace {

using refine::Fidelity;

struct Scene {
  explicit Scene(test::Case c)
      : made(std::move(c)),
        bvh(made.surface.vertices, made.surface.triangles, workers),
        fidelity(made.surface, bvh) {
    fidelity.samples = refine::sample_surface(made.surface, 8 * made.mesh.vertex_count());
    fidelity.search_samples(made.mesh, workers);
    fidelity.update_planes(made.mesh, workers);
  }
  parallel::Workers workers{1};
  test::Case made;
  spatial::TriangleBvh bvh;
  Fidelity fidelity;
};

TEST(TriangleFrame, ClosestPointAgreesWithSampling) {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    numeric::Random random(3, seed);
    const auto point = [&] { return Vec3{random.uniform(), random.uniform(), random.uniform()}; };
    const Vec3 a = point(), b = point(), c = seed % 5 ? point() : 0.5 * (a + b), y = 3 * point();
    const refine::ClosestPoint closest = refine::TriangleFrame(a, b, c).closest(y);
    const auto& w = closest.barycentric;
    EXPECT_NEAR(w[0] + w[1] + w[2], 1, 1e-12);
    EXPECT_NEAR(squared_distance(w[0] * a + w[1] * b + w[2] * c, y), closest.squared_distance,
                1e-9);
    double least = 1e9;
    for (int i = 0; i <= 60; ++i)
      for (int j = 0; i + j <= 60; ++j)
        least = std::min(least, squared_distance(a + i / 60.0 * (b - a) + j / 60.0 * (c - a), y));
    EXPECT_LE(closest.squared_distance, least + 1e-12);
    EXPECT_NEAR(std::sqrt(closest.squared_distance), std::sqrt(least), 0.03);
  }
}

TEST(SampleSurface, StandsForTheWholeArea) {
  const test::Case c = test::make_case(test::torus(40, 20), test::torus(40, 20));
  const auto samples = refine::sample_surface(c.surface, 3000);
  ASSERT_EQ(samples.size(), 3000u);
  double weight = 0;
  for (const refine::Sample& s : samples) weight += s.weight;
  EXPECT_NEAR(weight, c.surface.area, 1e-9 * c.surface.area);
}

TEST(Fidelity, SamplesFindTheirNearestTriangle) {
  Scene s(test::make_case(test::sphere(16), test::sphere(8, 0.3)));
  for (Vec3& p : s.made.mesh.positions) p += 0.05 * normalized(p);
  s.fidelity.walk_samples(s.made.mesh, s.workers);
  std::size_t seen = 0, exact = 0;
  for (Index t = 0; t < s.made.mesh.triangle_capacity(); ++t)
    for (Index i = s.fidelity.first[t]; i >= 0; i = s.fidelity.samples[i].next) {
      ++seen;
      double own = 0, least = 1e9;
      for (Index u = 0; u < s.made.mesh.triangle_capacity(); ++u) {
        const auto p = refine::corners(s.made.mesh, u);
        const double d = refine::TriangleFrame(p[0], p[1], p[2])
                             .closest(s.fidelity.samples[i].point)
                             .squared_distance;
        if (u == t) own = d;
        least = std::min(least, d);
      }
      // Walking may end in a local minimum, but not far from the global one.
      EXPECT_LE(std::sqrt(own), std::sqrt(least) + 0.05);
      exact += own <= least + 1e-12;
    }
  EXPECT_EQ(seen, s.fidelity.samples.size());
  EXPECT_GT(exact, seen - seen / 100);
}

TEST(Fidelity, GlobalGradientAgreesWithFiniteDifferences) {
  Scene s(test::make_case(test::torus(40, 16), test::torus(30, 12, 0.3)));
  refine::GlobalDescent descent(s.made.mesh, s.fidelity, false, s.workers);
  descent.shape = energy::hinged(10, 50, 75);
  descent.freeze();
  std::vector<Vec3> gradient, ignored;
  descent.evaluate(gradient);
  const double step = 1e-5;
  for (Index v = 0; v < s.made.mesh.vertex_capacity(); v += 17) {
    Vec3 ring;
    refine::ring_energy(s.made.mesh, s.fidelity, descent.shape, v, s.made.mesh.positions[v], &ring);
    EXPECT_NEAR(length(ring - gradient[v]), 0, 1e-10);
    for (double Vec3::*axis : {&Vec3::x, &Vec3::y, &Vec3::z}) {
      const Vec3 p = s.made.mesh.positions[v];
      s.made.mesh.positions[v].*axis += step;
      const double up = descent.evaluate(ignored);
      s.made.mesh.positions[v].*axis -= 2 * step;
      const double down = descent.evaluate(ignored);
      s.made.mesh.positions[v] = p;
      EXPECT_NEAR(gradient[v].*axis, (up - down) / (2 * step), 2e-4 * (1 + length(gradient[v])));
    }
  }
}

TEST(Fidelity, FeetStayOnTheirOwnSheet) {
  // Two parallel sheets far closer than an edge: a flat box around the middle plane.
  test::Soup thin = test::sphere(16);
  for (Vec3& p : thin.vertices) p.z *= 0.02;
  Scene s(test::make_case(thin, thin));
  for (Index v = 0; v < s.made.mesh.vertex_capacity(); ++v) {
    const Vec3 normal = normalized(refine::vertex_area_vector(s.made.mesh, v));
    const refine::TangentPlane& plane = s.fidelity.vertex_planes[v];
    if (std::abs(normal.z) > 0.9) {
      EXPECT_GT(dot(s.made.surface.normals[plane.facet], normal), 0);
    }
  }
}

TEST(Relaxation, NeverRaisesTheEnergy) {
  Scene s(test::make_case(test::torus(40, 16), test::torus(30, 12, 0.5)));
  refine::GlobalDescent descent(s.made.mesh, s.fidelity, false, s.workers);
  descent.shape = energy::hinged(10, 42, 78);
  descent.freeze();
  std::vector<Vec3> gradient;
  const double before = descent.evaluate(gradient);
  std::vector<Index> all;
  for (Index v = 0; v < s.made.mesh.vertex_capacity(); ++v) all.push_back(v);
  const std::vector<refine::TangentPlane> planes = s.fidelity.vertex_planes;
  refine::relax(s.made.mesh, s.fidelity, all, {descent.shape, 1, false}, s.workers);
  s.fidelity.vertex_planes = planes;  // each step lowers the energy with the planes it was made for
  EXPECT_LT(descent.evaluate(gradient), before);
}

}  // namespace
}  // namespace nonobtuse
