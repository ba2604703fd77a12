// New vertices on edges, and facets split so that these become their corners: every facet on its
// own, so that an edge may have any number of them.
#pragma once

#include <vector>

#include "features/feature_edges.h"
#include "mesh/surface.h"

namespace nonobtuse::features {

/// A new vertex on the edge between two old ones.
struct EdgeVertex {
  Index low = 0, high = 0;  ///< ends of the edge, low < high
  double along = 0;         ///< from low to high, in (0, 1)
  Index vertex = 0;
};

struct SplitFacets {
  std::vector<Triangle> triangles;
  EdgeFlags flags;           ///< parts of a feature edge are features
  std::vector<Index> facet;  ///< of the facets given
};

/// `vertices` holds the old and the new ones. Longest edges are bisected first. In order of facets.
SplitFacets split_facets(const std::vector<Vec3>& vertices, const std::vector<Triangle>& triangles,
                         const EdgeFlags& flags, std::vector<EdgeVertex> inserted);

/// A surface with short edges, for fields that vary on the scale of those.
struct ResolvedSurface {
  mesh::Surface surface;  ///< the old vertices come first
  EdgeFlags flags;
  std::vector<Index> facet;  ///< #F: of the surface it was made from
};

/// Bisects edges until none is longer than `bound`, and no feature edge longer than
/// `feature_bound` (working units, times the local size), or there are very many facets.
ResolvedSurface resolve_surface(const mesh::Surface& surface, const EdgeFlags& flags, double bound,
                                double feature_bound);

}  // namespace nonobtuse::features
