#include "spatial/kd_tree.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "numeric/random.h"
#include "numeric/vec3.h"

namespace nonobtuse::spatial {
namespace {

using Neighbor = NearestSites::Neighbor;

// Half of the sites on integers: full of ties and coincident sites.
std::vector<Vec3> sites_of(std::uint64_t seed, int count) {
  numeric::Random random(seed);
  std::vector<Vec3> sites;
  for (int i = 0; i < count; ++i) {
    const Vec3 p = {6 * random.uniform(), 6 * random.uniform(), 6 * random.uniform()};
    sites.push_back(i % 2 == 0 ? p : Vec3{std::floor(p.x), std::floor(p.y), std::floor(p.z)});
  }
  return sites;
}

std::vector<Neighbor> sorted_by_distance(const std::vector<Vec3>& sites, const Vec3& p) {
  std::vector<Neighbor> all;
  for (std::size_t i = 0; i < sites.size(); ++i)
    all.push_back({static_cast<Index>(i), squared_distance(p, sites[i])});
  std::stable_sort(all.begin(), all.end(), [](const Neighbor& a, const Neighbor& b) {
    return a.squared_distance < b.squared_distance;
  });
  return all;
}

void expect_equal(const std::vector<Neighbor>& found, const std::vector<Neighbor>& expected) {
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    EXPECT_EQ(found[i].site, expected[i].site);
    EXPECT_EQ(found[i].squared_distance, expected[i].squared_distance);
  }
}

TEST(NearestSites, EqualsBruteForceWithTies) {
  for (const int count : {1, 7, 900}) {
    const std::vector<Vec3> sites = sites_of(5, count);
    const NearestSites tree(sites);
    std::vector<Neighbor> found;
    for (const Vec3& p : sites_of(6, 300)) {
      const std::vector<Neighbor> all = sorted_by_distance(sites, p);
      EXPECT_EQ(tree.nearest(p).site, all[0].site);
      for (const Index k : {1, 2, 20}) {
        tree.nearest(p, k, found);
        expect_equal(found, {all.begin(), all.begin() + std::min(k, Index(count))});
      }
      for (const double radius : {0.0, 1.0, 1.3}) {
        tree.within(p, radius, found);
        const auto end = std::partition_point(all.begin(), all.end(), [&](const Neighbor& n) {
          return n.squared_distance <= radius * radius;
        });
        expect_equal(found, {all.begin(), end});
      }
    }
  }
}

TEST(NearestSites, EmptyFindsNothing) {
  const NearestSites tree({});
  EXPECT_EQ(tree.nearest({}).site, -1);
}

}  // namespace
}  // namespace nonobtuse::spatial
