// Fields of target lengths: local feature size where the medial axis is known, curvature where it
// is known, the bound on gradation, and the number of vertices a field asks for.
#include <gtest/gtest.h>

#include <limits>

#include "sizing/curvature.h"
#include "sizing/gradation.h"
#include "sizing/local_feature_size.h"
#include "sizing/sized_surfaces.h"
#include "sizing/target_length.h"

namespace nonobtuse::sizing {
namespace {

using test::sphere;
using test::surface_of;

TEST(LocalFeatureSize, OfASphereIsItsRadius) {
  const mesh::Surface s = surface_of(sphere(5));
  for (const double lfs : local_feature_size(s, 10'000, parallel::Workers(1)))
    EXPECT_NEAR(lfs, 1, 0.06);
}

// Tube radius 0.2 around a circle of radius 0.7: the tube's core is nearer than the axis in the
// hole, 0.5 away at its nearest.
TEST(LocalFeatureSize, OfATorusIsTheTubesRadius) {
  const double small = 0.2;
  TriangleMesh torus;
  constexpr int kAround = 160, kTube = 64;
  for (int i = 0; i < kAround; ++i)
    for (int j = 0; j < kTube; ++j) {
      const double a = 2 * M_PI * i / kAround, b = 2 * M_PI * j / kTube;
      const double r = 0.7 + small * std::cos(b);
      torus.vertices.push_back({r * std::cos(a), r * std::sin(a), small * std::sin(b)});
      const auto at = [&](int u, int v) {
        return static_cast<Index>((u % kAround) * kTube + v % kTube);
      };
      torus.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      torus.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  const std::vector<double> lfs =
      local_feature_size(surface_of(torus), 20'000, parallel::Workers(1));
  for (const double l : lfs) EXPECT_NEAR(l, small, 0.05 * small);
}

// A box of 2 x 2 x 0.1: half the thickness away from its edges, towards nothing at them.
TEST(LocalFeatureSize, OfASlabIsHalfItsThickness) {
  TriangleMesh box;
  box.vertices = rvd::test::cube().vertices;
  box.triangles = rvd::test::cube().triangles;
  for (Vec3& v : box.vertices) v = {2 * v.x, 2 * v.y, 0.1 * v.z};
  // The field lives at vertices: some in the middle of the large faces.
  for (int level = 0; level < 5; ++level) {
    TriangleMesh finer;
    for (const Triangle& t : box.triangles) {
      const Vec3 p = box.vertices[t[0]], q = box.vertices[t[1]], r = box.vertices[t[2]];
      const auto first = static_cast<Index>(finer.vertices.size());
      for (const Vec3& v : {p, q, r, 0.5 * (q + r), 0.5 * (r + p), 0.5 * (p + q)})
        finer.vertices.push_back(v);
      for (const Triangle& f : {Triangle{0, 5, 4}, {5, 1, 3}, {4, 3, 2}, {3, 4, 5}})
        finer.triangles.push_back({first + f[0], first + f[1], first + f[2]});
    }
    box = finer;
  }
  const mesh::Surface s = surface_of(box);  // triangles not joined: no matter to the medial axis
  const std::vector<double> lfs = local_feature_size(s, 40'000, parallel::Workers(1));
  int middle = 0;
  for (std::size_t v = 0; v < lfs.size(); ++v) {
    const Vec3 p = s.vertices[v];
    const double edge = std::min({p.x, 2 - p.x, p.y, 2 - p.y});
    if (edge < 0.2) continue;
    ++middle;
    EXPECT_NEAR(lfs[v], 0.05, 0.01);
  }
  EXPECT_GT(middle, 100);
}

TEST(LocalFeatureSize, SameBitsForAnyNumberOfThreads) {
  const mesh::Surface s = surface_of(shapes::torus(40, 24));
  EXPECT_EQ(local_feature_size(s, 5000, parallel::Workers(1)),
            local_feature_size(s, 5000, parallel::Workers(3)));
}

TEST(Curvature, OfASphereIsTheInverseRadius) {
  TriangleMesh ball = sphere(5);
  for (Vec3& v : ball.vertices) v = 2.5 * v;
  for (const double k : largest_curvature(surface_of(ball), 0.5, parallel::Workers(1)))
    EXPECT_NEAR(k, 1 / 2.5, 0.03);
}

TEST(Gradation, IsBoundedAlongEveryEdgeAndLowersNoMoreThanNeeded) {
  const TriangleMesh mesh = sphere(4);
  const mesh::Surface s = surface_of(mesh);
  const std::vector<double> wanted = test::steep_field(mesh.vertices, 100, -0.1, 0.1);
  for (const double g : {0.1, 0.25, 2.0}) {
    std::vector<double> h = wanted;
    limit_gradation(s, g, h);
    for (const Triangle& t : s.triangles)
      for (int k = 0; k < 3; ++k) {
        const Index a = t[k], b = t[mesh::next(k)];
        EXPECT_LE(h[a], h[b] + g * distance(s.vertices[a], s.vertices[b]) + 1e-12);
      }
    // Every value is its own or that of a neighbour's bound: the largest such field.
    std::vector<double> tightest(h.size(), std::numeric_limits<double>::infinity());
    for (const Triangle& t : s.triangles)
      for (int k = 0; k < 3; ++k)
        for (const Index b : {t[mesh::next(k)], t[mesh::previous(k)]})
          tightest[t[k]] =
              std::min(tightest[t[k]], h[b] + g * distance(s.vertices[t[k]], s.vertices[b]));
    for (std::size_t v = 0; v < h.size(); ++v)
      EXPECT_DOUBLE_EQ(h[v], std::min(wanted[v], tightest[v]));
  }
}

TEST(Density, AConstantFieldAsksForARegularTriangulation) {
  const mesh::Surface s = surface_of(sphere(3));
  const std::vector<double> h(s.vertices.size(), 0.1);
  EXPECT_NEAR(vertices_for(s, h), s.area * 2 / std::sqrt(3.0) / 0.01, 1e-9);
}

TEST(Density, ScaledFieldsAskForTheVerticesWantedAndKeepTheBound) {
  const TriangleMesh mesh = sphere(4);
  const mesh::Surface s = surface_of(mesh);
  std::vector<double> h = test::steep_field(mesh.vertices, 30, -0.1, 0.1);
  scale_to_vertices(s, 5000, 0.25, h);
  EXPECT_NEAR(vertices_for(s, h), 5000, 1e-6 * 5000);
  for (const Triangle& t : s.triangles)
    for (int k = 0; k < 3; ++k) {
      const Index a = t[k], b = t[mesh::next(k)];
      EXPECT_LE(h[a], h[b] + 0.2505 * distance(s.vertices[a], s.vertices[b]));
    }
}

// Its features and curvature are the same everywhere.
TEST(TargetLength, OfASphereIsNearlyConstant) {
  const mesh::Surface s = surface_of(sphere(4));
  for (const Sizing sizing : {Sizing::LocalFeatureSize, Sizing::Curvature}) {
    const std::vector<double> h = target_lengths(s, sizing, {}, 500, 0.25, parallel::Workers(1));
    const auto [least, most] = std::minmax_element(h.begin(), h.end());
    EXPECT_LT(*most / *least, 1.1);
    EXPECT_NEAR(vertices_for(s, h), 500, 1e-3);
  }
}

}  // namespace
}  // namespace nonobtuse::sizing
