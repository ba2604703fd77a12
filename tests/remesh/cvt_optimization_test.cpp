#include "remesh/cvt_optimization.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "nonobtuse/context.h"
#include "remesh/initial_sampling.h"
#include "rvd/test_surfaces.h"

namespace nonobtuse::pipeline {
namespace {

using rvd::test::cube;
using rvd::test::octasphere;

std::vector<Vec3> optimized(const mesh::Surface& surface, const CvtOptions& options,
                            int threads = 1) {
  const Context context;
  parallel::Monitor monitor(context);
  return optimize_cvt(surface, options, parallel::Workers(threads), monitor);
}

double energy_of(const mesh::Surface& surface, const std::vector<Vec3>& sites) {
  const parallel::Workers workers(1);
  rvd::CellEvaluator evaluator(surface, static_cast<Index>(sites.size()), workers);
  rvd::CellIntegrals cells;
  evaluator.evaluate(sites, cells);
  return cells.energy;
}

mesh::Surface transformed(const mesh::Surface& s, double scale, const Vec3& shift) {
  std::vector<Vec3> v = s.vertices;
  for (Vec3& p : v) p = scale * Vec3{p.z, p.x, p.y} + shift;  // a rotation about (1, 1, 1)
  return mesh::make_surface(v, s.triangles);
}

// Two spheres, the second small: its share of sites by area is below one.
mesh::Surface two_spheres() {
  const mesh::Surface sphere = octasphere(3);
  std::vector<Vec3> v = sphere.vertices;
  std::vector<Triangle> t = sphere.triangles;
  const auto first = static_cast<Index>(v.size());
  for (const Vec3& p : sphere.vertices) v.push_back(0.02 * p + Vec3{3, 0, 0});
  for (const Triangle& f : sphere.triangles)
    t.push_back({f[0] + first, f[1] + first, f[2] + first});
  return mesh::make_surface(v, t);
}

TEST(InitialSampling, SharesSitesByAreaWithAtLeastFour) {
  const mesh::Surface s = two_spheres();
  const Components c = connected_components(s);
  ASSERT_EQ(c.count(), 2);
  EXPECT_EQ(c.euler, (std::vector<Index>{2, 2}));
  EXPECT_EQ(share_sites(c, 1000), (std::vector<Index>{996, 4}));
  EXPECT_EQ(share_sites(c, 8), (std::vector<Index>{4, 4}));
  for (Index n = 1; n < 50; ++n) {
    const auto q = share_sites(c, n);
    EXPECT_EQ(std::accumulate(q.begin(), q.end(), 0), n);
    EXPECT_GE(*std::min_element(q.begin(), q.end()), n >= 8 ? 4 : 0);
  }
}

TEST(InitialSampling, OnePointPerStratum) {
  const mesh::Surface s = cube();
  const Components c = connected_components(s);
  const SampledSites samples = sample_strata(s, c, {600}, 3);
  ASSERT_EQ(samples.points.size(), 600);
  int on_top = 0;  // a sixth of the area; the strata bound the deviation
  for (const Vec3& p : samples.points) {
    const double outside =
        std::max({std::abs(p.x - 0.5), std::abs(p.y - 0.5), std::abs(p.z - 0.5)});
    EXPECT_NEAR(outside, 0.5, 1e-12);
    on_top += p.z > 1 - 1e-12 ? 1 : 0;
  }
  EXPECT_NEAR(on_top, 100, 20);
}

TEST(CvtOptimization, ExactlyTheSitesAskedFor) {
  const mesh::Surface sphere = octasphere(3);
  for (const Index n : {1, 2, 4, 7, 63, 64, 65, 100, 257, 1000})
    EXPECT_EQ(optimized(sphere, {.sites = n, .iterations = 3, .coarse_iterations = 3}).size(), n);
  const mesh::Surface two = two_spheres();
  const auto sites = optimized(two, {.sites = 500});
  EXPECT_EQ(std::count_if(sites.begin(), sites.end(), [](const Vec3& p) { return p.x > 2; }), 4);
}

TEST(CvtOptimization, MoreEvaluationsLessEnergy) {
  const mesh::Surface sphere = octasphere(4);
  double last = 1e300;
  for (const int iterations : {1, 2, 5, 20, 60}) {
    const double energy = energy_of(
        sphere, optimized(sphere, {.sites = 300, .iterations = iterations, .coarse_levels = 0}));
    EXPECT_LT(energy, last);
    last = energy;
  }
  // The least conceivable energy per site is that of the regular hexagon of the same area (Gersho;
  // Fejes Toth): 5 sqrt(3) / 54 A^2. Chords of the sphere change it a little.
  const double hexagonal = 300 * 5 * std::sqrt(3.0) / 54 * std::pow(sphere.area / 300, 2);
  EXPECT_GT(last, 0.98 * hexagonal);
  EXPECT_LT(last, 1.04 * hexagonal);
}

TEST(CvtOptimization, SameBitsForAnyNumberOfThreads) {
  const mesh::Surface sphere = octasphere(5);
  const CvtOptions options{.sites = 2000, .seed = 5, .iterations = 6, .coarse_iterations = 6};
  const auto one = optimized(sphere, options, 1);
  EXPECT_EQ(one, optimized(sphere, options, 2));
  EXPECT_EQ(one, optimized(sphere, options, 5));
}

TEST(CvtOptimization, ScaleAndRotationChangeNothingThatMatters) {
  const mesh::Surface sphere = octasphere(4);
  const CvtOptions options{.sites = 400};
  const double energy = energy_of(sphere, optimized(sphere, options));
  for (const double scale : {1e-6, 1e6}) {
    const mesh::Surface other = transformed(sphere, scale, scale * Vec3{1, 2, 3});
    const double again = energy_of(other, optimized(other, options)) / std::pow(scale, 4);
    EXPECT_NEAR(again, energy, 0.01 * energy);
  }
}

TEST(CvtOptimization, OpenSurface) {
  mesh::Surface half = octasphere(4);
  std::vector<Triangle> upper;
  for (const Triangle& t : half.triangles) {
    const double z = half.vertices[t[0]].z + half.vertices[t[1]].z + half.vertices[t[2]].z;
    if (z > 0) upper.push_back(t);
  }
  half = mesh::make_surface(half.vertices, upper);
  const auto sites = optimized(half, {.sites = 500});
  EXPECT_EQ(sites.size(), 500);
  const double hexagonal = 5 * std::sqrt(3.0) / 54 * half.area * half.area / 500;
  EXPECT_LT(energy_of(half, sites), 1.05 * hexagonal);
}

TEST(CvtOptimization, CancelledRunsStillReturnAllSites) {
  const mesh::Surface sphere = octasphere(3);
  int calls = 0;
  Context context;
  context.progress = [&](const Progress&) { return ++calls < 3; };
  parallel::Monitor monitor(context);
  const auto sites = optimize_cvt(sphere, {.sites = 300}, parallel::Workers(1), monitor);
  EXPECT_EQ(sites.size(), 300);
  EXPECT_LE(calls, 4);
}

}  // namespace
}  // namespace nonobtuse::pipeline
