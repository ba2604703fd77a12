#include "mesh/topology.h"

#include <algorithm>
#include <numeric>
#include <tuple>

namespace nonobtuse::mesh {

std::vector<EdgeSide> edge_sides(const std::vector<Triangle>& triangles, Index vertex_count) {
  // Bucketed by the lower vertex, then sorted within the few of each bucket.
  std::vector<std::size_t> start(vertex_count + std::size_t{1}, 0);
  const auto side = [&](std::size_t t, int k) {
    const Index a = triangles[t][next(k)];
    const Index b = triangles[t][previous(k)];
    return EdgeSide{std::min(a, b), std::max(a, b), static_cast<Index>(t), k, a < b};
  };
  for (std::size_t t = 0; t < triangles.size(); ++t)
    for (int k = 0; k < 3; ++k) ++start[side(t, k).low + 1];
  std::partial_sum(start.begin(), start.end(), start.begin());
  std::vector<EdgeSide> sides(3 * triangles.size());
  std::vector<std::size_t> fill(start.begin(), start.end() - 1);
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    for (int k = 0; k < 3; ++k) {
      const EdgeSide s = side(t, k);
      sides[fill[s.low]++] = s;
    }
  }
  for (Index v = 0; v < vertex_count; ++v)
    std::sort(sides.begin() + static_cast<std::ptrdiff_t>(start[v]),
              sides.begin() + static_cast<std::ptrdiff_t>(start[v + 1]),
              [](const EdgeSide& a, const EdgeSide& b) {
                return std::tie(a.high, a.triangle, a.corner) <
                       std::tie(b.high, b.triangle, b.corner);
              });
  return sides;
}

namespace {

struct Neighbour {
  Index triangle = -1;
  bool agrees = true;
};

std::vector<std::array<Neighbour, 3>> neighbours_across(std::size_t triangle_count,
                                                        const std::vector<EdgeSide>& sides) {
  std::vector<std::array<Neighbour, 3>> across(triangle_count);
  for_each_edge(sides, [&](const EdgeSide* first, const EdgeSide* last) {
    if (last - first != 2) return;
    const bool agrees = first[0].upward != first[1].upward;
    across[first[0].triangle][first[0].corner] = {first[1].triangle, agrees};
    across[first[1].triangle][first[1].corner] = {first[0].triangle, agrees};
  });
  return across;
}

}  // namespace

Orientation consistent_orientation(std::size_t triangle_count, const std::vector<EdgeSide>& sides) {
  const auto across = neighbours_across(triangle_count, sides);
  Orientation result;
  std::vector<char>& turned = result.turned;
  turned.assign(triangle_count, 2);  // 2: not visited
  std::vector<Index> component;
  for (std::size_t seed = 0; seed < triangle_count; ++seed) {
    if (turned[seed] != 2) continue;
    component.assign(1, static_cast<Index>(seed));
    turned[seed] = 0;
    std::size_t turns = 0;
    for (std::size_t i = 0; i < component.size(); ++i) {
      const Index t = component[i];
      for (const Neighbour& n : across[t]) {
        if (n.triangle < 0) continue;
        const char wanted = n.agrees ? turned[t] : static_cast<char>(1 - turned[t]);
        if (turned[n.triangle] == 2) {
          turned[n.triangle] = wanted;
          turns += static_cast<std::size_t>(wanted);
          component.push_back(n.triangle);
        } else if (turned[n.triangle] != wanted && result.contradiction < 0) {
          result.contradiction = n.triangle;
        }
      }
    }
    if (2 * turns > component.size())
      for (const Index t : component) turned[t] = static_cast<char>(1 - turned[t]);
  }
  for (std::size_t t = 0; t < triangle_count; ++t) {
    if (turned[t] == 0) continue;
    if (result.count == 0) result.first = static_cast<Index>(t);
    ++result.count;
  }
  return result;
}

}  // namespace nonobtuse::mesh
