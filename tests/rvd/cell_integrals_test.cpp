// Integrals over restricted Voronoi cells: against the surface's area, against brute force, and
// against themselves with lists that were reused.
#include "rvd/cell_integrals.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "numeric/random.h"
#include "rvd/facet_clipping.h"
#include "rvd/test_surfaces.h"

namespace nonobtuse::rvd {
namespace {

double sum(const std::vector<double>& values) {
  double s = 0;
  for (const double v : values) s += v;
  return s;
}

CellIntegrals fresh(const mesh::Surface& surface, const std::vector<Vec3>& sites) {
  const parallel::Workers workers(1);
  CellEvaluator evaluator(surface, static_cast<Index>(sites.size()), workers);
  CellIntegrals cells;
  evaluator.evaluate(sites, cells);
  return cells;
}

// Every point counts for the lowest of its nearest sites: sums over a fine grid on each facet.
CellIntegrals by_brute_force(const mesh::Surface& surface, const std::vector<Vec3>& sites,
                             int grid) {
  CellIntegrals cells;
  cells.mass.assign(sites.size(), 0);
  cells.centroid.assign(sites.size(), {});
  for (std::size_t f = 0; f < surface.triangles.size(); ++f) {
    const Triangle& t = surface.triangles[f];
    const double w = surface.areas[f] / (grid * grid);
    for (int a = 0; a < grid; ++a)
      for (int b = 0; b < grid; ++b) {
        // Centroids of the grid^2 small triangles, upright and inverted.
        const bool upright = a + b < grid;
        const double u = upright ? (a + 1 / 3.0) / grid : (grid - a - 1 / 3.0) / grid;
        const double v = upright ? (b + 1 / 3.0) / grid : (grid - b - 1 / 3.0) / grid;
        const Vec3 p = (1 - u - v) * surface.vertices[t[0]] + u * surface.vertices[t[1]] +
                       v * surface.vertices[t[2]];
        std::size_t best = 0;
        for (std::size_t i = 1; i < sites.size(); ++i)
          if (squared_distance(p, sites[i]) < squared_distance(p, sites[best])) best = i;
        cells.mass[best] += w;
        cells.energy += w * squared_distance(p, sites[best]);
        cells.centroid[best] += w * p;
      }
  }
  for (std::size_t i = 0; i < sites.size(); ++i)
    cells.centroid[i] = cells.mass[i] > 0 ? cells.centroid[i] / cells.mass[i] : sites[i];
  return cells;
}

void expect_like_brute_force(const mesh::Surface& surface, const std::vector<Vec3>& sites, int grid,
                             double tolerance) {
  const CellIntegrals exact = fresh(surface, sites);
  const CellIntegrals rough = by_brute_force(surface, sites, grid);
  EXPECT_NEAR(sum(exact.mass), surface.area, 1e-12 * surface.area);
  EXPECT_NEAR(exact.energy, rough.energy, tolerance * rough.energy);
  for (std::size_t i = 0; i < sites.size(); ++i) {
    EXPECT_NEAR(exact.mass[i], rough.mass[i], tolerance * surface.area) << i;
    EXPECT_LT(length(exact.mass[i] * exact.centroid[i] - rough.mass[i] * rough.centroid[i]),
              2 * tolerance * surface.area);
  }
}

TEST(CellIntegrals, LikeBruteForce) {
  const mesh::Surface cube = test::cube();
  expect_like_brute_force(cube, test::random_sites(cube, 30, 1), 150, 1e-3);
  expect_like_brute_force(cube, test::random_sites(cube, 3, 2), 150, 1e-3);
  const mesh::Surface sphere = test::octasphere(2);
  expect_like_brute_force(sphere, test::random_sites(sphere, 30, 3), 40, 1e-3);
  expect_like_brute_force(sphere, {{0.2, 0, 0}}, 40, 1e-3);
}

TEST(CellIntegrals, EqualDistancesGoToTheLowestIndex) {
  const mesh::Surface cube = test::cube();
  const Vec3 a{0.1, 0.2, 0.3};
  const CellIntegrals same = fresh(cube, {a, {0.9, 0.8, 0.9}, a});
  EXPECT_EQ(same.mass[2], 0);
  EXPECT_EQ(same.centroid[2], a);
  EXPECT_GT(same.mass[0], 0);
  // Mirror images in the plane z = 0: the whole bottom face is at equal distance from both.
  const CellIntegrals mirrored = fresh(cube, {{0.5, 0.5, -0.25}, {0.5, 0.5, 0.25}});
  EXPECT_NEAR(mirrored.mass[0], 1, 1e-12);
  EXPECT_NEAR(mirrored.mass[1], 5, 1e-12);
}

TEST(CellIntegrals, AreasSumToTheSurfaceInDegenerateCases) {
  const mesh::Surface cube = test::cube();
  std::vector<Vec3> grid;
  for (int x = 0; x <= 4; ++x)
    for (int y = 0; y <= 4; ++y)
      for (int z = 0; z <= 4; ++z) grid.push_back({x / 4.0, y / 4.0, z / 4.0});
  EXPECT_NEAR(sum(fresh(cube, grid).mass), 6, 1e-12);
  const mesh::Surface sphere = test::octasphere(3);
  EXPECT_NEAR(sum(fresh(sphere, sphere.vertices).mass), sphere.area, 1e-12);
  EXPECT_NEAR(sum(fresh(sphere, grid).mass), sphere.area, 1e-12);
  const auto many = test::random_sites(cube, 3000, 9);
  EXPECT_NEAR(sum(fresh(cube, many).mass), 6, 1e-12);
}

TEST(CellIntegrals, ReusedListsLikeFreshOnes) {
  const mesh::Surface sphere = test::octasphere(4);
  const parallel::Workers workers(1);
  std::vector<Vec3> sites = test::random_sites(sphere, 300, 4);
  CellEvaluator evaluator(sphere, 300, workers);
  CellIntegrals cells;
  evaluator.evaluate(sites, cells);
  for (int round = 0; round < 30; ++round) {
    // Steps of all sizes, and now and then a site that jumps across the surface.
    for (std::size_t i = 0; i < sites.size(); ++i) {
      numeric::Random random(static_cast<std::uint64_t>(round), i);
      const double size = 0.1 * std::pow(0.5, round % 10);
      sites[i] +=
          size * Vec3{random.uniform() - 0.5, random.uniform() - 0.5, random.uniform() - 0.5};
      if (random.below(1000) == 0) sites[i] = -sites[i];
    }
    evaluator.evaluate(sites, cells);
    const CellIntegrals again = fresh(sphere, sites);
    ASSERT_NEAR(cells.energy, again.energy, 1e-13 * again.energy);
    for (std::size_t i = 0; i < sites.size(); ++i) {
      ASSERT_NEAR(cells.mass[i], again.mass[i], 1e-13 * sphere.area);
      ASSERT_LT(length(cells.mass[i] * cells.centroid[i] - again.mass[i] * again.centroid[i]),
                1e-13 * sphere.area);
    }
  }
  const auto statistics = evaluator.statistics();
  EXPECT_LT(statistics.relisted, statistics.pieces);  // some lists were reused
}

TEST(CellIntegrals, SameBitsForAnyNumberOfThreads) {
  const mesh::Surface sphere = test::octasphere(5);
  std::vector<CellIntegrals> results;
  for (const int threads : {1, 2, 5}) {
    const parallel::Workers workers(threads);
    std::vector<Vec3> sites = test::random_sites(sphere, 1500, 4);
    CellEvaluator evaluator(sphere, 1500, workers);
    CellIntegrals cells;
    for (int k = 0; k < 4; ++k) {
      evaluator.evaluate(sites, cells);
      sites = cells.centroid;
    }
    results.push_back(cells);
  }
  for (const CellIntegrals& r : results) {
    EXPECT_EQ(r.energy, results[0].energy);
    EXPECT_EQ(r.mass, results[0].mass);
    EXPECT_EQ(r.centroid, results[0].centroid);
  }
}

TEST(CellIntegrals, AdjacentCellsTriangulateTheSphere) {
  const mesh::Surface sphere = test::octasphere(5);
  const parallel::Workers workers(1);
  std::vector<Vec3> sites = test::random_sites(sphere, 400, 4);
  CellEvaluator evaluator(sphere, 400, workers);
  CellIntegrals cells;
  for (int k = 0; k < 5; ++k) {
    evaluator.evaluate(sites, cells);
    if (k < 4) sites = cells.centroid;
  }
  EXPECT_EQ(evaluator.adjacent_cells().size(), 3 * sites.size() - 6);
}

TEST(FacetClipping, PartsOfManySitesFillTheTriangle) {
  FacetClipper clipper;
  numeric::Random random(5);
  for (int trial = 0; trial < 2000; ++trial) {
    const std::size_t count = 1 + random.below(9);
    std::vector<CornerDistances> d(count);
    // Few distinct values: many ties.
    for (auto& values : d)
      for (double& value : values)
        value = trial % 2 == 0 ? static_cast<double>(random.below(4)) : random.uniform();
    std::vector<Moments> m(count, Moments{});
    clipper.clip(d, m);
    Moments total{};
    for (std::size_t i = 0; i < count; ++i) {
      EXPECT_GE(m[i][0] + m[i][1] + m[i][2], -1e-14);
      for (int k = 0; k < 3; ++k) {
        EXPECT_GE(m[i][k], -1e-14);
        total[k] += m[i][k];
      }
    }
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(total[k], 1.0 / 3, 1e-14);
  }
}

TEST(CellIntegrals, PartsAddUpToTheirCells) {
  const mesh::Surface sphere = test::octasphere(3);
  const std::vector<Vec3> sites = test::random_sites(sphere, 60, 5);
  const parallel::Workers workers(1);
  CellEvaluator evaluator(sphere, static_cast<Index>(sites.size()), workers);
  CellIntegrals cells;
  evaluator.evaluate(sites, cells);
  std::vector<char> wanted(sites.size(), 0);
  for (std::size_t i = 0; i < sites.size(); i += 3) wanted[i] = 1;
  std::vector<double> mass(sites.size(), 0);
  std::vector<Vec3> moment(sites.size());
  for (const CellPart& part : evaluator.parts_of(wanted)) {
    mass[part.site] += part.mass;
    moment[part.site] += part.mass * part.centroid;
  }
  for (std::size_t i = 0; i < sites.size(); ++i) {
    if (wanted[i] == 0) {
      EXPECT_EQ(mass[i], 0);
      continue;
    }
    EXPECT_NEAR(mass[i], cells.mass[i], 1e-12);
    EXPECT_LT(distance(moment[i], cells.mass[i] * cells.centroid[i]), 1e-12);
  }
}

}  // namespace
}  // namespace nonobtuse::rvd
