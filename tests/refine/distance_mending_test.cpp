// Largest distances: found where samples by area miss them, and lowered without new faults.
#include "refine/distance_mending.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "refine/fidelity.h"
#include "refine/largest_distance.h"
#include "refine/minimax_relaxation.h"
#include "refine/relaxation.h"
#include "refine/test_surfaces.h"

namespace nonobtuse {
namespace {

struct Scene {
  Scene(test::Soup surface, test::Soup start)
      : made(test::make_case(std::move(surface), std::move(start))),
        bvh(made.surface.vertices, made.surface.triangles, workers),
        fidelity(made.surface, bvh) {
    fidelity.weights = {20, 20};
    renew();
  }
  void renew() {
    fidelity.samples = refine::sample_surface(made.surface, 8 * made.mesh.vertex_count());
    fidelity.search_samples(made.mesh, workers);
    fidelity.update_planes(made.mesh, workers, true);
  }
  parallel::Workers workers{1};
  test::Case made;
  spatial::TriangleBvh bvh;
  refine::Fidelity fidelity;
};

// The largest distance of many points on the mesh from the surface, by search.
double brute_force_distance(const Scene& s) {
  double largest = 0;
  for (Index t = 0; t < s.made.mesh.triangle_capacity(); ++t) {
    if (!s.made.mesh.alive_triangle(t)) continue;
    const auto p = refine::corners(s.made.mesh, t);
    for (int i = 0; i <= 8; ++i)
      for (int j = 0; i + j <= 8; ++j) {
        const Vec3 x = p[0] + i / 8.0 * (p[1] - p[0]) + j / 8.0 * (p[2] - p[0]);
        largest = std::max(largest, std::sqrt(s.bvh.closest(x).squared_distance));
      }
  }
  return largest;
}

test::Soup cube() {
  return {{{-1, -1, -1},
           {1, -1, -1},
           {1, 1, -1},
           {-1, 1, -1},
           {-1, -1, 1},
           {1, -1, 1},
           {1, 1, 1},
           {-1, 1, 1}},
          {{0, 2, 1},
           {0, 3, 2},
           {4, 5, 6},
           {4, 6, 7},
           {0, 1, 5},
           {0, 5, 4},
           {1, 2, 6},
           {1, 6, 5},
           {2, 3, 7},
           {2, 7, 6},
           {3, 0, 4},
           {3, 4, 7}}};
}

TEST(RidgePoints, SharpEdgesAndVerticesOfTheSurfaceBecomeSamples) {
  Scene s(cube(), test::sphere(8));
  const std::size_t before = s.fidelity.samples.size();
  const double half = s.made.surface.vertices[6].x;
  const Index far = s.fidelity.emphasize_far_ridges(s.made.mesh, 0.05, 0.2, 2, s.workers);
  EXPECT_EQ(static_cast<std::size_t>(far), s.fidelity.samples.size() - before);
  std::size_t corners = 0, on_edges = 0;
  for (std::size_t i = before; i < s.fidelity.samples.size(); ++i) {
    const Vec3 p = s.fidelity.samples[i].point;
    const int sides = (std::abs(std::abs(p.x) - half) < 1e-9) +
                      (std::abs(std::abs(p.y) - half) < 1e-9) +
                      (std::abs(std::abs(p.z) - half) < 1e-9);
    EXPECT_GE(sides, 2);  // never on the diagonal of a side
    corners += sides == 3;
    on_edges += sides == 2;
  }
  EXPECT_EQ(corners, 8u);
  EXPECT_GE(on_edges, 12u);
  // A second time none is added, and their weights grow.
  const double weight = s.fidelity.samples[before].weight;
  EXPECT_EQ(s.fidelity.emphasize_far_ridges(s.made.mesh, 0.05, 0.2, 2, s.workers), far);
  EXPECT_EQ(s.fidelity.samples.size(), before + static_cast<std::size_t>(far));
  EXPECT_DOUBLE_EQ(s.fidelity.samples[before].weight, 2 * weight);
}

TEST(FarPoints, FindsWhatSearchFinds) {
  Scene s(test::sphere(32), test::sphere(8));
  s.made.mesh.positions[20] *= 1.05;
  s.renew();
  const refine::FarPoints points(s.made.mesh, s.fidelity, 0.01, s.workers);
  ASSERT_FALSE(points.list().empty());
  EXPECT_NEAR(points.list().front().distance, brute_force_distance(s), 0.02);
  for (std::size_t i = 1; i < points.list().size(); ++i)
    EXPECT_GE(points.list()[i - 1].distance, points.list()[i].distance);
}

TEST(MendDistance, LowersTheLargestDistanceAndKeepsTheRest) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    Scene s(test::torus(80, 32), test::torus(40, 16, 0.2, seed));
    refine::TrialOptions options;
    options.goal = {35, 86};
    options.shape = energy::hinged(100, 36, 85);
    const Index count = s.made.mesh.vertex_count();
    const Vec3 out = normalized(refine::vertex_area_vector(s.made.mesh, 100));
    s.made.mesh.positions[100] += 0.4 * out;
    s.renew();
    const double before = brute_force_distance(s);
    const std::size_t outside =
        refine::triangles_outside(s.made.mesh, refine::AngleTest(options.goal)).size();
    EXPECT_GT(refine::mend_distance(s.made.mesh, s.fidelity, options, s.workers,
                                    [](double) { return true; }),
              0);
    EXPECT_LT(brute_force_distance(s), 0.7 * before);
    EXPECT_LE(refine::triangles_outside(s.made.mesh, refine::AngleTest(options.goal)).size(),
              outside);
    EXPECT_EQ(s.made.mesh.vertex_count(), count);
    EXPECT_EQ(test::euler_characteristic(s.made.mesh), 0);
    EXPECT_EQ(test::bad_valence_count(s.made.mesh), 0);
  }
}

