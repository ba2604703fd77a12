// Part of nonobtuse, MIT licence. What a remeshing call gives back.
#pragma once

#include <string>
#include <vector>

#include "nonobtuse/certificate.h"
#include "nonobtuse/mesh.h"
#include "nonobtuse/quality.h"

namespace nonobtuse {

enum class Status {
  Converged,     ///< every angle is inside the bounds asked for, certified exactly
  AnglesRemain,  ///< the mesh is valid, but the certificate lists triangles outside the bounds
  Cancelled,     ///< stopped on request; the mesh is the best valid one so far
};

/// Time of one step of the pipeline.
struct StageTime {
  std::string stage;
  double seconds = 0;
};

struct RemeshResult {
  TriangleMesh mesh;  ///< exactly the vertices asked for; topology of the input
  Status status = Status::AnglesRemain;
  Certificate certificate;  ///< against the promise [30, 90)
  Certificate goal;         ///< against the bounds of the options
  AngleQuality angles;
  std::vector<Index> source_triangle;  ///< #V: triangle of the (cleaned) input nearest to a vertex
  std::vector<Vec3> barycentric;       ///< #V by 3: the nearest point's coordinates in it
  std::vector<StageTime> stages;       ///< in the order they ran; a stage may occur once
};

}  // namespace nonobtuse
