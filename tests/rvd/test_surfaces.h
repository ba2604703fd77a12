// Small surfaces and site sets for the tests of the engine.
#pragma once

#include <array>
#include <map>
#include <utility>
#include <vector>

#include "mesh/surface.h"
#include "numeric/random.h"

namespace nonobtuse::rvd::test {

/// The unit cube [0,1]^3: 12 facets.
inline mesh::Surface cube() {
  std::vector<Vec3> v;
  for (int i = 0; i < 8; ++i) v.push_back({double(i & 1), double(i >> 1 & 1), double(i >> 2 & 1)});
  return mesh::make_surface(v, {{0, 2, 3},
                                {0, 3, 1},
                                {4, 5, 7},
                                {4, 7, 6},
                                {0, 1, 5},
                                {0, 5, 4},
                                {2, 6, 7},
                                {2, 7, 3},
                                {0, 4, 6},
                                {0, 6, 2},
                                {1, 3, 7},
                                {1, 7, 5}});
}

/// The octahedron, subdivided and projected to the unit sphere: 8 * 4^levels facets.
inline mesh::Surface octasphere(int levels) {
  std::vector<Vec3> v{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  std::vector<Triangle> t{{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4},
                          {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
  for (int level = 0; level < levels; ++level) {
    std::map<std::pair<Index, Index>, Index> middle;
    const auto mid = [&](Index a, Index b) {
      const auto key = std::minmax(a, b);
      const auto [it, added] = middle.try_emplace(key, static_cast<Index>(v.size()));
      if (added) v.push_back(normalized(v[a] + v[b]));
      return it->second;
    };
    std::vector<Triangle> finer;
    for (const Triangle& f : t) {
      const Index a = mid(f[1], f[2]);
      const Index b = mid(f[2], f[0]);
      const Index c = mid(f[0], f[1]);
      finer.insert(finer.end(), {{f[0], c, b}, {f[1], a, c}, {f[2], b, a}, {a, b, c}});
    }
    t = finer;
  }
  return mesh::make_surface(v, t);
}

/// Points of random facets (not uniform by area).
inline std::vector<Vec3> random_sites(const mesh::Surface& s, int count, std::uint64_t seed) {
  std::vector<Vec3> sites;
  numeric::Random random(seed);
  for (int i = 0; i < count; ++i) {
    const Triangle& t = s.triangles[static_cast<Index>(random.below(s.triangles.size()))];
    double a = random.uniform();
    double b = random.uniform();
    if (a + b > 1) a = 1 - a, b = 1 - b;
    sites.push_back((1 - a - b) * s.vertices[t[0]] + a * s.vertices[t[1]] + b * s.vertices[t[2]]);
  }
  return sites;
}

}  // namespace nonobtuse::rvd::test
