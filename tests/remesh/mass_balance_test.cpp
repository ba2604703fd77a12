// Moving sites from light cells into heavy ones: fewer heavy cells, less energy, on their
// component.
#include "remesh/mass_balance.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "rvd/test_surfaces.h"

namespace nonobtuse::pipeline {
namespace {

using rvd::test::octasphere;

// Sites of a spiral, even on the sphere but for the pole z > 0.8, which has few.
std::vector<Vec3> sparse_at_the_pole(int count) {
  std::vector<Vec3> sites;
  for (int i = 0; i < count; ++i) {
    const double z = 1 - (2.0 * i + 1) / count;
    const double r = std::sqrt(1 - z * z), angle = 2.399963229728653 * i;
    if (z < 0.8 || i % 7 == 0) sites.push_back({r * std::cos(angle), r * std::sin(angle), z});
  }
  return sites;
}

struct Cells {
  double energy;
  double heaviest;  // in means
};

Cells cells_of(const mesh::Surface& surface, const std::vector<Vec3>& sites,
               const parallel::Workers& workers) {
  rvd::CellEvaluator evaluator(surface, static_cast<Index>(sites.size()), workers);
  rvd::CellIntegrals cells;
  evaluator.evaluate(sites, cells);
  double total = 0;
  for (const double m : cells.mass) total += m;
  return {cells.energy, *std::max_element(cells.mass.begin(), cells.mass.end()) / total *
                            static_cast<double>(sites.size())};
}

TEST(MassBalance, FillsHeavyCells) {
  const mesh::Surface sphere = octasphere(4);
  const parallel::Workers workers(1);
  std::vector<Vec3> sites = sparse_at_the_pole(400);
  const Cells before = cells_of(sphere, sites, workers);
  ASSERT_GT(before.heaviest, 3);
  rvd::CellEvaluator evaluator(sphere, static_cast<Index>(sites.size()), workers);
  const std::size_t count = sites.size();
  EXPECT_GT(balance_masses(evaluator, std::vector<Index>(count, 0), sites), 0);
  EXPECT_EQ(sites.size(), count);
  const Cells after = cells_of(sphere, sites, workers);
  EXPECT_LT(after.heaviest, 2.5);
  EXPECT_LT(after.energy, before.energy);
}

TEST(MassBalance, EveryComponentKeepsItsSites) {
  // Two spheres apart: one with twice as many sites as the other.
  const mesh::Surface one = octasphere(4);
  std::vector<Vec3> v = one.vertices;
  std::vector<Triangle> t = one.triangles;
  const auto shift = static_cast<Index>(v.size());
  for (const Vec3& p : one.vertices) v.push_back(p + Vec3{4, 0, 0});
  for (const Triangle& f : one.triangles) t.push_back({f[0] + shift, f[1] + shift, f[2] + shift});
  const mesh::Surface two = mesh::make_surface(v, t);
  std::vector<Vec3> sites = sparse_at_the_pole(400);
  std::vector<Index> component(sites.size(), 0);
  for (const Vec3& p : sparse_at_the_pole(200)) {
    sites.push_back(p + Vec3{4, 0, 0});
    component.push_back(1);
  }
  const parallel::Workers workers(1);
  rvd::CellEvaluator evaluator(two, static_cast<Index>(sites.size()), workers);
  EXPECT_GT(balance_masses(evaluator, component, sites), 0);
  for (std::size_t i = 0; i < sites.size(); ++i) EXPECT_EQ(component[i], sites[i].x > 2 ? 1 : 0);
}

TEST(MassBalance, SameSitesForAnyThreads) {
  const mesh::Surface sphere = octasphere(4);
  std::vector<std::vector<Vec3>> results;
  for (const int threads : {1, 2, 5}) {
    const parallel::Workers workers(threads);
    results.push_back(sparse_at_the_pole(400));
    rvd::CellEvaluator evaluator(sphere, static_cast<Index>(results.back().size()), workers);
    balance_masses(evaluator, std::vector<Index>(results.back().size(), 0), results.back());
  }
  EXPECT_EQ(results[0], results[1]);
  EXPECT_EQ(results[0], results[2]);
}

}  // namespace
}  // namespace nonobtuse::pipeline
