#include "optimize/lbfgs.h"

#include <gtest/gtest.h>

#include "numeric/random.h"

namespace nonobtuse::optimize {
namespace {

std::vector<Vec3> random_points(int count, std::uint64_t seed) {
  numeric::Random random(seed);
  std::vector<Vec3> points(count);
  for (Vec3& p : points) p = {random.uniform() - 0.5, random.uniform() - 0.5, random.uniform()};
  return points;
}

void scale_by_two(std::span<const Vec3> in, std::span<Vec3> out) {
  for (std::size_t i = 0; i < in.size(); ++i) out[i] = 2 * in[i];
}

TEST(Lbfgs, WithoutPairsThePreconditionerAlone) {
  const auto g = random_points(50, 1);
  std::vector<Vec3> d(50);
  LbfgsHistory().direction(g, d, scale_by_two, parallel::Workers(1));
  for (int i = 0; i < 50; ++i) EXPECT_EQ(d[i], -2.0 * g[i]);
}

TEST(Lbfgs, FulfilsTheSecantEquationOfTheLastPair) {
  const parallel::Workers workers(1);
  LbfgsHistory history(3);
  std::vector<Vec3> s;
  std::vector<Vec3> y;
  for (std::uint64_t k = 0; k < 6; ++k) {
    s = random_points(50, 2 * k);
    y = random_points(50, 2 * k + 1);
    for (int i = 0; i < 50; ++i) y[i] = s[i] + 0.3 * y[i];
    if (!history.add(s, y, workers)) FAIL();
  }
  EXPECT_EQ(history.size(), 3);
  std::vector<Vec3> d(50);
  history.direction(y, d, scale_by_two, workers);
  for (int i = 0; i < 50; ++i) EXPECT_LT(length(d[i] + s[i]), 1e-12);
}

TEST(Lbfgs, DropsNegativeCurvature) {
  const parallel::Workers workers(1);
  LbfgsHistory history;
  const auto s = random_points(5, 1);
  std::vector<Vec3> y(5);
  EXPECT_FALSE(history.add(s, y, workers));
  for (int i = 0; i < 5; ++i) y[i] = -s[i];
  EXPECT_FALSE(history.add(s, y, workers));
  EXPECT_EQ(history.size(), 0);
  EXPECT_TRUE(history.add(s, s, workers));
  history.clear();
  EXPECT_EQ(history.size(), 0);
}

// A convex quadratic whose scales span 1 : 1000, with exact line searches.
TEST(Lbfgs, SolvesAnIllConditionedQuadratic) {
  const parallel::Workers workers(1);
  const int n = 40;
  std::vector<Vec3> x = random_points(n, 3);
  const auto stiffness = [&](int i) { return 1 + 999.0 * i / (n - 1); };
  const auto gradient = [&] {
    std::vector<Vec3> g(n);
    for (int i = 0; i < n; ++i) g[i] = stiffness(i) * x[i];
    return g;
  };
  LbfgsHistory history;
  std::vector<Vec3> g = gradient();
  std::vector<Vec3> d(n);
  const double start = dot(g, g, workers);
  for (int k = 0; k < 80; ++k) {
    history.direction(g, d, scale_by_two, workers);
    const double slope = dot(g, d, workers);
    if (slope == 0) break;
    ASSERT_LT(slope, 0);
    double curvature = 0;
    for (int i = 0; i < n; ++i) curvature += stiffness(i) * squared_length(d[i]);
    std::vector<Vec3> s(n);
    for (int i = 0; i < n; ++i) {
      s[i] = -slope / curvature * d[i];
      x[i] += s[i];
    }
    const std::vector<Vec3> before = g;
    g = gradient();
    std::vector<Vec3> y(n);
    for (int i = 0; i < n; ++i) y[i] = g[i] - before[i];
    history.add(s, y, workers);
  }
  EXPECT_LT(dot(g, g, workers), 1e-10 * start);
}

TEST(Lbfgs, SameBitsForAnyNumberOfThreads) {
  const int n = 10000;
  std::vector<std::vector<Vec3>> results;
  for (const int threads : {1, 2, 5}) {
    const parallel::Workers workers(threads);
    LbfgsHistory history;
    for (std::uint64_t k = 0; k < 3; ++k) {
      const auto s = random_points(n, k);
      auto y = random_points(n, k + 100);
      for (int i = 0; i < n; ++i) y[i] += s[i];
      history.add(s, y, workers);
    }
    std::vector<Vec3> d(n);
    history.direction(random_points(n, 50), d, scale_by_two, workers);
    results.push_back(d);
  }
  EXPECT_EQ(results[0], results[1]);
  EXPECT_EQ(results[0], results[2]);
}

}  // namespace
}  // namespace nonobtuse::optimize
