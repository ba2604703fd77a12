// How many vertices go on each feature curve and into each patch between them, so that edges are
// equally long everywhere in the sizing metric and the whole has exactly n vertices.
#pragma once

#include <vector>

#include "nonobtuse/mesh.h"

namespace nonobtuse::features {

/// Edges along curves are this much longer than elsewhere: with triangles of 60 degrees on a
/// straight side of free neighbours that is what fits.
inline constexpr double kCurveSpacing = 1.1;

struct CurveDemand {
  double length = 0;  ///< in the sizing metric
  Index least = 1;    ///< segments it needs at least
  Index fixed = 0;    ///< segments it has, whatever its length; 0: free
  bool closed = false;
  std::vector<Index> patches;  ///< that it bounds, one entry per side
};

struct PatchDemand {
  double area = 0;  ///< in the sizing metric
  Index euler = 1;  ///< Euler characteristic
  Index least = 0;  ///< interior vertices it needs at least
};

struct VertexBalance {
  double edge_length = 0;       ///< h, in the sizing metric
  std::vector<Index> segments;  ///< per curve; a closed one has as many vertices, others one less
  std::vector<Index> interior;  ///< per patch
};

/// n = corners + vertices on curves + interior vertices, exactly. A patch of area A with m edges on
/// its boundary and Euler characteristic x gets about 2 A / (sqrt(3) h^2) - m / 2 + x: it then has
/// A / (sqrt(3)/4 h^2) triangles. Throws TooFewVertices with the n that is enough.
VertexBalance balance_vertices(const std::vector<CurveDemand>& curves,
                               const std::vector<PatchDemand>& patches, Index corners, Index n);

}  // namespace nonobtuse::features
