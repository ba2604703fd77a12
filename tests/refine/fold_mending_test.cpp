// Folds: told from good triangles, and undone without new faults.
#include "refine/fold_mending.h"

#include <gtest/gtest.h>

#include <array>
#include <utility>

#include "refine/crossing_triangles.h"
#include "refine/test_surfaces.h"

namespace nonobtuse {
namespace {

struct Scene {
  explicit Scene(std::uint64_t seed)
      : made(test::make_case(test::torus(80, 32), test::torus(40, 16, 0.2, seed))),
        bvh(made.surface.vertices, made.surface.triangles, workers),
        fidelity(made.surface, bvh),
        test(made.surface) {
    fidelity.weights = {20, 20};
    renew();
  }
  void renew() {
    fidelity.samples = refine::sample_surface(made.surface, 8 * made.mesh.vertex_count());
    fidelity.search_samples(made.mesh, workers);
    fidelity.update_planes(made.mesh, workers, true);
  }
  [[nodiscard]] Index turned_over() const {
    Index count = 0;
    for (Index t = 0; t < made.mesh.triangle_capacity(); ++t)
      count += made.mesh.alive_triangle(t) && test.turned_over(made.mesh, fidelity, t);
    return count;
  }
  [[nodiscard]] std::size_t crossings() const {
    return refine::crossing_triangles(made.mesh, fidelity.knots, workers).size();
  }
  parallel::Workers workers{1};
  test::Case made;
  spatial::TriangleBvh bvh;
  refine::Fidelity fidelity;
  refine::FoldTest test;
};

TEST(FoldTest, TellsFoldsFromGoodTriangles) {
  Scene s(1);
  EXPECT_EQ(s.turned_over(), 0);
  EXPECT_EQ(s.crossings(), 0u);
  const std::array<Index, 1> center{100};
  EXPECT_EQ(s.test.count(refine::Patch(s.made.mesh, s.fidelity, center, 3)), 0);
  // Beyond a neighbour: some of its triangles turn over.
  const Triangle& t = s.made.mesh.triangle(s.made.mesh.triangle_of(100));
  const Vec3 other = s.made.mesh.positions[t[0] == 100 ? t[1] : t[0]];
  s.made.mesh.positions[100] += 1.6 * (other - s.made.mesh.positions[100]);
  s.renew();
  EXPECT_GT(s.turned_over(), 0);
  EXPECT_GT(s.test.count(refine::Patch(s.made.mesh, s.fidelity, center, 3)), 0);
}

TEST(CrossingTriangles, AreFoundWhereASheetPassesThroughAnother) {
  Scene s(1);
  // A vertex pushed through the torus's tube and out on its other side.
  const Vec3 in = -normalized(refine::vertex_area_vector(s.made.mesh, 100));
  const double across = 2 * 0.8 / 2.8 * length(s.made.mesh.positions[0]);
  s.made.mesh.positions[100] += 1.2 * across * in;
  EXPECT_GT(s.crossings(), 0u);
}

TEST(MendFolds, UndoesThemAndKeepsTheRest) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    Scene s(seed);
    // Two neighbours change places, which leaves a tangle.
    const Index a = 100;
    const Triangle& t = s.made.mesh.triangle(s.made.mesh.triangle_of(a));
    const Index b = t[0] == a ? t[1] : t[0];
    std::swap(s.made.mesh.positions[a], s.made.mesh.positions[b]);
    s.renew();
    ASSERT_GT(s.turned_over(), 0);
    refine::TrialOptions options;
    options.goal = {35, 86};
    options.shape = energy::hinged(100, 36, 85);
    const Index count = s.made.mesh.vertex_count();
    EXPECT_GT(refine::mend_folds(s.made.mesh, s.fidelity, options, s.workers, [] { return true; }),
              0);
    EXPECT_EQ(s.turned_over(), 0);
    EXPECT_EQ(s.crossings(), 0u);
    EXPECT_EQ(s.made.mesh.vertex_count(), count);
    EXPECT_EQ(test::euler_characteristic(s.made.mesh), 0);
    EXPECT_EQ(test::bad_valence_count(s.made.mesh), 0);
  }
}

}  // namespace
}  // namespace nonobtuse
