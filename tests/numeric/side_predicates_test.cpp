// The predicates against unlimited integers, with the infinitesimals replaced by tiny weights.
#include "numeric/side_predicates.h"

#include <gtest/gtest.h>

#include <boost/multiprecision/cpp_int.hpp>

#include "numeric/random.h"

namespace {

using namespace nonobtuse;
using namespace nonobtuse::numeric;
using Integer = boost::multiprecision::cpp_int;

constexpr int kNext[3] = {1, 2, 0};
constexpr int kPrevious[3] = {2, 0, 1};

struct Oracle {
  std::array<Vec3, 3> vertices;
  std::vector<Vec3> sites;

  // (d_i(v) - e_i) * 2^1306, with e_i = 2^(-300 (i + 1)) * 2^-106: far below every product of
  // three differences here. Coordinates are multiples of 2^-53.
  Integer weighted(int i, int k) const {
    const auto square = [](double a, double b) {
      const Integer d = Integer(a * 0x1p53) - Integer(b * 0x1p53);
      return Integer(d * d);
    };
    const Vec3& v = vertices[k];
    const Vec3& x = sites[i];
    const Integer d = square(v.x, x.x) + square(v.y, x.y) + square(v.z, x.z);
    return (d << 1200) - (Integer(1) << (1200 - 300 * (i + 1)));
  }
  std::array<Integer, 3> line(int i, Side s) const {
    std::array<Integer, 3> l{0, 0, 0};
    if (is_edge(s)) {
      l[edge_of(s)] = -1;
    } else {
      for (int k = 0; k < 3; ++k) l[k] = weighted(i, k) - weighted(s, k);
    }
    return l;
  }
  // The corner's homogeneous coordinates; all zero where the two lines do not cross so that the
  // corner can be one of a counter-clockwise piece inside the facet.
  std::array<Integer, 3> corner(int i, Side before, Side after) const {
    const auto a = line(i, before);
    const auto b = line(i, after);
    std::array<Integer, 3> w;
    for (int k = 0; k < 3; ++k)
      w[k] = a[kNext[k]] * b[kPrevious[k]] - a[kPrevious[k]] * b[kNext[k]];
    for (int k = 0; k < 3; ++k)
      if (w[k] < 0) return {0, 0, 0};
    return w;
  }
};

// Coordinates on a small grid give ties of every kind; others are random.
double coordinate(Random& random, bool grid) {
  return grid ? static_cast<double>(random.below(5)) * 0.25 : random.uniform();
}

int compare_with_oracle(bool grid, std::uint64_t seed, int rounds) {
  Random random(seed);
  int compared = 0;
  for (int round = 0; round < rounds; ++round) {
    const auto point = [&] {
      return Vec3{coordinate(random, grid), coordinate(random, grid), coordinate(random, grid)};
    };
    Oracle oracle{{point(), point(), point()}, {point(), point(), point(), point()}};
    if (round % 5 == 0) oracle.sites[2] = oracle.sites[1];        // coincident
    if (round % 7 == 0) oracle.vertices[2] = oracle.vertices[0];  // no area
    const std::vector<Index> candidates{0, 1, 2, 3};
    SidePredicates predicates;
    predicates.reset(oracle.vertices, oracle.sites, candidates);
    for (int i = 0; i < 4; ++i)
      for (Side before = -3; before < 4; ++before)
        for (Side after = -3; after < 4; ++after) {
          if (before == after || before == i || after == i) continue;
          const bool vertex = is_edge(before) && is_edge(after);
          if (vertex && edge_of(after) != kNext[edge_of(before)]) continue;
          const auto w = oracle.corner(i, before, after);
          if (w[0] + w[1] + w[2] == 0) continue;
          const Corner c = predicates.corner(i, before, after);
          for (int j = 0; j < 4; ++j) {
            if (j == i || j == before || j == after) continue;
            const auto l = oracle.line(i, j);
            const Integer value = w[0] * l[0] + w[1] * l[1] + w[2] * l[2];
            const int expected = value > 0 ? 1 : -1;
            EXPECT_NE(value, 0);
            EXPECT_EQ(predicates.side(i, c, j), expected);
            EXPECT_EQ(predicates.exact_side(i, before, after, j), expected);
            if (::testing::Test::HasFailure()) return compared;
            ++compared;
          }
        }
  }
  return compared;
}

TEST(SidePredicates, AgreeWithIntegersOnRandomInput) {
  EXPECT_GT(compare_with_oracle(false, 1, 40), 1000);
}

TEST(SidePredicates, AgreeWithPerturbedIntegersOnTies) {
  EXPECT_GT(compare_with_oracle(true, 2, 300), 5000);
}

// Of the corner and the four sites exactly one is nearest, whichever cell asks: a total order.
TEST(SidePredicates, TiesGoToTheLowerIndex) {
  const std::array<Vec3, 3> vertices{Vec3{0, 0, 0}, Vec3{1, 0, 0}, Vec3{0, 1, 0}};
  const std::vector<Vec3> sites(3, Vec3{0.25, 0.25, 0});
  const std::vector<Index> candidates{0, 1, 2};
  SidePredicates predicates;
  predicates.reset(vertices, sites, candidates);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      if (i != j) {
        const Corner c = predicates.corner(i, edge_side(1), edge_side(2));
        EXPECT_EQ(predicates.side(i, c, j), i < j ? -1 : 1);
      }
}

}  // namespace