TEST(MinimaxRelaxation, LowersTheLargestDistance) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    Scene s(test::torus(80, 32), test::torus(40, 16, 0.2, seed));
    refine::TrialOptions options;
    options.goal = {30, 89};
    options.shape = energy::hinged(100, 31, 88);
    options.far = 0.01;
    const Vec3 out = normalized(refine::vertex_area_vector(s.made.mesh, 100));
    s.made.mesh.positions[100] += 0.4 * out;
    s.renew();
    const std::array<Index, 1> center{100};
    const refine::Patch patch(s.made.mesh, s.fidelity, center, 3);
    const double before = refine::largest_distance(patch.mesh, patch.fidelity, options.far);
    refine::MinimaxRelaxation relaxation(patch, options, refine::score(patch, options));
    EXPECT_FALSE(relaxation.best);
    relaxation.run(10);
    ASSERT_TRUE(relaxation.best);
    EXPECT_GT(relaxation.effort(), 0);
    EXPECT_LT(relaxation.least_distance(), 0.5 * before);
    EXPECT_LE(refine::largest_distance(relaxation.best->mesh, relaxation.best->fidelity, 0.01),
              0.5 * before);
    EXPECT_EQ(relaxation.best_score.outside_goal, 0);
  }
}

TEST(FidelityCorner, AgreesWithTheWholeTriangle) {
  Scene s(test::torus(40, 16), test::torus(30, 12, 0.3));
  for (Index t = 0; t < s.made.mesh.triangle_capacity(); t += 7) {
    const std::array<Vec3, 3> p = refine::corners(s.made.mesh, t);
    std::array<Vec3, 3> whole{};
    const double energy = s.fidelity.triangle(t, p, &whole);
    for (int k = 0; k < 3; ++k) {
      Vec3 gradient;
      std::array<Vec3, 3> hessian{};
      EXPECT_NEAR(s.fidelity.corner(t, p, k, gradient, hessian), energy, 1e-12);
      EXPECT_NEAR(length(gradient - whole[k]), 0, 1e-12);
      // Gauss and Newton: symmetric and positive semidefinite.
      EXPECT_NEAR(hessian[0].y, hessian[1].x, 1e-9);
      EXPECT_NEAR(hessian[0].z, hessian[2].x, 1e-9);
      EXPECT_NEAR(hessian[1].z, hessian[2].y, 1e-9);
      for (const Vec3& d : {Vec3{1, 0, 0}, Vec3{1, 2, -1}, Vec3{-1, 1, 3}}) {
        const Vec3 hd = d.x * hessian[0] + d.y * hessian[1] + d.z * hessian[2];
        EXPECT_GE(dot(d, hd), -1e-9);
      }
    }
  }
}

}  // namespace
}  // namespace nonobtuse
