// The penalties of the obtuse removal: gradients by finite differences, and what mathematics says
// about their minima and scaling.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

#include "energy/short_dual_penalty.h"
#include "energy/triangle_penalties.h"
#include "numeric/random.h"
#include "numeric/vec3.h"

namespace nonobtuse::energy {
namespace {

constexpr double degree = std::numbers::pi / 180;

// A regular triangulation of a patch, jittered by `noise` times its edge length 1, in space.
struct Patch {
  std::vector<Vec3> sites;
  std::vector<Triangle> triangles;
  std::vector<rvd::DualEdge> edges;
  std::vector<Vec3> normals;
};

Patch jittered_patch(int rows, double noise, std::uint64_t seed) {
  Patch p;
  for (int r = 0; r < rows; ++r)
    for (int c = 0; c < rows; ++c) {
      numeric::Random random(seed, static_cast<std::uint64_t>(r * rows + c));
      const auto jitter = [&] { return noise * (random.uniform() - 0.5); };
      const double x = c + 0.5 * r + jitter();
      const double y = 0.5 * std::numbers::sqrt3 * r + jitter();
      p.sites.push_back({x, y, jitter()});
      p.normals.push_back(normalized(Vec3{jitter(), jitter(), 1}));
    }
  const auto id = [&](int r, int c) { return static_cast<Index>(r * rows + c); };
  const auto add_edge = [&](Index i, Index j) {
    numeric::Random random(seed + 1, p.edges.size());
    p.edges.push_back(
        {i, j, std::max(0.0, 1 / std::numbers::sqrt3 + noise * (random.uniform() - 0.5))});
  };
  for (int r = 0; r < rows; ++r)
    for (int c = 0; c < rows; ++c) {
      if (c + 1 < rows) add_edge(id(r, c), id(r, c + 1));
      if (r + 1 < rows) add_edge(id(r, c), id(r + 1, c));
      if (r + 1 < rows && c > 0) add_edge(id(r, c), id(r + 1, c - 1));
      if (r + 1 < rows && c + 1 < rows) {
        p.triangles.push_back({id(r, c), id(r, c + 1), id(r + 1, c)});
        p.triangles.push_back({id(r, c + 1), id(r + 1, c + 1), id(r + 1, c)});
      }
    }
  return p;
}

std::vector<double> ones(const Patch& p) { return std::vector<double>(p.sites.size(), 1); }

std::vector<double> scales(const Patch& p) {  // as with a density: one for each site
  std::vector<double> s;
  for (std::size_t i = 0; i < p.sites.size(); ++i) s.push_back(0.5 + 0.01 * static_cast<double>(i));
  return s;
}

// An energy that adds its gradient and diagonal and returns its value.
using Energy = std::function<double(std::span<const Vec3>, std::span<Vec3>, std::span<double>)>;

void expect_gradient_matches_differences(const std::vector<Vec3>& sites, const Energy& energy) {
  std::vector<Vec3> gradient(sites.size());
  std::vector<double> diagonal(sites.size(), 0);
  energy(sites, gradient, diagonal);
  double scale = 0;
  for (const Vec3& g : gradient) scale = std::max(scale, length(g));
  ASSERT_GT(scale, 0);
  std::vector<Vec3> unused(sites.size());
  const double step = 1e-6;
  for (std::size_t i = 0; i < sites.size(); i += 5) {
    for (double Vec3::*axis : {&Vec3::x, &Vec3::y, &Vec3::z}) {
      std::vector<Vec3> moved = sites;
      moved[i].*axis += step;
      const double above = energy(moved, unused, diagonal);
      moved[i].*axis -= 2 * step;
      const double below = energy(moved, unused, diagonal);
      EXPECT_NEAR((above - below) / (2 * step), gradient[i].*axis, 1e-6 * scale) << "site " << i;
    }
  }
}

TEST(ShortDualPenalty, GradientWithFrozenWeights) {
  const Patch p = jittered_patch(8, 0.3, 1);
  const std::vector<double> w = short_dual_weights(p.sites, p.edges, 0.1);
  for (const bool tangential : {false, true})
    expect_gradient_matches_differences(p.sites, [&](auto x, auto g, auto d) {
      return add_short_dual_penalty(x, p.edges, w, tangential ? p.normals : std::vector<Vec3>{},
                                    scales(p), g, d);
    });
}

TEST(ShortDualPenalty, DiagonalIsTheExactSecondDerivative) {
  const Patch p = jittered_patch(8, 0.3, 2);
  const std::vector<double> w = short_dual_weights(p.sites, p.edges, 0.1);
  std::vector<Vec3> g(p.sites.size());
  std::vector<double> d(p.sites.size(), 0);
  const double at = add_short_dual_penalty(p.sites, p.edges, w, {}, scales(p), g, d);
  for (std::size_t i = 0; i < p.sites.size(); i += 7) {
    std::vector<Vec3> moved = p.sites;
    std::vector<Vec3> unused_g(p.sites.size());
    std::vector<double> unused_d(p.sites.size());
    moved[i].y += 1;  // R is quadratic: its expansion is exact for any step
    const double there =
        add_short_dual_penalty(moved, p.edges, w, {}, scales(p), unused_g, unused_d);
    EXPECT_NEAR(there - at - g[i].y, 0.5 * d[i], 1e-9 * d[i]);
  }
}

TEST(ShortDualPenalty, VanishesInsideRegularTriangulationAndGrowsWithShortDuals) {
  Patch p = jittered_patch(7, 0, 3);
  const auto at_centre = [&] {  // |r_i|^2 shows as half the gradient's own-site part: measure R
    const std::vector<double> w = short_dual_weights(p.sites, p.edges, 0.1);
    std::vector<Vec3> g(p.sites.size());
    std::vector<double> d(p.sites.size(), 0);
    return add_short_dual_penalty(p.sites, p.edges, w, {}, ones(p), g, d);
  };
  const double regular = at_centre();  // from the patch's rim alone
  const Index centre = 3 * 7 + 3;
  for (rvd::DualEdge& e : p.edges)
    if (e.site == centre || e.other == centre) {
      e.length *= 0.1;
      break;
    }
  EXPECT_GT(at_centre(), regular + 1);
}

TEST(ShortDualPenalty, TangentialPartIgnoresCurvature) {
  // A site lifted off a regular patch along the normals: r points along them.
  Patch p = jittered_patch(7, 0, 4);
  for (Vec3& x : p.sites) x.z = 0.05 * (x.x * x.x + x.y * x.y);
  const std::vector<Vec3> up(p.sites.size(), Vec3{0, 0, 1});
  const std::vector<double> w = short_dual_weights(p.sites, p.edges, 0.1);
  std::vector<Vec3> g(p.sites.size());
  std::vector<double> d(p.sites.size(), 0);
  add_short_dual_penalty(p.sites, p.edges, w, up, ones(p), g, d);
  for (const Vec3& v : g) EXPECT_EQ(v.z, 0);
}

TEST(ShortDualPenalty, WeightsAreBoundedAndScaleFree) {
  Patch p = jittered_patch(7, 0.3, 5);
  p.edges[4].length = 0;
  const std::vector<double> w = short_dual_weights(p.sites, p.edges, 0.1);
  EXPECT_DOUBLE_EQ(w[4], 10);
  for (const double x : w) EXPECT_TRUE(x > 0 && x <= 10 * (1 + 1e-12));
  for (Vec3& x : p.sites) x *= 1e-6;
  for (rvd::DualEdge& e : p.edges) e.length *= 1e-6;
  const std::vector<double> small = short_dual_weights(p.sites, p.edges, 0.1);
  for (std::size_t e = 0; e < w.size(); ++e) EXPECT_NEAR(small[e], w[e], 1e-12 * w[e]);
  p.sites[p.edges[0].site] = p.sites[p.edges[0].other];
  p.edges[0].length = 0;
  EXPECT_EQ(short_dual_weights(p.sites, p.edges, 0.1)[0], 0);
}

TEST(TrianglePenalties, Gradient) {
  const Patch p = jittered_patch(8, 0.7, 6);
  const ShapeWeights both{0, 0.3, 0.7, cos_degrees(70), cos_degrees(50)};
  for (const ShapeWeights& weights :
       {both, ShapeWeights{0, 0.3, 0, 0, 1}, ShapeWeights{0, 0, 0.7, both.cos_largest, 0.6}})
    expect_gradient_matches_differences(p.sites, [&](auto x, auto g, auto d) {
      return add_triangle_penalties(x, p.triangles, weights, g, d);
    });
}

TEST(TrianglePenalties, CircumcentreTermIsTheSquaredDistanceOfTheCentres) {
  // Right triangle 3-4-5: incentre (1, 1), circumcentre (1.5, 2), Rc = 2.5, ri = 1.
  const std::vector<Vec3> x{{0, 0, 0}, {3, 0, 0}, {0, 4, 0}};
  const std::vector<Triangle> t{{0, 1, 2}};
  std::vector<Vec3> g(3);
  std::vector<double> d(3, 0);
  EXPECT_NEAR(add_triangle_penalties(x, t, {0, 2, 0, 0, 1}, g, d), 2 * 1.25, 1e-12);
  EXPECT_NEAR(d[0], 2 * 2 * (1 + 2.5 / 2), 1e-12);
}

TEST(TrianglePenalties, GoodTrianglesFeelNoHinge) {
  const auto energy = [&](double a, double b) {  // angles at the first two corners, degrees
    const double ta = std::tan(a * degree);
    const double tb = std::tan(b * degree);
    const double x = tb / (ta + tb);
    const std::vector<Vec3> corners{{0, 0, 0}, {1, 0, 0}, {x, x * ta, 0}};
    std::vector<Vec3> g(3);
    std::vector<double> d(3, 0);
    const double e =
        add_triangle_penalties(corners, std::vector<Triangle>{{0, 1, 2}},
                               {0, 0, 3, std::cos(86 * degree), std::cos(35 * degree)}, g, d);
    for (int k = 0; k < 3; ++k) {
      EXPECT_EQ(e == 0, g[k] == Vec3{});
      EXPECT_EQ(e == 0, d[k] == 0);
    }
    return e;
  };
  EXPECT_EQ(energy(36, 85), 0);
  EXPECT_EQ(energy(60, 60), 0);
  EXPECT_EQ(energy(72, 72), 0);
  EXPECT_NEAR(energy(50, 88), 3 * std::pow(std::cos(88 * degree) - std::cos(86 * degree), 2),
              1e-12);
  EXPECT_NEAR(energy(70, 80), 3 * std::pow(std::cos(30 * degree) - std::cos(35 * degree), 2),
              1e-12);
}

TEST(TrianglePenalties, TrianglesWithoutAreaAreLeftOut) {
  std::vector<Vec3> g(3);
  std::vector<double> d(3, 0);
  for (const Vec3& third : {Vec3{0, 0, 0}, Vec3{0.3, 0, 0}, Vec3{2, 0, 0}, Vec3{0.3, 1e-300, 0}}) {
    const std::vector<Vec3> x{{0, 0, 0}, {1, 0, 0}, third};
    EXPECT_EQ(add_triangle_penalties(x, std::vector<Triangle>{{0, 1, 2}}, {0, 1, 0, 0, 1}, g, d),
              0);
  }
  for (int k = 0; k < 3; ++k) EXPECT_TRUE(is_finite(g[k]) && std::isfinite(d[k]));
}

}  // namespace
}  // namespace nonobtuse::energy
