// Part of nonobtuse, MIT licence. Every option of a remeshing call with its default.
#pragma once

#include <cstdint>

#include "nonobtuse/mesh.h"

namespace nonobtuse {

/// Which way the mesh is made.
enum class Method {
  Default,  ///< CVT, then refinement on the mesh: all angles inside the bounds
  Cvt,      ///< centroidal Voronoi tessellation alone (Yan & Wonka 2016, Eq. 1)
  CvtNob,   ///< CVT, valence optimisation, short-dual penalty (Yan & Wonka 2016, Eq. 3-4)
};

struct RemeshOptions {
  /// Number of output vertices, exactly, at most 1e8; 0 = as many as the input has (unless
  /// edge_length is set).
  Index vertices = 0;
  /// Target edge length in input units, instead of `vertices`; 0 = unset.
  double edge_length = 0;
  /// The same relative to the diagonal of the input's bounding box; 0 = unset.
  double relative_edge_length = 0;
  Method method = Method::Default;
  /// Bounds to reach, degrees: 0 <= min_angle < 60 < max_angle. The promise is [30, 90).
  double min_angle = 40;
  double max_angle = 80;
  /// Keep every vertex on the input surface instead of at the offset that minimises the distance;
  /// `Method::Default` only.
  bool on_surface = false;
  /// Weight lambda of the short-dual penalty in `Method::CvtNob` (Eq. 3), times area / vertices.
  double penalty = 0.01;
  /// Seed of the random sampling. Same input, options and seed: same bytes.
  std::uint64_t seed = 0;
};

}  // namespace nonobtuse
