// A knot more or less on a curve: all sectors change together and stay manifolds.
#include "refine/curve_edits.h"

#include <gtest/gtest.h>

#include "refine/cut_surfaces.h"
#include "refine/patch.h"

namespace nonobtuse {
namespace {

struct Scene {
  test::CutCase cut = test::cut_cube(6, 0.3);
  parallel::Workers workers{1};
  spatial::TriangleBvh bvh{cut.made.surface.vertices, cut.made.surface.triangles, workers};
  refine::Fidelity fidelity{cut.made.surface, bvh};
  mesh::EditableMesh& mesh = cut.made.mesh;

  Scene() {
    fidelity.attach_curves(mesh, &cut.curves, workers);
    fidelity.samples = refine::sample_surface(cut.made.surface, 4 * mesh.vertex_count());
    fidelity.search_samples(mesh, workers);
    fidelity.update_planes(mesh, workers);
  }

  // Every sample belongs to one triangle alive, every vertex and triangle has its entries.
  void check() {
    EXPECT_NO_THROW(mesh.check_invariants());
    EXPECT_EQ(test::euler_characteristic(mesh), 6);
    EXPECT_EQ(fidelity.vertex_planes.size(), mesh.positions.size());
    EXPECT_EQ(fidelity.patches.of_vertex.size(), mesh.positions.size());
    EXPECT_EQ(fidelity.first.size(), mesh.triangles().size());
    std::size_t samples = 0;
    for (Index t = 0; t < mesh.triangle_capacity(); ++t)
      for (Index s = fidelity.first[t]; s >= 0; s = fidelity.samples[s].next) {
        EXPECT_TRUE(mesh.alive_triangle(t));
        ++samples;
      }
    EXPECT_EQ(samples, fidelity.samples.size());
    for (Index k = 0; k < static_cast<Index>(fidelity.knots.all.size()); ++k) {
      const refine::SlidingKnot& knot = fidelity.knots.all[k];
      for (const Index v : knot.copies) {
        EXPECT_TRUE(mesh.alive_vertex(v));
        EXPECT_EQ(mesh.knot[v], k);
        EXPECT_EQ(mesh.positions[v], mesh.positions[knot.copies.front()]);
      }
      if (knot.copies.empty()) continue;
      if (knot.before >= 0) {
        EXPECT_EQ(fidelity.knots.all[knot.before].after, k);
        EXPECT_LT(fidelity.knots.all[knot.before].place.arc, knot.place.arc);
        EXPECT_EQ(refine::curve_sides(mesh, fidelity.knots, knot.copies.front(),
                                      fidelity.knots.all[knot.before].copies.front())
                      .size(),
                  2U);
      }
    }
  }
};

TEST(CurveEdits, RandomSplitsAndCollapsesKeepAllSectorsTogether) {
  Scene s;
  numeric::Random random(3);
  int splits = 0, collapses = 0;
  for (int step = 0; step < 300; ++step) {
    const Index k = static_cast<Index>(random.below(s.fidelity.knots.all.size()));
    if (s.fidelity.knots.all[k].copies.empty()) continue;
    const Index v = s.fidelity.knots.all[k].copies.front();
    std::vector<Index> ring;
    s.mesh.neighbors(v, ring);
    const Index u = random.below(2) ? ring.front() : ring.back();
    const Index count = s.mesh.vertex_count();
    if (random.below(2)) {
      if (!refine::can_split_curve(s.mesh, s.fidelity.knots, v, u)) continue;
      EXPECT_EQ(refine::split_curve(s.mesh, s.fidelity, v, u).size(), 2U);
      EXPECT_EQ(s.mesh.vertex_count(), count + 2);
      ++splits;
    } else {
      if (!refine::can_collapse_curve(s.mesh, s.fidelity.knots, v, u)) continue;
      refine::collapse_curve(s.mesh, s.fidelity, v, u);
      EXPECT_EQ(s.mesh.vertex_count(), count - 2);
      ++collapses;
    }
    if (step % 10 == 0) s.check();
  }
  s.check();
  EXPECT_GT(splits, 10);
  EXPECT_GT(collapses, 10);
}

TEST(CurveEdits, CornersStay) {
  Scene s;
  for (Index k = 0; k < 8; ++k) {
    const Index v = s.fidelity.knots.all[k].copies.front();
    std::vector<Index> ring;
    s.mesh.neighbors(v, ring);
    for (const Index u : ring)
      EXPECT_FALSE(refine::can_collapse_curve(s.mesh, s.fidelity.knots, v, u));
  }
}

TEST(CurveEdits, APatchReplaysThemOnTheWholeMesh) {
  Scene s;
  const Index v = s.fidelity.knots.all[10].copies.front();
  const Index count = s.mesh.vertex_count();
  const std::array<Index, 1> center{v};
  for (const auto kind : {refine::Edit::Kind::SplitCurve, refine::Edit::Kind::CollapseCurve}) {
    refine::Patch patch(s.mesh, s.fidelity, center, 2);
    std::vector<Index> ring;
    patch.mesh.neighbors(patch.local(v), ring);
    const refine::Edit edit{kind, patch.local(v), ring.front()};
    ASSERT_TRUE(patch.possible(edit));
    patch.apply_with_samples(edit);
    patch.commit(s.mesh, s.fidelity);
    s.check();
  }
  EXPECT_EQ(s.mesh.vertex_count(), count);
}

}  // namespace
}  // namespace nonobtuse
