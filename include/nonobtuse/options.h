// Part of nonobtuse, MIT licence. Every option of a remeshing call with its default.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "nonobtuse/mesh.h"

namespace nonobtuse {

/// Which way the mesh is made.
enum class Method {
  Default,  ///< CVT, then refinement on the mesh: all angles inside the bounds
  Cvt,      ///< centroidal Voronoi tessellation alone (Yan & Wonka 2016, Eq. 1)
  CvtFs,    ///< CVT, then the feature-sensitive energy (Yan & Wonka 2016, Eq. 2)
  CvtNob,   ///< CVT, valence optimisation, short-dual penalty (Yan & Wonka 2016, Eq. 3-4), then
            ///< the same penalty with the feature-sensitive energy
};

/// How the target edge length varies over the surface.
enum class Sizing {
  Uniform,
  LocalFeatureSize,  ///< as lfs^(1/2): density 1/lfs^2, as in Yan & Wonka 2016
  Curvature,         ///< as curvature^(-1/2): chords at the same distance from the surface
  Given,             ///< `target_lengths`
};

/// Which edges of the input are features, to be edges of the result. Boundaries always are.
enum class Features {
  Auto,      ///< creases found by dihedral angle; a smooth surface, coarse or noisy, has none
  None,      ///< no creases
  Dihedral,  ///< edges at which the normal turns by `feature_angle` or more
  Given,     ///< `feature_edges` alone
};

/// What becomes of the vertices on the boundary of an open surface.
enum class Boundary {
  Resample,  ///< they move along the boundary curve; its corners stay
  Freeze,    ///< all vertices of the input's boundary stay, bit for bit, and no others come
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
  /// Creases, `Method::Default` only.
  Features features = Features::Auto;
  /// Features::Dihedral: in degrees, 0 < feature_angle <= 180.
  double feature_angle = 40;
  /// Pairs of input vertices that an edge joins, in addition to the creases that Features::Auto and
  /// Features::Dihedral find (`attribute_borders` gives those of a texture and labels).
  std::vector<std::array<Index, 2>> feature_edges = {};
  Boundary boundary = Boundary::Resample;
  Sizing sizing = Sizing::Uniform;
  /// Sizing::Given: the target edge length at every input vertex (#V, positive, input units).
  /// Scaled to the number of vertices asked for; if none is, they themselves say how many.
  std::vector<double> target_lengths = {};
  /// Bound on the growth of the target edge length along the surface, per length: h(x) <= h(y) +
  /// gradation |x - y|. > 0; infinite for no limit. Above 0.3 good angles get hard to reach.
  double gradation = 0.25;
  /// Bounds to reach, degrees: 0 <= min_angle < 60 < max_angle. The promise is [30, 90).
  double min_angle = 40;
  double max_angle = 80;
  /// Keep every vertex on the input surface instead of at the offset that minimises the distance;
  /// `Method::Default` only.
  bool on_surface = false;
  /// Bound on the two-sided distance between input and result, measured by sampling as
  /// `measure_distance` does, in input units; 0 = none. Vertices are added where it is exceeded
  /// until it holds: `vertices` (or the edge length) is then the start and no promise.
  double max_error = 0;
  /// The same relative to the diagonal of the input's bounding box; 0 = none.
  double relative_max_error = 0;
  /// Weight lambda of the short-dual penalty in `Method::CvtNob` (Eq. 3), times area / vertices.
  double penalty = 0.01;
  /// Weight s of the normal part of the feature-sensitive energy (Eq. 2), at least 1, in
  /// `Method::CvtFs` and `Method::CvtNob`; 1 leaves it out.
  double normal_weight = 5;
  /// L-BFGS iterations of every stage of the paper's methods (`Cvt`, `CvtFs`, `CvtNob`), at most;
  /// 0 = 40. Not used by `Method::Default`, which stops by itself.
  int iterations = 0;
  /// Note energy and bad triangles of iterations in `RemeshResult::history`. The mesh stays the
  /// same; finding out how many triangles of a CVT are obtuse costs time.
  bool history = false;
  /// Seed of the random sampling. Same input, options and seed: same bytes.
  std::uint64_t seed = 0;
};

}  // namespace nonobtuse
