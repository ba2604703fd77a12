// Eq. 2: gradient by finite differences, creases and density included, and what is left of it for
// s = 1 and on a plane.
#include "energy/feature_sensitive.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "numeric/random.h"
#include "rdt/shapes.h"
#include "rvd/candidate_lists.h"

namespace nonobtuse::energy {
namespace {

struct Value {
  double energy = 0;
  std::vector<Vec3> gradient;
  std::vector<numeric::SymmetricMatrix> hessian;
};

Value evaluate(const mesh::Surface& surface, const std::vector<Vec3>& sites, double s) {
  const parallel::Workers workers(1);
  const rvd::RestrictedVoronoi diagram = rvd::restricted_voronoi(
      surface, sites, rvd::facet_candidates(surface, sites, workers), workers);
  Value value{0, std::vector<Vec3>(sites.size()),
              std::vector<numeric::SymmetricMatrix>(sites.size())};
  value.energy = add_feature_sensitive(surface, sites, diagram, s, value.gradient, value.hessian);
  return value;
}

// A surface and sites near it, but off it.
struct Scene {
  mesh::Surface surface;
  std::vector<Vec3> sites;
};

Scene scene(TriangleMesh mesh, Index n, bool graded) {
  Scene s{shapes::scaled_surface(std::move(mesh), n), {}};
  s.sites = shapes::random_sites(s.surface, n, 3);
  numeric::Random random(5);
  for (Vec3& x : s.sites)
    x += 0.1 * Vec3{random.uniform() - 0.5, random.uniform() - 0.5, random.uniform() - 0.5};
  if (graded)
    for (const Vec3& v : s.surface.vertices)
      s.surface.size.push_back(1.2 + 0.05 * v.x + 0.04 * v.y - 0.03 * v.z);
  return s;
}

void expect_gradient_like_differences(const Scene& at, double s) {
  const Value here = evaluate(at.surface, at.sites, s);
  double scale = 0;
  for (const Vec3& g : here.gradient) scale = std::max(scale, length(g));
  const double h = 1e-6;
  for (std::size_t i = 0; i < at.sites.size(); i += 3)
    for (double Vec3::*axis : {&Vec3::x, &Vec3::y, &Vec3::z}) {
      std::vector<Vec3> moved = at.sites;
      moved[i].*axis += h;
      const double above = evaluate(at.surface, moved, s).energy;
      moved[i].*axis -= 2 * h;
      const double below = evaluate(at.surface, moved, s).energy;
      EXPECT_NEAR((above - below) / (2 * h), here.gradient[i].*axis, 1e-6 * scale) << "site " << i;
    }
}

TEST(FeatureSensitive, GradientLikeFiniteDifferencesOnASmoothSurface) {
  expect_gradient_like_differences(scene(shapes::torus(24, 12), 60, false), 5);
}

// Every cell of so coarse a box meets a crease.
TEST(FeatureSensitive, GradientLikeFiniteDifferencesAtCreases) {
  for (const double s : {1.0, 3.0, 5.0})
    expect_gradient_like_differences(scene(shapes::box(2, 2, 1), 30, false), s);
}

TEST(FeatureSensitive, GradientLikeFiniteDifferencesWithLinearDensity) {
  expect_gradient_like_differences(scene(shapes::box(2, 2, 1), 30, true), 5);
  expect_gradient_like_differences(scene(shapes::torus(24, 12), 60, true), 5);
}

TEST(FeatureSensitive, IsEquationOneForWeightOne) {
  const Scene at = scene(shapes::box(2, 2, 1), 30, false);
  const parallel::Workers workers(1);
  const rvd::RestrictedVoronoi diagram = rvd::restricted_voronoi(
      at.surface, at.sites, rvd::facet_candidates(at.surface, at.sites, workers), workers);
  const rvd::CellSums cells = rvd::cell_sums(at.surface, at.sites, diagram, diagram.site);
  const Value value = evaluate(at.surface, at.sites, 1);
  EXPECT_NEAR(value.energy, cells.energy, 1e-12 * cells.energy);
  for (std::size_t i = 0; i < at.sites.size(); ++i) {
    const Vec3 g = 2 * cells.mass[i] * (at.sites[i] - cells.centroid[i]);
    EXPECT_LT(length(value.gradient[i] - g), 1e-12);
    EXPECT_NEAR(value.hessian[i].xx, 2 * cells.mass[i], 1e-12);
    EXPECT_EQ(value.hessian[i].xy, 0);
  }
}

// Lifting sites off a plane by h costs (s^2 - 1) h^2 times its area more, whatever the cells.
TEST(FeatureSensitive, HeightAboveAPlaneCostsTheSquareOfTheWeight) {
  const mesh::Surface plane = shapes::scaled_surface(shapes::square(4), 20);
  std::vector<Vec3> sites = shapes::random_sites(plane, 20, 1);
  for (Vec3& x : sites) x.z += 0.3;
  const double plain = evaluate(plane, sites, 1).energy;
  const double weighted = evaluate(plane, sites, 4).energy;
  EXPECT_NEAR(weighted - plain, 15 * 0.09 * plane.area, 1e-10 * weighted);
  for (Vec3& x : sites) x.z -= 0.3;
  EXPECT_NEAR(evaluate(plane, sites, 4).energy, evaluate(plane, sites, 1).energy, 1e-10);
}

// One site in the middle of every face of a unit cube: by symmetry each is pulled along its normal.
TEST(FeatureSensitive, SymmetricSitesArePulledAlongTheirNormals) {
  const mesh::Surface cube = shapes::scaled_surface(shapes::box(2, 2, 2), 6);
  const std::vector<Vec3> sites{{0, .5, .5}, {1, .5, .5}, {.5, 0, .5},
                                {.5, 1, .5}, {.5, .5, 0}, {.5, .5, 1}};
  const Value value = evaluate(cube, sites, 5);
  EXPECT_LT(std::abs(value.gradient[0].y) + std::abs(value.gradient[0].z), 1e-12);
  EXPECT_NEAR(value.gradient[0].x, -value.gradient[1].x, 1e-12);
}

}  // namespace
}  // namespace nonobtuse::energy
