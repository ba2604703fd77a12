// The paper's own removal of obtuse angles: Yan & Wonka, Non-obtuse Remeshing with Centroidal
// Voronoi Tessellation, TVCG 2016, sections 4.2-4.3. After a CVT: valence optimisation, then
// CVT + penalty by L-BFGS on restricted Voronoi diagrams. `Method::CvtNob`; the default method
// replaces it by refinement on the mesh, which is faster and comes out better.
#pragma once

#include <cstdint>
#include <vector>

#include "mesh/surface.h"
#include "parallel/monitor.h"
#include "parallel/workers.h"

namespace nonobtuse::pipeline {

/// How valences below 5 and above 7 are mended before the penalties.
enum class ValenceStep {
  None,
  Resampling,  ///< random places and local Lloyd steps, as the paper has it: leaves about half
  Edits,       ///< edits of the mesh (valence_optimization.h), whose vertices are the new sites
};

/// Terms added to the CVT energy of Eq. 1 (uniform density, without factor 1/2), each scaled so
/// that its weight means the same for any model and number of sites. All may be combined.
struct PaperOptions {
  /// lambda of Eq. 3, times area / #X. Useful from .003 to .03; at .1 and above the penalty is far
  /// stiffer than the CVT (126 times at 1): it over-smooths and stalls.
  double short_dual = 0.01;
  /// epsilon of Eq. 4, relative to the edge's length.
  double relative_epsilon = 0.1;
  /// Drop the normal part of the penalty's vectors r_i. Without (as in the paper) sites that are
  /// held on the surface come out closer to it, with it the angles are a little better.
  bool tangential = false;
  /// Weight of the circumcentre term (Sieger et al. 2010), times area / #X; not in the paper.
  double circumcentre = 0;
  /// Weight of the angle hinge, times 6.23 F_cvt / #X; not in the paper.
  double hinge = 0;
  double hinge_small = 35;  ///< degrees: smaller angles are penalised by the hinge
  double hinge_large = 86;  ///< degrees: larger ones too
  ValenceStep valence = ValenceStep::Edits;
  int resampling_rounds = 20;  ///< with ValenceStep::Resampling
  std::uint64_t seed = 0;      ///< with ValenceStep::Resampling
  int iterations = 40;         ///< of L-BFGS, at most
};

/// Moves the sites (#X by 3) of a CVT until no triangle of their restricted Delaunay triangulation
/// is obtuse, or the iterations are spent. Every trial step is projected on the surface; the best
/// sites seen are returned, by (cells that are no discs, obtuse triangles, triangles with an angle
/// below 30, energy). Working coordinates. Deterministic for any number of threads.
std::vector<Vec3> optimize_paper_nob(const mesh::Surface& surface, std::vector<Vec3> sites,
                                     const PaperOptions& options, const parallel::Workers& workers,
                                     parallel::Monitor& monitor);

}  // namespace nonobtuse::pipeline
