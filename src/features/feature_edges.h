// Which edges of a surface are features: creases, boundaries, edges of three or more facets, or
// edges a user names. Held per facet side, so that an edge may have any number of facets.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "mesh/surface.h"

namespace nonobtuse::features {

/// #F: bit k of a facet is set where its edge k (the one opposite corner k) is a feature. All sides
/// of an edge agree.
using EdgeFlags = std::vector<std::uint8_t>;

inline bool flagged(const EdgeFlags& flags, Index facet, int k) {
  return (flags[facet] >> k & 1) != 0;
}
inline void set_flag(EdgeFlags& flags, Index facet, int k) {
  flags[facet] = static_cast<std::uint8_t>(flags[facet] | 1 << k);
}

/// Whether there is any feature at all.
bool any_feature(const EdgeFlags& flags);

/// Flags every edge that has not exactly two facets.
void flag_boundaries(const std::vector<Triangle>& triangles, Index vertex_count, EdgeFlags& flags);

/// Flags the edges given by their end vertices. Throws InvalidInput, with the entry's index, for a
/// pair of vertices that is no edge.
void flag_edges(const std::vector<Triangle>& triangles, Index vertex_count,
                const std::vector<std::array<Index, 2>>& edges, EdgeFlags& flags);

}  // namespace nonobtuse::features
