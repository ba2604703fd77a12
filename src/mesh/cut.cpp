#include "mesh/cut.h"

#include <algorithm>
#include <numeric>

namespace nonobtuse::mesh {

CornerFans::CornerFans(const std::vector<Triangle>& triangles)
    : triangles_(triangles), parent_(3 * triangles.size()) {
  std::iota(parent_.begin(), parent_.end(), Index{0});
}

Index CornerFans::root(Index corner) {
  while (parent_[corner] != corner) corner = parent_[corner] = parent_[parent_[corner]];
  return corner;
}

void CornerFans::join(const EdgeSide& a, const EdgeSide& b) {
  const auto corner_at = [&](const EdgeSide& s, Index v) {
    const int k = triangles_[s.triangle][next(s.corner)] == v ? next(s.corner) : previous(s.corner);
    return 3 * s.triangle + k;
  };
  for (const Index v : {a.low, a.high}) {
    const Index x = root(corner_at(a, v));
    const Index y = root(corner_at(b, v));
    parent_[std::max(x, y)] = std::min(x, y);
  }
}

Cut CornerFans::copies(Index vertex_count) {
  Cut cut;
  cut.triangles.resize(triangles_.size());
  cut.original.resize(vertex_count);
  std::iota(cut.original.begin(), cut.original.end(), Index{0});
  std::vector<char> taken(vertex_count, 0);
  std::vector<Index> copy(parent_.size(), -1);  // at the roots; a root is its fan's first corner
  for (Index c = 0; c < static_cast<Index>(parent_.size()); ++c) {
    const Index r = root(c);
    const Index v = triangles_[c / 3][c % 3];
    if (copy[r] < 0 && taken[v] == 0) {
      copy[r] = v;
      taken[v] = 1;
    } else if (copy[r] < 0) {
      copy[r] = static_cast<Index>(cut.original.size());
      cut.original.push_back(v);
    }
    cut.triangles[c / 3][c % 3] = copy[r];
  }
  return cut;
}

Cut cut_to_manifold(const std::vector<Triangle>& triangles, Index vertex_count,
                    const std::vector<EdgeSide>& sides) {
  return cut_along(triangles, vertex_count, sides,
                   [](const EdgeSide*, const EdgeSide*) { return false; });
}

}  // namespace nonobtuse::mesh
