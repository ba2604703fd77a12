// The CVT energy with a density: sums, derivative, and its own meaning by brute force.
#include <gtest/gtest.h>

#include "energy/cvt.h"
#include "numeric/random.h"
#include "rvd/cell_integrals.h"
#include "rvd/facet_clipping.h"
#include "sizing/sized_surfaces.h"

namespace nonobtuse::sizing {
namespace {

mesh::Surface graded_sphere(double ratio, double half_width) {
  mesh::Surface s = rvd::test::octasphere(3);
  test::set_sizes(s, test::steep_field(s.vertices, ratio, -half_width, half_width));
  return s;
}

double integral_of_density(const rvd::FacetPieces& pieces) {
  double sum = 0;
  for (Index p = 0; p < pieces.count(); ++p) {
    const std::array<double, 3> rho = pieces.density_of(p);
    sum += pieces.area[p] * (rho[0] + rho[1] + rho[2]) / 3;
  }
  return sum;
}

double energy(const mesh::Surface& s, const std::vector<Vec3>& sites, rvd::CellIntegrals& cells) {
  const parallel::Workers workers(1);
  rvd::CellEvaluator(s, static_cast<Index>(sites.size()), workers).evaluate(sites, cells);
  return cells.energy;
}

TEST(WeightedCells, MassesAddUpToTheIntegralOfTheDensity) {
  for (const double ratio : {3.0, 100.0}) {
    const mesh::Surface s = graded_sphere(ratio, 0.2);
    const std::vector<Vec3> sites = rvd::test::random_sites(s, 300, 1);
    rvd::CellIntegrals cells;
    energy(s, sites, cells);
    double mass = 0;
    for (const double m : cells.mass) mass += m;
    const double whole = integral_of_density(rvd::facet_pieces(s, 300));
    EXPECT_NEAR(mass, whole, 1e-11 * whole);
  }
}

TEST(WeightedCells, GradientLikeFiniteDifferences) {
  const mesh::Surface s = graded_sphere(10, 0.3);
  std::vector<Vec3> sites = rvd::test::random_sites(s, 200, 2);
  const parallel::Workers workers(1);
  rvd::CellIntegrals cells;
  energy(s, sites, cells);
  std::vector<Vec3> gradient(sites.size());
  energy::cvt_gradient(sites, cells, gradient, workers);
  double largest = 0;
  for (const Vec3& g : gradient) largest = std::max(largest, length(g));
  const double step = 1e-5;
  for (const std::size_t i : {0, 17, 55, 123, 199})
    for (int axis = 0; axis < 3; ++axis) {
      const Vec3 d{axis == 0 ? step : 0, axis == 1 ? step : 0, axis == 2 ? step : 0};
      const Vec3 at = sites[i];
      rvd::CellIntegrals other;
      sites[i] = at + d;
      const double above = energy(s, sites, other);
      sites[i] = at - d;
      const double below = energy(s, sites, other);
      sites[i] = at;
      EXPECT_NEAR((above - below) / (2 * step), dot(gradient[i], d) / step, 2e-5 * largest);
    }
}

// Whole pieces against the closed form on a triangle with linear density.
TEST(WeightedCells, OneSiteLikeTheClosedForm) {
  const mesh::Surface s = graded_sphere(10, 0.3);
  const Vec3 site{0.3, 0.1, 0.8};
  const rvd::FacetPieces pieces = rvd::facet_pieces(s, 1);
  double expected = 0;
  for (Index p = 0; p < pieces.count(); ++p)
    expected += energy::cvt_piece(pieces.corners_of(p), pieces.density_of(p), site).energy;
  rvd::CellIntegrals cells;
  EXPECT_NEAR(energy(s, {site}, cells), expected, 1e-11 * expected);
}

TEST(WeightedCells, PartsOfATriangleLikeASumOverAFineGrid) {
  const std::array<double, 3> rho{1, 4, 0.5};
  const std::vector<rvd::CornerDistances> d{
      {0.1, 1.0, 0.9}, {0.8, 0.2, 1.1}, {0.9, 0.8, 0.1}, {0.5, 0.5, 0.6}};
  std::vector<rvd::Moments> moments(d.size(), rvd::Moments{0, 0, 0}), rough = moments;
  rvd::FacetClipper clipper;
  clipper.clip(d, rho, moments);
  constexpr int kGrid = 400;
  for (int a = 0; a < kGrid; ++a)
    for (int b = 0; b < kGrid; ++b) {
      const bool upright = a + b < kGrid;
      const double u = upright ? (a + 1 / 3.0) / kGrid : (kGrid - a - 1 / 3.0) / kGrid;
      const double v = upright ? (b + 1 / 3.0) / kGrid : (kGrid - b - 1 / 3.0) / kGrid;
      const std::array<double, 3> w{1 - u - v, u, v};
      const auto at = [&](const std::array<double, 3>& f) {
        return w[0] * f[0] + w[1] * f[1] + w[2] * f[2];
      };
      std::size_t best = 0;
      for (std::size_t i = 1; i < d.size(); ++i)
        if (at(d[i]) < at(d[best])) best = i;
      for (int k = 0; k < 3; ++k) rough[best][k] += at(rho) * w[k] / (kGrid * kGrid);
    }
  for (std::size_t i = 0; i < d.size(); ++i)
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(moments[i][k], rough[i][k], 2e-3) << i << " " << k;
}

// Lists are reused while sites move; fresh ones give the same, whatever the sizes.
TEST(WeightedCells, ReusedListsLikeFreshOnes) {
  const mesh::Surface s = graded_sphere(100, 0.1);
  const parallel::Workers workers(2);
  std::vector<Vec3> sites = rvd::test::random_sites(s, 400, 5);
  rvd::CellEvaluator evaluator(s, 400, workers);
  rvd::CellIntegrals reused, fresh;
  numeric::Random random(9);
  for (int step = 0; step < 12; ++step) {
    for (Vec3& x : sites)
      x += 0.01 * Vec3{random.uniform() - 0.5, random.uniform() - 0.5, random.uniform() - 0.5};
    evaluator.evaluate(sites, reused);
    energy(s, sites, fresh);
    EXPECT_NEAR(reused.energy, fresh.energy, 1e-12 * fresh.energy);
    for (std::size_t i = 0; i < sites.size(); ++i)
      EXPECT_NEAR(reused.mass[i], fresh.mass[i], 1e-11 * (1 + fresh.mass[i])) << step << " " << i;
  }
}

}  // namespace
}  // namespace nonobtuse::sizing
