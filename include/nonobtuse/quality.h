// Part of nonobtuse, MIT licence. Every figure the tool prints, one definition each.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "nonobtuse/context.h"
#include "nonobtuse/mesh.h"

namespace nonobtuse {

/// Angles and shape of a mesh (columns of Table 1 of Yan & Wonka 2016). Angles in degrees.
struct AngleQuality {
  Index triangles = 0;
  Index obtuse = 0;                ///< triangles with an angle >= 90, decided exactly
  Index small = 0;                 ///< triangles with an angle < 30, decided exactly
  double min_angle = 0;            ///< theta_min over all angles
  double max_angle = 0;            ///< theta_max
  double mean_min_angle = 0;       ///< mean over triangles of the smallest angle
  double quality_min = 0;          ///< Q_min; Q = 6/sqrt(3) S/(p h), 1 for an equilateral triangle
  double quality_mean = 0;         ///< Q_avg
  double percent_small = 0;        ///< % of triangles with an angle < 30
  double percent_obtuse = 0;       ///< % of triangles with an angle >= 90
  double percent_valence_567 = 0;  ///< % of vertices of valence 5, 6, 7; a boundary vertex counts
                                   ///< as good if its k triangles can share the angle they fill:
                                   ///< a mean of 42 to 78 degrees each (3 or 4 on straight sides)
};

/// Combinatorics of a mesh.
struct Topology {
  Index vertices = 0;
  Index edges = 0;
  Index triangles = 0;
  Index components = 0;
  Index boundary_loops = 0;
  std::int64_t euler_characteristic = 0;  ///< V - E + F, unused vertices not counted
  Index nonmanifold_edges = 0;            ///< edges of three or more triangles
  Index nonmanifold_vertices = 0;         ///< vertices whose triangles form more than one fan
  bool oriented = true;                   ///< neighbours agree on every edge
};

/// Two-sided distance between two surfaces, in input units, sampled as Metro does (Cignoni,
/// Rocchini, Scopigno 1998): area-uniform samples plus all vertices, exact closest points.
struct SurfaceDistance {
  double diagonal = 0;   ///< bounding-box diagonal of the reference, by which figures are divided
  double hausdorff = 0;  ///< max of the two one-sided maxima
  double rms = 0;        ///< max of the two one-sided root mean squares
  double hausdorff_to_reference = 0;
  double hausdorff_from_reference = 0;
  double rms_to_reference = 0;
  double rms_from_reference = 0;
};

struct QualityReport {
  AngleQuality angles;
  Topology topology;
  Index self_intersections = 0;  ///< pairs of triangles that cross, touch or overlap beyond the
                                 ///< vertices and edges they share; exact
  Index flipped = 0;  ///< triangles whose normal is more than 90 degrees off the reference's (its
                      ///< facet's and its interpolated vertex normals') at the point nearest to
                      ///< their centroid; 0 without a reference
  std::optional<SurfaceDistance> distance;  ///< only with a reference
};

/// Measures angles, topology and self-intersections; with a reference also distance and flips.
/// Throws InvalidInput for indices out of range or non-finite coordinates. Thread-safe.
QualityReport measure(const TriangleMesh& mesh, const TriangleMesh* reference = nullptr,
                      const Context& context = {});

/// Parts of `measure`, for those who need only one.
AngleQuality measure_angles(const TriangleMesh& mesh);
Topology measure_topology(const TriangleMesh& mesh);
SurfaceDistance measure_distance(const TriangleMesh& mesh, const TriangleMesh& reference,
                                 const Context& context = {});
Index count_self_intersections(const TriangleMesh& mesh, const Context& context = {});

/// #V: distance of every vertex of `mesh` to the surface of `reference`, in input units; exact
/// closest points. Throws like `measure`, and if one of the two has no triangles. Thread-safe.
std::vector<double> vertex_distances(const TriangleMesh& mesh, const TriangleMesh& reference,
                                     const Context& context = {});

}  // namespace nonobtuse
