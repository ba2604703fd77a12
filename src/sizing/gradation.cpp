#include "sizing/gradation.h"

#include <cmath>
#include <functional>
#include <queue>
#include <utility>

namespace nonobtuse::sizing {

// Dijkstra's algorithm from all vertices at once, each starting at its own length: a vertex is
// final when it leaves the queue, and ties leave it by index.
void limit_gradation(const mesh::Surface& surface, double gradation, std::vector<double>& length) {
  if (!std::isfinite(gradation)) return;
  std::vector<Index> start(surface.vertices.size() + 1, 0);
  for (const Triangle& t : surface.triangles)
    for (const Index v : t) start[v + 1] += 2;
  for (std::size_t v = 0; v + 1 < start.size(); ++v) start[v + 1] += start[v];
  std::vector<Index> neighbor(start.back());
  std::vector<Index> fill(start.begin(), start.end() - 1);
  for (const Triangle& t : surface.triangles)
    for (int k = 0; k < 3; ++k) {
      neighbor[fill[t[k]]++] = t[mesh::next(k)];
      neighbor[fill[t[k]]++] = t[mesh::previous(k)];
    }

  using Entry = std::pair<double, Index>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
  for (std::size_t v = 0; v < length.size(); ++v)
    if (std::isfinite(length[v])) queue.push({length[v], static_cast<Index>(v)});
  while (!queue.empty()) {
    const auto [h, v] = queue.top();
    queue.pop();
    if (h > length[v]) continue;  // an older entry
    for (Index k = start[v]; k < start[v + 1]; ++k) {
      const Index u = neighbor[k];
      const double bound = h + gradation * distance(surface.vertices[u], surface.vertices[v]);
      if (!(bound < length[u])) continue;
      length[u] = bound;
      queue.push({bound, u});
    }
  }
}

}  // namespace nonobtuse::sizing
