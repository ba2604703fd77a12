// How many vertices go where on a part with features: corners and curves found, sizes bounded where
// features are near each other, vertices shared out to curves and patches (the vertex balance).
#pragma once

#include <cmath>
#include <vector>

#include "features/feature_edges.h"
#include "features/feature_graph.h"
#include "features/vertex_balance.h"
#include "mesh/surface.h"
#include "nonobtuse/options.h"
#include "remesh/normalization.h"
#include "remesh/parts.h"

namespace nonobtuse::pipeline {

/// Edge length of a uniform mesh in working coordinates, where area / #V = 1.
inline const double kEdgeLength = std::sqrt(2 / std::sqrt(3.0));

/// What is settled before anything is sampled.
struct FeaturePlan {
  NormalizedInput input;
  Index originals = 0;           ///< vertices of `surface` that are the input's, the first ones
  mesh::Surface surface;         ///< the input, with its sizes; where features are near each other
                                 ///< with short edges, so that sizes can follow them
  features::EdgeFlags flags;     ///< of the surface's facets, without stubs too short to mesh
  features::FeatureGraph graph;  ///< on the surface
  features::VertexBalance balance;
  std::vector<char> frozen;  ///< #curves: every vertex of it stays where it is
  double given_up = 0;       ///< length of creases that yielded to nearer ones, input units
  bool manifold = true;      ///< no edge has three facets, no fans touch: it can do without curves
};

/// A place (working coordinates) where edges are to be no longer than `length`.
struct FinePlace {
  Vec3 at;
  double length = 0;
};

/// Curves, corners and the share of each curve and patch of `vertices`. Throws TooFewVertices.
FeaturePlan plan_features(const Part& part, Index vertices, const RemeshOptions& options,
                          const std::vector<FinePlace>& fine = {});

}  // namespace nonobtuse::pipeline
