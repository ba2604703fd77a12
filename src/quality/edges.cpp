#include "quality/edges.h"

#include <algorithm>
#include <tuple>

namespace nonobtuse::quality {

namespace {

struct Keyed {
  Index low, high;
  EdgeSide side;
};

}  // namespace

EdgeList::EdgeList(std::span<const Triangle> triangles, std::size_t vertex_count) {
  // Bucketed by the lower vertex, then sorted within.
  std::vector<std::size_t> start(vertex_count + 1, 0);
  const auto for_each_side = [&](const auto& visit) {
    for (std::size_t t = 0; t < triangles.size(); ++t)
      for (int k = 0; k < 3; ++k) {
        const Index tail = triangles[t][(k + 1) % 3];
        const Index head = triangles[t][(k + 2) % 3];
        if (tail == head) continue;
        visit(Keyed{std::min(tail, head), std::max(tail, head),
                    EdgeSide{static_cast<Index>(t), k, tail < head}});
      }
  };
  for_each_side([&](const Keyed& s) { ++start[s.low + 1]; });
  for (std::size_t v = 0; v < vertex_count; ++v) start[v + 1] += start[v];
  std::vector<Keyed> keyed(start[vertex_count]);
  std::vector<std::size_t> fill(start.begin(), start.end() - 1);
  for_each_side([&](const Keyed& s) { keyed[fill[s.low]++] = s; });
  for (std::size_t v = 0; v < vertex_count; ++v)
    std::sort(keyed.begin() + static_cast<std::ptrdiff_t>(start[v]),
              keyed.begin() + static_cast<std::ptrdiff_t>(start[v + 1]),
              [](const Keyed& a, const Keyed& b) {
                return std::tie(a.high, a.side.triangle, a.side.corner) <
                       std::tie(b.high, b.side.triangle, b.side.corner);
              });

  sides_.reserve(keyed.size());
  edge_sides_.reserve(keyed.size());
  for (std::size_t i = 0; i < keyed.size(); ++i) {
    sides_.push_back({keyed[i].low, keyed[i].high});
    edge_sides_.push_back(keyed[i].side);
    const bool last = i + 1 == keyed.size() || keyed[i + 1].low != keyed[i].low ||
                      keyed[i + 1].high != keyed[i].high;
    if (last) ends_.push_back(i + 1);
  }
}

}  // namespace nonobtuse::quality
