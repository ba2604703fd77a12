// The pipeline on a connected part with feature curves (creases, boundaries): knots on the curves,
// the surface cut open along them, a first mesh of every patch, all patches refined together, glued
// at the knots.
#pragma once

#include <array>
#include <vector>

#include "nonobtuse/mesh.h"
#include "nonobtuse/options.h"
#include "nonobtuse/result.h"
#include "parallel/workers.h"
#include "remesh/feature_plan.h"
#include "remesh/stage_clock.h"

namespace nonobtuse::pipeline {

/// A finished part, in working coordinates, with its vertices that are exactly those of the input.
struct GluedMesh {
  TriangleMesh mesh;
  std::vector<Index> source;  ///< #V: the part's vertex of equal position; -1 where there is none
  std::vector<std::array<Index, 2>> feature_edges;  ///< of the mesh
  std::vector<NarrowCorner> narrow_corners;  ///< of the mesh; what is reached is not known yet
};

/// Throws TooFewVertices where the topology needs more. Empty where the vertices are too few to
/// keep the features of a manifold apart: it is then to be meshed without them. Where a few angles
/// miss the promise, the part is planned again with shorter edges there, and meshed anew.
GluedMesh remesh_features(const Part& part, const FeaturePlan& plan, Index vertices,
                          const RemeshOptions& options, const parallel::Workers& workers,
                          StageClock& clock);

}  // namespace nonobtuse::pipeline
