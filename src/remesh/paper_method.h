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
#include "remesh/penalized_energy.h"

namespace nonobtuse::pipeline {

/// How valences below 5 and above 7 are mended before the penalties.
enum class ValenceStep {
  None,
  Resampling,  ///< random places and local Lloyd steps, as the paper has it: leaves about half
  Edits,       ///< edits of the mesh (valence_optimization.h), whose vertices are the new sites
};

/// The removal of obtuse angles, with the energy of Eq. 1 and penalties.
struct PaperOptions {
  PenaltyWeights weights = {.short_dual = 0.01};
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

/// The feature-sensitive stage: minimises Eq. 2 with penalties from sites that a stage before left,
/// in at most `iterations`. With a penalty the best sites are chosen as above, so that angles never
/// get worse; without one they are those of the least energy (by cells that are no discs first).
std::vector<Vec3> optimize_feature_sensitive(const mesh::Surface& surface, std::vector<Vec3> sites,
                                             const PenaltyWeights& weights, int iterations,
                                             const parallel::Workers& workers,
                                             parallel::Monitor& monitor);

}  // namespace nonobtuse::pipeline
