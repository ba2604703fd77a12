// Part of nonobtuse, MIT licence. What a remeshing call gives back.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "nonobtuse/certificate.h"
#include "nonobtuse/mesh.h"
#include "nonobtuse/quality.h"

namespace nonobtuse {

enum class Status {
  Converged,     ///< every angle is inside the bounds asked for, certified exactly, but for
                 ///< triangles at `narrow_corners` (none on most surfaces)
  AnglesRemain,  ///< the mesh is valid, but the certificate lists triangles outside the bounds
  Cancelled,     ///< stopped on request; the mesh is the best valid one so far
};

/// Time of one step of the pipeline.
struct StageTime {
  std::string stage;
  double seconds = 0;
};

/// What is known after one iteration of an optimiser.
struct IterationRecord {
  std::string stage;  ///< as in StageTime
  int iteration = 0;  ///< from 0, the start, in this stage (several components: one after another)
  double energy = 0;  ///< what the stage minimises, in units of area / #V = 1
  Index obtuse = 0;   ///< triangles with an angle of 90 degrees and more
  Index small = 0;    ///< triangles with an angle below 30 degrees
};

/// How the edges of the result realise the target edge lengths: actual length over target (the mean
/// of that at both ends), over all edges. The target of a uniform mesh is the edge of a regular
/// triangulation with as many vertices.
struct SizeRatio {
  double median = 0;
  double percentile_5 = 0;
  double percentile_95 = 0;
};

/// A corner of the input at which two feature edges bound a face under less than 30 degrees: some
/// angle of the result there is as small, whatever is done. With Boundary::Freeze also a vertex of
/// the boundary at which the lengths of its two edges, or another vertex of the boundary that is
/// too near, leave no room for triangles inside [30, 90).
struct NarrowCorner {
  Index vertex = -1;         ///< of the result; it is where the input's corner is
  double input_angle = 0;    ///< between the feature edges, on the face, degrees
  double reached_angle = 0;  ///< the least angle of the result at this vertex, degrees
};

struct RemeshResult {
  TriangleMesh mesh;  ///< exactly the vertices asked for (unless there is a max_error); topology of
                      ///< the input
  Status status = Status::AnglesRemain;
  Certificate certificate;  ///< against the promise [30, 90)
  Certificate goal;         ///< against the bounds of the options
  AngleQuality angles;
  SizeRatio size_ratio;
  double max_error = 0;  ///< with RemeshOptions::max_error: the distance measured, at most that
  std::vector<Index> source_triangle;  ///< #V: triangle of the (cleaned) input nearest to a vertex
  std::vector<Vec3> barycentric;       ///< #V by 3: the nearest point's coordinates in it
  /// Edges of the result that make up the creases and boundaries of the input (pairs of vertices,
  /// the lower first, sorted).
  std::vector<std::array<Index, 2>> feature_edges;
  std::vector<NarrowCorner> narrow_corners;  ///< see there; triangles at them may miss the bounds
  /// Connected components whose creases and boundary curves were given up, since the vertices were
  /// too few to keep them apart.
  Index parts_without_features = 0;
  /// Length of the creases found by Features::Auto that yielded to sharper ones nearer than an
  /// edge, since the vertices were too few to keep both; input units.
  double creases_given_up = 0;
  std::vector<StageTime> stages;         ///< in the order they ran; a stage may occur once
  std::vector<IterationRecord> history;  ///< with RemeshOptions::history, in order; else empty
};

/// Whether a mesh is inside the bounds of its certificate, or all triangles outside touch one of
/// `corners`. What is meant by Status::Converged, for a mesh as it was written.
bool certified_but_for_narrow_corners(const TriangleMesh& mesh, const Certificate& certificate,
                                      const std::vector<NarrowCorner>& corners);

}  // namespace nonobtuse
