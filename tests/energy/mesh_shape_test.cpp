// Shape energies of a triangle: gradients by finite differences, values where they are known.
#include "energy/mesh_shape.h"

#include <gtest/gtest.h>

#include <cmath>

#include "numeric/random.h"

namespace nonobtuse {
namespace {

using energy::ShapeWeights;
using Corners = std::array<Vec3, 3>;

double value(const Corners& p, const ShapeWeights& w) {
  return energy::triangle_shape(energy::squared_edges(p[0], p[1], p[2]), w);
}

Corners random_triangle(std::uint64_t seed) {
  numeric::Random random(7, seed);
  Corners p{Vec3{0, 0, 0}, Vec3{1, 0, 0}, Vec3{0.5, 0.8, 0}};
  for (Vec3& x : p)
    x += 0.25 * Vec3{random.uniform() - 0.5, random.uniform() - 0.5, random.uniform() - 0.5};
  return p;
}

class ShapeGradient : public ::testing::TestWithParam<ShapeWeights> {};

TEST_P(ShapeGradient, AgreesWithFiniteDifferences) {
  const ShapeWeights w = GetParam();
  const double step = 1e-6;
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    const Corners p = random_triangle(seed);
    Corners gradient;
    const double e = energy::triangle_shape(p[0], p[1], p[2], w, gradient);
    EXPECT_DOUBLE_EQ(e, value(p, w));
    for (int c = 0; c < 3; ++c)
      for (double Vec3::*axis : {&Vec3::x, &Vec3::y, &Vec3::z}) {
        Corners up = p, down = p;
        up[c].*axis += step;
        down[c].*axis -= step;
        const double expected = (value(up, w) - value(down, w)) / (2 * step);
        EXPECT_NEAR(gradient[c].*axis, expected, 1e-6 * (1 + std::abs(expected)));
      }
  }
}

INSTANTIATE_TEST_SUITE_P(Terms, ShapeGradient,
                         ::testing::Values(ShapeWeights{1, 0, 0, 0, 1}, ShapeWeights{0, 1, 0, 0, 1},
                                           ShapeWeights{0, 0, 1, 0.4, 0.6},
                                           energy::hinged(10, 50, 70)));

TEST(ShapeEnergy, CvtOfTheHexagonalLattice) {
  // Second moment of a regular hexagon of unit area: 5 / (18 sqrt 3); two triangles per vertex.
  const double a = 2 / std::sqrt(3.0);
  const double e = energy::triangle_shape({a, a, a}, ShapeWeights{1, 0, 0, 0, 1});
  EXPECT_NEAR(2 * e, 5 / (18 * std::sqrt(3.0)), 1e-14);
}

TEST(ShapeEnergy, CvtIsTheIntegralOverTheVoronoiPieces) {
  const Corners p{Vec3{0, 0, 0}, Vec3{1, 0, 0}, Vec3{0.4, 0.9, 0}};
  double sum = 0;
  const int m = 400;
  for (int i = 0; i < m; ++i)
    for (int j = 0; i + j < m; ++j)
      for (int upper = 0; upper < (i + j + 1 < m ? 2 : 1); ++upper) {
        const double u = (i + (upper ? 2.0 : 1.0) / 3) / m, v = (j + (upper ? 2.0 : 1.0) / 3) / m;
        const Vec3 y = p[0] + u * (p[1] - p[0]) + v * (p[2] - p[0]);
        sum += std::min(squared_distance(y, p[0]),
                        std::min(squared_distance(y, p[1]), squared_distance(y, p[2])));
      }
  const double area = 0.45;
  EXPECT_NEAR(value(p, ShapeWeights{1, 0, 0, 0, 1}), sum * area / (m * m), 1e-5);
}

TEST(ShapeEnergy, CircumcentreTermVanishesOnlyForEquilateralTriangles) {
  const ShapeWeights w{0, 1, 0, 0, 1};
  EXPECT_NEAR(energy::triangle_shape({2, 2, 2}, w), 0, 1e-15);
  // 3-4-5: circumradius 2.5, inradius 1.
  EXPECT_NEAR(energy::triangle_shape({9, 16, 25}, w), 2.5 * 2.5 - 2 * 2.5, 1e-12);
}

TEST(ShapeEnergy, HingeIsZeroInsideTheBounds) {
  ShapeWeights w = energy::hinged(10, 40, 80);
  w.cvt = w.circumcentre = 0;
  EXPECT_EQ(energy::triangle_shape({1, 1.1, 1.2}, w), 0);
  EXPECT_GT(energy::triangle_shape({1, 1, 1.9}, w), 0);
}

TEST(ShapeEnergy, InfiniteWithoutArea) {
  EXPECT_TRUE(std::isinf(energy::triangle_shape({1, 1, 4}, energy::hinged(1, 40, 80))));
  EXPECT_TRUE(std::isinf(energy::triangle_shape({0, 1, 1}, energy::hinged(1, 40, 80))));
}

}  // namespace
}  // namespace nonobtuse
