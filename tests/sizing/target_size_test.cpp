// Shape energies in units of the target size: derivative, and where they are at rest.
#include "refine/target_size.h"

#include <gtest/gtest.h>

namespace nonobtuse::refine {
namespace {

const Triangle kTriangle{0, 1, 2};

TargetSize sizes(double a, double b, double c) {
  TargetSize size;
  size.of_vertex = {a, b, c};
  return size;
}

TEST(TargetSize, GradientLikeFiniteDifferences) {
  const TargetSize size = sizes(0.2, 0.3, 0.25);
  const energy::ShapeWeights weights = energy::hinged(10, 50, 70);
  const std::array<Vec3, 3> p{Vec3{0, 0, 0.1}, Vec3{0.3, 0, 0}, Vec3{0.1, 0.2, 0}};
  std::array<Vec3, 3> gradient;
  EXPECT_NEAR(size.shape(kTriangle, p, weights, gradient), size.shape(kTriangle, p, weights),
              1e-12);
  const double step = 1e-6;
  for (int k = 0; k < 3; ++k)
    for (const Vec3& d : {Vec3{step, 0, 0}, Vec3{0, step, 0}, Vec3{0, 0, step}}) {
      std::array<Vec3, 3> above = p, below = p;
      above[k] += d;
      below[k] -= d;
      const double slope =
          (size.shape(kTriangle, above, weights) - size.shape(kTriangle, below, weights)) /
          (2 * step);
      EXPECT_NEAR(dot(gradient[k], d) / step, slope, 1e-6 * (1 + std::abs(slope)));
    }
}

// An equilateral triangle of half the target area per vertex is at rest, whatever the target.
TEST(TargetSize, TheRightTriangleIsAtRest) {
  for (const double s : {0.01, 1.0, 30.0}) {
    const double edge = s * std::sqrt(2 / std::sqrt(3.0));
    const std::array<Vec3, 3> p{Vec3{0, 0, 0}, Vec3{edge, 0, 0},
                                Vec3{0.5 * edge, 0.5 * std::sqrt(3.0) * edge, 0}};
    std::array<Vec3, 3> gradient;
    sizes(s, s, s).shape(kTriangle, p, energy::hinged(10, 40, 80), gradient);
    for (const Vec3& g : gradient) EXPECT_LT(length(g) * s, 1e-12);
  }
}

TEST(TargetSize, UniformIsTheShapeEnergyItself) {
  const std::array<Vec3, 3> p{Vec3{0, 0, 0}, Vec3{1, 0, 0}, Vec3{0.4, 0.8, 0}};
  const energy::ShapeWeights weights = energy::hinged(10, 50, 70);
  EXPECT_EQ(TargetSize{}.shape(kTriangle, p, weights),
            energy::triangle_shape(energy::squared_edges(p[0], p[1], p[2]), weights));
}

}  // namespace
}  // namespace nonobtuse::refine
