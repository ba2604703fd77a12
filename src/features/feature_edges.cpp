#include "features/feature_edges.h"

#include <algorithm>
#include <string>

#include "mesh/topology.h"
#include "nonobtuse/error.h"

namespace nonobtuse::features {

bool any_feature(const EdgeFlags& flags) {
  return std::any_of(flags.begin(), flags.end(), [](std::uint8_t f) { return f != 0; });
}

void flag_boundaries(const std::vector<Triangle>& triangles, Index vertex_count, EdgeFlags& flags) {
  mesh::for_each_edge(mesh::edge_sides(triangles, vertex_count),
                      [&](const mesh::EdgeSide* first, const mesh::EdgeSide* last) {
                        if (last - first == 2) return;
                        for (const mesh::EdgeSide* s = first; s != last; ++s)
                          set_flag(flags, s->triangle, s->corner);
                      });
}

void flag_edges(const std::vector<Triangle>& triangles, Index vertex_count,
                const std::vector<std::array<Index, 2>>& edges, EdgeFlags& flags) {
  const std::vector<mesh::EdgeSide> sides = mesh::edge_sides(triangles, vertex_count);
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const Index low = std::min(edges[i][0], edges[i][1]);
    const Index high = std::max(edges[i][0], edges[i][1]);
    auto side = std::lower_bound(sides.begin(), sides.end(), std::pair(low, high),
                                 [](const mesh::EdgeSide& s, const std::pair<Index, Index>& e) {
                                   return std::pair(s.low, s.high) < e;
                                 });
    if (side == sides.end() || side->low != low || side->high != high)
      throw InvalidInput("feature edge " + std::to_string(i) + " joins vertices " +
                             std::to_string(low) + " and " + std::to_string(high) +
                             ", which no edge of the mesh does.",
                         static_cast<Index>(i));
    for (; side != sides.end() && side->low == low && side->high == high; ++side)
      set_flag(flags, side->triangle, side->corner);
  }
}

}  // namespace nonobtuse::features
