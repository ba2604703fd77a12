// The pipeline on a connected part with feature curves (creases, boundaries): knots on the curves,
// the surface cut open along them, a first mesh of every patch, all patches refined together, glued
// at the knots.
#pragma once

#include "features/feature_graph.h"
#include "features/vertex_balance.h"
#include "mesh/editable_mesh.h"
#include "nonobtuse/options.h"
#include "nonobtuse/result.h"
#include "parallel/workers.h"
#include "remesh/normalization.h"
#include "remesh/parts.h"
#include "remesh/stage_clock.h"

namespace nonobtuse::pipeline {

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
  bool manifold = true;      ///< no edge has three facets, no fans touch: it can do without curves
};

/// Curves, corners and the share of each curve and patch of `vertices`. Throws TooFewVertices.
FeaturePlan plan_features(const Part& part, Index vertices, const RemeshOptions& options);

/// A finished part, in working coordinates, with its vertices that are exactly those of the input.
struct GluedMesh {
  TriangleMesh mesh;
  std::vector<Index> source;  ///< #V: the part's vertex of equal position; -1 where there is none
  std::vector<std::array<Index, 2>> feature_edges;  ///< of the mesh
  std::vector<NarrowCorner> narrow_corners;  ///< of the mesh; what is reached is not known yet
};

/// Throws TooFewVertices where the topology needs more. Empty where the vertices are too few to
/// keep the features of a manifold apart: it is then to be meshed without them.
GluedMesh remesh_features(const FeaturePlan& plan, Index vertices, const RemeshOptions& options,
                          const parallel::Workers& workers, StageClock& clock);

}  // namespace nonobtuse::pipeline
