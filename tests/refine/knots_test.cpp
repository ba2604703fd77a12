// Knots on feature curves: one unknown for all copies, in order along the curve, in place.
#include "refine/knots.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>

#include "refine/crossing_triangles.h"
#include "refine/cut_surfaces.h"
#include "refine/fidelity.h"
#include "refine/global_descent.h"
#include "refine/relaxation.h"
#include "remesh/refinement.h"
#include "remesh/valence_optimization.h"

namespace nonobtuse {
namespace {

// A cube with bulging faces, so that creases are curved and faces are not flat.
Vec3 bulge(Vec3 p) {
  const Vec3 q = p - Vec3{0.5, 0.5, 0.5};
  return (1.3 - 0.4 * squared_length(q)) * q;
}

struct CutScene {
  test::CutCase cut;
  parallel::Workers workers{1};
  spatial::TriangleBvh bvh;
  refine::Fidelity fidelity;

  explicit CutScene(test::CutCase c)
      : cut(std::move(c)),
        bvh(cut.made.surface.vertices, cut.made.surface.triangles, workers),
        fidelity(cut.made.surface, bvh) {
    fidelity.attach_curves(cut.made.mesh, &cut.curves, workers);
    fidelity.samples = refine::sample_surface(cut.made.surface, 8 * cut.made.mesh.vertex_count());
    fidelity.search_samples(cut.made.mesh, workers);
    fidelity.update_planes(cut.made.mesh, workers);
  }
};

TEST(Knots, NeighboursAreThoseAlongTheCurve) {
  const CutScene s(test::cut_cube(5, 0.3));
  const refine::Knots& knots = s.fidelity.knots;
  for (Index k = 8; k < static_cast<Index>(knots.all.size()); ++k) {
    ASSERT_EQ(knots.all[k].copies.size(), 2U);
    EXPECT_EQ(knots.all[k].before, (k - 8) % 4 == 0 ? -1 : k - 1);
    EXPECT_EQ(knots.all[k].after, (k - 8) % 4 == 3 ? -1 : k + 1);
  }
  for (Index k = 0; k < 8; ++k) EXPECT_EQ(knots.all[k].copies.size(), 3U);
}

TEST(Knots, GradientByTheArcAgreesWithFiniteDifferences) {
  CutScene s(test::cut_cube(6, 0.5, 1, 20, bulge));
  mesh::EditableMesh& mesh = s.cut.made.mesh;
  refine::GlobalDescent descent(mesh, s.fidelity, false, s.workers);
  descent.shape = energy::hinged(10, 50, 75);
  descent.freeze();
  std::vector<Vec3> gradient, ignored;
  descent.evaluate(gradient);
  const double step = 1e-6;
  int checked = 0;
  for (Index k = 0; k < static_cast<Index>(s.fidelity.knots.all.size()); ++k) {
    const refine::SlidingKnot knot = s.fidelity.knots.all[k];
    const double arc = knot.place.arc;
    if (!knot.slides) {
      for (const Index v : knot.copies) EXPECT_EQ(gradient[v], Vec3{});
      continue;
    }
    const mesh::Curve& curve = s.fidelity.knots.curve(k);
    if (mesh::tangent_at(curve, arc - step) != mesh::tangent_at(curve, arc + step)) continue;
    for (std::size_t c = 1; c < knot.copies.size(); ++c)
      EXPECT_EQ(gradient[knot.copies[c]], Vec3{});
    s.fidelity.knots.move(mesh, k, arc + step);
    const double up = descent.evaluate(ignored);
    s.fidelity.knots.move(mesh, k, arc - step);
    const double down = descent.evaluate(ignored);
    s.fidelity.knots.move(mesh, k, arc);
    const double slope = gradient[knot.copies.front()].x;
    EXPECT_NEAR(slope, (up - down) / (2 * step), 1e-4 * (1 + std::abs(slope)));
    ++checked;
  }
  EXPECT_GT(checked, 40);
}

void expect_in_place(const mesh::EditableMesh& mesh, const mesh::CurveNetwork& curves,
                     const test::CutCase& before) {
  std::map<Index, Vec3> place;
  for (Index v = 0; v < mesh.vertex_capacity(); ++v) {
    const Index k = mesh.knot[v];
    EXPECT_EQ(k >= 0, mesh.on_boundary(v));
    if (k < 0) continue;
    const auto [it, added] = place.try_emplace(k, mesh.positions[v]);
    EXPECT_EQ(it->second, mesh.positions[v]) << "copies apart at knot " << k;
    const mesh::Knot& knot = curves.knots[k];
    if (knot.curve >= 0) {
      EXPECT_LT(distance(mesh.positions[v], mesh::point_at(curves.curves[knot.curve], knot.arc)),
                1e-12);
    }
  }
  // Corners bit for bit; every curve's knots in their order.
  for (Index v = 0; v < before.made.mesh.vertex_capacity(); ++v) {
    const Index k = before.made.mesh.knot[v];
    if (k >= 0 && k < 8) {
      EXPECT_EQ(place.at(k), before.made.mesh.positions[v]);
    }
  }
  for (std::size_t k = 9; k < before.curves.knots.size(); ++k)
    if (place.count(static_cast<Index>(k)) && place.count(static_cast<Index>(k) - 1) &&
        curves.knots[k].curve == curves.knots[k - 1].curve) {
      EXPECT_LT(curves.knots[k - 1].arc, curves.knots[k].arc);
    }
}

TEST(Knots, DescentAndRelaxationKeepThemInPlace) {
  const test::CutCase before = test::cut_cube(6, 0.9, 2, 20, bulge);
  CutScene s(before);
  mesh::EditableMesh& mesh = s.cut.made.mesh;
  refine::GlobalDescent descent(mesh, s.fidelity, false, s.workers);
  descent.shape = energy::hinged(10, 42, 78);
  descent.freeze();
  std::vector<Vec3> gradient;
  double energy = descent.evaluate(gradient);
  descent.run(20, [] { return true; });
  EXPECT_LT(descent.evaluate(gradient), energy);
  s.fidelity.knots.store(s.cut.curves);
  expect_in_place(mesh, s.cut.curves, before);
  std::vector<Index> all;
  for (Index v = 0; v < mesh.vertex_capacity(); ++v) all.push_back(v);
  energy = descent.evaluate(gradient);
  const std::vector<refine::TangentPlane> planes = s.fidelity.vertex_planes;
  refine::relax(mesh, s.fidelity, all, {descent.shape, 3, false}, s.workers);
  s.fidelity.knots.store(s.cut.curves);
  expect_in_place(mesh, s.cut.curves, before);
}

TEST(Knots, CollapsedTrianglesDoNotHoldUpTheDescent) {
  CutScene s(test::cut_cube(6, 0.9, 2, 20, bulge));
  mesh::EditableMesh& mesh = s.cut.made.mesh;
  Index v = 0;
  while (mesh.on_boundary(v) || mesh.knot[v] >= 0) ++v;
  const Index t = mesh.triangle_of(v);
  const int k = mesh.corner_of(t, v);
  mesh.positions[v] = refine::midpoint(refine::corners(mesh, t), k);
  refine::GlobalDescent descent(mesh, s.fidelity, false, s.workers);
  descent.shape = energy::hinged(10, 42, 78);
  descent.freeze();
  std::vector<Vec3> gradient;
  const double energy = descent.evaluate(gradient);
  ASSERT_TRUE(std::isfinite(energy));
  descent.run(10, [] { return true; });
  EXPECT_LT(descent.evaluate(gradient), 0.9 * energy);
}

TEST(Knots, RelaxationOfAKnotLowersTheEnergy) {
  CutScene s(test::cut_cube(6, 0.9, 3, 20, bulge));
  mesh::EditableMesh& mesh = s.cut.made.mesh;
  refine::GlobalDescent descent(mesh, s.fidelity, false, s.workers);
  descent.shape = energy::hinged(10, 42, 78);
  descent.freeze();
  std::vector<Vec3> gradient;
  int moved = 0;
  for (Index k = 8; k < static_cast<Index>(s.fidelity.knots.all.size()); k += 3) {
    const double before = descent.evaluate(gradient), arc = s.fidelity.knots.all[k].place.arc;
    const std::vector<refine::TangentPlane> planes = s.fidelity.vertex_planes;
    const std::vector<double> weights = s.fidelity.vertex_weights;
    refine::relax(mesh, s.fidelity, {s.fidelity.knots.all[k].copies.back()},
                  {descent.shape, 1, false}, s.workers);
    s.fidelity.vertex_planes = planes;
    s.fidelity.vertex_weights = weights;
    EXPECT_LE(descent.evaluate(gradient), before);
    moved += s.fidelity.knots.all[k].place.arc != arc;
  }
  EXPECT_GT(moved, 10);
}

struct CutOutcome {
  test::CutCase cut;
  Index outside = 0;
};

CutOutcome refined(test::CutCase c, int threads = 1) {
  const parallel::Workers workers(threads);
  const Context context;
  parallel::Monitor monitor(context);
  CutOutcome o;
  const spatial::TriangleBvh bvh(c.made.surface.vertices, c.made.surface.triangles, workers);
  pipeline::optimize_valence(c.made.surface, bvh, c.made.mesh, workers, monitor, &c.curves);
  o.outside = pipeline::refine(c.made.surface, bvh, c.made.mesh, {}, workers, monitor, &c.curves);
  o.cut = std::move(c);
  return o;
}

TEST(RefineCutSurfaces, AnglesBesideCreasesComeInsideTheBounds) {
  for (int which = 0; which < 2; ++which) {
    const auto shape = which == 0 ? std::function<Vec3(Vec3)>{} : bulge;
    const test::CutCase before = test::cut_cube(9, 0.5, 5, 27, shape);
    const CutOutcome o = refined(before);
    const auto [least, most] = test::angle_range(o.cut.made.mesh);
    EXPECT_GE(least, 30);
    EXPECT_LT(most, 90);
    expect_in_place(o.cut.made.mesh, o.cut.curves, before);
    EXPECT_EQ(test::euler_characteristic(o.cut.made.mesh), 6);
    EXPECT_NO_THROW(o.cut.made.mesh.check_invariants());
    const refine::Knots knots(o.cut.curves, o.cut.made.mesh);
    const parallel::Workers workers(1);
    EXPECT_TRUE(refine::crossing_triangles(o.cut.made.mesh, knots, workers).empty());
  }
}

TEST(RefineCutSurfaces, SameBytesForAnyNumberOfThreads) {
  const test::CutCase before = test::cut_cube(6, 0.6, 6, 18, bulge);
  const CutOutcome one = refined(before);
  for (const int threads : {2, 5}) {
    const CutOutcome other = refined(before, threads);
    EXPECT_EQ(other.cut.made.mesh.triangles(), one.cut.made.mesh.triangles());
    ASSERT_EQ(other.cut.made.mesh.positions.size(), one.cut.made.mesh.positions.size());
    EXPECT_EQ(std::memcmp(other.cut.made.mesh.positions.data(), one.cut.made.mesh.positions.data(),
                          one.cut.made.mesh.positions.size() * sizeof(Vec3)),
              0);
  }
}

}  // namespace
}  // namespace nonobtuse
