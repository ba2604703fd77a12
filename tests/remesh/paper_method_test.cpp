// The paper's obtuse removal on small surfaces: never worse than its start, on the surface, with
// the surface's topology, the same for any number of threads.
#include "remesh/paper_method.h"

#include <gtest/gtest.h>

#include <vector>

#include "numeric/vec3.h"
#include "rdt/shapes.h"
#include "remesh/cvt_optimization.h"
#include "remesh/penalized_energy.h"
#include "remesh/restricted_diagram.h"
#include "remesh/surface_projection.h"
#include "remesh/valence_resampling.h"

namespace nonobtuse::pipeline {
namespace {

constexpr Index kSites = 400;

const mesh::Surface& torus() {
  static const mesh::Surface surface = shapes::scaled_surface(shapes::torus(60, 30), kSites);
  return surface;
}

// A CVT stopped early: irregular enough to hold obtuse triangles.
std::vector<Vec3> rough_cvt(const mesh::Surface& surface) {
  const parallel::Workers workers(1);
  const Context context;
  parallel::Monitor monitor(context);
  CvtOptions options;
  options.sites = kSites;
  options.iterations = 6;
  options.coarse_levels = 0;
  return optimize_cvt(surface, options, workers, monitor);
}

int count_obtuse(const std::vector<Vec3>& x, const std::vector<Triangle>& triangles) {
  int count = 0;
  for (const Triangle& t : triangles)
    for (int k = 0; k < 3; ++k)
      count += dot(x[t[(k + 1) % 3]] - x[t[k]], x[t[(k + 2) % 3]] - x[t[k]]) <= 0;
  return count;
}

std::vector<Vec3> removal(const mesh::Surface& surface, const std::vector<Vec3>& start,
                          const PaperOptions& options, int threads = 1) {
  const parallel::Workers workers(threads);
  const Context context;
  parallel::Monitor monitor(context);
  return optimize_paper_nob(surface, start, options, workers, monitor);
}

class PaperMethod : public testing::TestWithParam<PaperOptions> {};

TEST_P(PaperMethod, RemovesObtuseTrianglesAndKeepsTheSurface) {
  const mesh::Surface& surface = torus();
  const parallel::Workers workers(1);
  const std::vector<Vec3> start = rough_cvt(surface);
  const RestrictedDiagram before = restricted_diagram(surface, start, workers);
  const int obtuse_before = count_obtuse(start, before.triangles);
  ASSERT_GT(obtuse_before, 5);

  const std::vector<Vec3> sites = removal(surface, start, GetParam());
  ASSERT_EQ(sites.size(), start.size());
  const RestrictedDiagram after = restricted_diagram(surface, sites, workers);
  EXPECT_TRUE(after.defects.empty());
  const shapes::Topology topology = shapes::topology(after.triangles);
  EXPECT_TRUE(topology.manifold);
  EXPECT_EQ(topology.euler, 0);
  EXPECT_EQ(topology.vertices, kSites);
  EXPECT_LT(count_obtuse(sites, after.triangles), obtuse_before / 2);

  const SurfaceProjection projection(surface, workers);
  const PlacedSites feet = projection.place(sites);
  for (std::size_t i = 0; i < sites.size(); ++i)
    EXPECT_LT(distance(sites[i], feet.sites[i]), 1e-9) << i;
}

TEST_P(PaperMethod, GivesTheSameBytesForAnyNumberOfThreads) {
  PaperOptions options = GetParam();
  options.iterations = 6;
  const std::vector<Vec3> start = rough_cvt(torus());
  const std::vector<Vec3> one = removal(torus(), start, options, 1);
  EXPECT_EQ(removal(torus(), start, options, 2), one);
  EXPECT_EQ(removal(torus(), start, options, 5), one);
}

INSTANTIATE_TEST_SUITE_P(
    Penalties, PaperMethod,
    testing::Values(PaperOptions{},
                    PaperOptions{.weights = {.short_dual = 0.01, .tangential = true},
                                 .valence = ValenceStep::Resampling,
                                 .resampling_rounds = 4},
                    PaperOptions{.weights = {.circumcentre = 1},
                                 .valence = ValenceStep::None,
                                 .iterations = 15},
                    PaperOptions{.weights = {.hinge = 1}, .iterations = 15},
                    PaperOptions{.weights = {.circumcentre = 1, .hinge = 1}, .iterations = 15}));

std::vector<Vec3> feature_sensitive(const mesh::Surface& surface, const std::vector<Vec3>& start,
                                    const PenaltyWeights& weights, int threads = 1) {
  const parallel::Workers workers(threads);
  const Context context;
  parallel::Monitor monitor(context);
  return optimize_feature_sensitive(surface, start, weights, 15, workers, monitor);
}

double energy_of(const mesh::Surface& surface, const std::vector<Vec3>& sites,
                 const PenaltyWeights& weights) {
  const parallel::Workers workers(1);
  const SurfaceProjection projection(surface, workers);
  return PenalizedEnergy(surface, weights, workers).evaluate(projection.place(sites)).score.energy;
}

TEST(FeatureSensitiveStage, LowersEquationTwoAndIsTheSameForAnyThreads) {
  const PenaltyWeights weights{.normal_weight = 5};
  const std::vector<Vec3> start = rough_cvt(torus());
  const std::vector<Vec3> sites = feature_sensitive(torus(), start, weights);
  EXPECT_LT(energy_of(torus(), sites, weights), 0.98 * energy_of(torus(), start, weights));
  EXPECT_EQ(feature_sensitive(torus(), start, weights, 2), sites);
}

// On a box, sites that may not leave the faces come closer to the creases: fewer of the output's
// triangles cut corners, so the volume between box and mesh shrinks. Measured by the normal part of
// Eq. 2 itself, (s^2 - 1) times the integral of h^2.
TEST(FeatureSensitiveStage, DrawsSitesToCreases) {
  const mesh::Surface box = shapes::scaled_surface(shapes::box(4, 4, 2), kSites);
  const std::vector<Vec3> start = rough_cvt(box);
  const auto normal_part = [&](const std::vector<Vec3>& x) {
    return energy_of(box, x, {.normal_weight = 5}) - energy_of(box, x, {});
  };
  const std::vector<Vec3> sites = feature_sensitive(box, start, {.normal_weight = 5});
  EXPECT_LT(normal_part(sites), 0.5 * normal_part(start));
}

TEST(FeatureSensitiveStage, NeverAddsBadTrianglesWithAPenalty) {
  const parallel::Workers workers(1);
  const std::vector<Vec3> start = removal(torus(), rough_cvt(torus()), {});
  const auto bad = [&](const std::vector<Vec3>& x) {
    return count_bad_triangles(x, restricted_diagram(torus(), x, workers).triangles).obtuse;
  };
  const std::vector<Vec3> sites =
      feature_sensitive(torus(), start, {.normal_weight = 5, .short_dual = 0.01});
  EXPECT_LE(bad(sites), bad(start));
}

TEST(PaperMethodSteps, CancellationReturnsUsableSites) {
  const std::vector<Vec3> start = rough_cvt(torus());
  const parallel::Workers workers(1);
  int calls = 0;
  const Context context{.threads = 1, .progress = [&](const Progress&) { return ++calls < 3; }};
  parallel::Monitor monitor(context);
  const std::vector<Vec3> sites = optimize_paper_nob(torus(), start, {}, workers, monitor);
  EXPECT_EQ(sites.size(), start.size());
  EXPECT_LE(calls, 4);
  for (const Vec3& x : sites) EXPECT_TRUE(is_finite(x));
}

TEST(ValenceResampling, NeverRaisesTheNumberOfBadValences) {
  const parallel::Workers workers(1);
  const Context context;
  parallel::Monitor monitor(context);
  const SurfaceProjection projection(torus(), workers);
  PlacedSites placed = projection.place(rough_cvt(torus()));
  Index last = resample_bad_valences(torus(), projection, placed, 0, 1, workers, monitor);
  ASSERT_GT(last, 0);
  for (int rounds = 1; rounds <= 3; ++rounds) {
    const Index left =
        resample_bad_valences(torus(), projection, placed, 4, 1 + rounds, workers, monitor);
    EXPECT_LE(left, last);
    last = left;
  }
  EXPECT_TRUE(restricted_diagram(torus(), placed.sites, workers).defects.empty());
}

TEST(SurfaceProjection, AStepDoesNotJumpToTheOtherSideOfAThinSheet) {
  // A box a tenth of an edge thick: the far side is nearer to the end of a step along the normal.
  TriangleMesh box = shapes::box(10, 10, 1);
  for (Vec3& p : box.vertices) p.z *= 0.1;
  const mesh::Surface surface = mesh::make_surface(box.vertices, box.triangles);
  const parallel::Workers workers(1);
  const SurfaceProjection projection(surface, workers);
  PlacedSites placed = projection.place(std::vector<Vec3>{{5.3, 5.3, 0.1}});
  ASSERT_EQ(placed.normals[0], (Vec3{0, 0, 1}));
  projection.step(placed, 0, {0.5, 0, -0.08});
  EXPECT_EQ(placed.normals[0], (Vec3{0, 0, 1}));
  EXPECT_NEAR(placed.sites[0].x, 5.8, 1e-12);
  EXPECT_NEAR(placed.sites[0].z, 0.1, 1e-12);
}

}  // namespace
}  // namespace nonobtuse::pipeline
