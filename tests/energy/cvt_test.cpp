#include "energy/cvt.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "numeric/random.h"
#include "rvd/test_surfaces.h"

namespace nonobtuse::energy {
namespace {

TEST(CvtEnergy, GradientLikeFiniteDifferences) {
  const mesh::Surface sphere = rvd::test::octasphere(3);
  const parallel::Workers workers(1);
  std::vector<Vec3> sites = rvd::test::random_sites(sphere, 60, 1);
  for (Vec3& x : sites) x *= 1.05;  // off the surface
  rvd::CellEvaluator evaluator(sphere, 60, workers);
  rvd::CellIntegrals cells;
  const auto energy = [&](const std::vector<Vec3>& at) {
    evaluator.evaluate(at, cells);
    return cells.energy;
  };
  energy(sites);
  std::vector<Vec3> gradient(60);
  cvt_gradient(sites, cells, gradient, workers);
  double scale = 0;
  for (const Vec3& g : gradient) scale = std::max(scale, length(g));
  const double h = 1e-5;
  for (int i = 0; i < 60; i += 7)
    for (int k = 0; k < 3; ++k) {
      const Vec3 e{k == 0 ? h : 0, k == 1 ? h : 0, k == 2 ? h : 0};
      std::vector<Vec3> ahead = sites;
      std::vector<Vec3> behind = sites;
      ahead[i] += e;
      behind[i] += -e;
      const double difference = (energy(ahead) - energy(behind)) / (2 * h);
      EXPECT_NEAR(difference, dot(gradient[i], e) / h, 1e-5 * scale);
    }
}

TEST(CvtEnergy, PieceLikeTheIntegral) {
  const std::array<Vec3, 3> p{{{0, 0, 0}, {2, 0.1, 0}, {0.3, 1, 0.5}}};
  const std::array<double, 3> rho{0.5, 2, 1};
  const Vec3 site{0.4, 0.7, -0.3};
  const double area = 0.5 * length(area_vector(p[0], p[1], p[2]));
  const int n = 400;
  PieceEnergy sum;
  double uniform = 0;
  for (int a = 0; a < n; ++a)
    for (int b = 0; b < n; ++b) {
      const bool upright = a + b < n;
      const double u = upright ? (a + 1 / 3.0) / n : (n - a - 1 / 3.0) / n;
      const double v = upright ? (b + 1 / 3.0) / n : (n - b - 1 / 3.0) / n;
      const Vec3 x = (1 - u - v) * p[0] + u * p[1] + v * p[2];
      const double w = area / (n * n);
      const double r = (1 - u - v) * rho[0] + u * rho[1] + v * rho[2];
      sum.energy += w * r * squared_distance(x, site);
      sum.gradient += 2 * w * r * (site - x);
      uniform += w * squared_distance(x, site);
    }
  const PieceEnergy exact = cvt_piece(p, rho, site);
  EXPECT_NEAR(exact.energy, sum.energy, 1e-5);
  EXPECT_LT(length(exact.gradient - sum.gradient), 1e-5);
  EXPECT_NEAR(cvt_piece(p, site).energy, uniform, 1e-5);
}

}  // namespace
}  // namespace nonobtuse::energy
