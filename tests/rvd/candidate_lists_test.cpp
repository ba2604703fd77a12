// Completeness of the candidate lists against a brute-force search over all sites.
#include "rvd/candidate_lists.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "numeric/random.h"
#include "rvd/test_surfaces.h"

namespace nonobtuse::rvd {
namespace {

// Random points of every facet, its corners and edge points: each nearest site must be listed.
void expect_complete(const mesh::Surface& surface, const std::vector<Vec3>& sites) {
  const parallel::Workers workers(1);
  const FacetCandidates lists = facet_candidates(surface, sites, workers);
  ASSERT_EQ(lists.start.size(), surface.triangles.size() + 1);
  for (Index f = 0; f < static_cast<Index>(surface.triangles.size()); ++f) {
    const auto list = lists.of(f);
    ASSERT_FALSE(list.empty());
    ASSERT_TRUE(std::is_sorted(list.begin(), list.end()));
    numeric::Random random(7, static_cast<std::uint64_t>(f));
    const Triangle& t = surface.triangles[f];
    for (int k = 0; k < 12; ++k) {
      double a = random.uniform();
      double b = k < 3 ? 0 : random.uniform();
      if (k >= 3 && k < 6) a = 0;
      if (k == 6) a = b = 0;
      if (a + b > 1) a = 1 - a, b = 1 - b;
      const Vec3 p = (1 - a - b) * surface.vertices[t[0]] + a * surface.vertices[t[1]] +
                     b * surface.vertices[t[2]];
      double best = 1e300;
      for (const Vec3& x : sites) best = std::min(best, squared_distance(p, x));
      // Rounding of p aside, every site at the least distance owns the point.
      for (Index i = 0; i < static_cast<Index>(sites.size()); ++i) {
        if (squared_distance(p, sites[i]) > best * (1 + 1e-14)) continue;
        ASSERT_TRUE(std::binary_search(list.begin(), list.end(), i)) << "facet " << f;
      }
    }
  }
}

TEST(CandidateLists, CompleteForRandomSites) {
  const mesh::Surface sphere = test::octasphere(3);
  expect_complete(sphere, test::random_sites(sphere, 200, 1));
  expect_complete(sphere, test::random_sites(sphere, 1, 1));
  expect_complete(sphere, test::random_sites(sphere, 4, 2));
}

TEST(CandidateLists, CompleteForFacetsMuchLargerThanCells) {
  const mesh::Surface cube = test::cube();
  expect_complete(cube, test::random_sites(cube, 700, 3));
}

TEST(CandidateLists, CompleteForExactTies) {
  const mesh::Surface cube = test::cube();
  std::vector<Vec3> grid;  // sites on corners, edges and faces, all at equal distances
  for (int x = 0; x <= 4; ++x)
    for (int y = 0; y <= 4; ++y)
      for (int z = 0; z <= 4; ++z) {
        const auto outer = [](int k) { return k == 0 || k == 4; };
        if (outer(x) || outer(y) || outer(z)) grid.push_back({x / 4.0, y / 4.0, z / 4.0});
      }
  expect_complete(cube, grid);
  std::vector<Vec3> twice = grid;
  twice.insert(twice.end(), grid.begin(), grid.end());
  expect_complete(cube, twice);
  expect_complete(cube, {{0.5, 0.5, 0.5}, {0.5, 0.5, 0.5}, {0.5, 0.5, 0.5}});
  const mesh::Surface sphere = test::octasphere(2);
  expect_complete(sphere, sphere.vertices);
  expect_complete(sphere, {{0, 0, 0}, {1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}});
}

TEST(CandidateLists, CompleteForSitesFarFromTheSurface) {
  const mesh::Surface sphere = test::octasphere(2);
  expect_complete(sphere, {{100, 0, 0}, {100, 1, 0}, {-300, 0, 0}, {0, 0, 1.1}});
  expect_complete(sphere, {{1000, 0, 0}, {1000, 0, 1}});
}

TEST(CandidateLists, SmallOnAverage) {
  const mesh::Surface sphere = test::octasphere(4);
  const FacetCandidates lists =
      facet_candidates(sphere, test::random_sites(sphere, 500, 5), parallel::Workers(1));
  EXPECT_LT(lists.sites.size(), 3 * sphere.triangles.size());
}

TEST(CandidateLists, SameForAnyNumberOfThreads) {
  const mesh::Surface sphere = test::octasphere(4);
  const auto sites = test::random_sites(sphere, 500, 5);
  const FacetCandidates one = facet_candidates(sphere, sites, parallel::Workers(1));
  const FacetCandidates three = facet_candidates(sphere, sites, parallel::Workers(3));
  EXPECT_EQ(one.start, three.start);
  EXPECT_EQ(one.sites, three.sites);
}

}  // namespace
}  // namespace nonobtuse::rvd
