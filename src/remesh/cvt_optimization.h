// Centroidal Voronoi tessellation restricted to the surface (Yan & Wonka 2016, Eq. 1; Liu et al.,
// On centroidal Voronoi tessellation - energy smoothness and fast computation, 2009), coarse to
// fine: a good coarse tessellation, refined by the midpoints of its Delaunay edges, keeps its few
// irregular vertices, where a random start at full size leaves hundreds.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "mesh/surface.h"
#include "parallel/monitor.h"
#include "parallel/workers.h"
#include "rvd/cell_integrals.h"

namespace nonobtuse::pipeline {

struct CvtOptions {
  Index sites = 0;  ///< exactly this many, >= 1
  std::uint64_t seed = 0;
  /// Evaluations of the energy with all sites. 10 suffice for the angle bounds after refinement and
  /// a mean quality of .955 on smooth models; thin parts profit from more. Plain CVT, as the
  /// paper's, wants 40 or more.
  int iterations = 20;
  int coarse_iterations = 20;  ///< evaluations with about a quarter of the sites
  /// How often the sites are first quartered; 0 starts from random samples at full size. Parts
  /// with fewer than 64 sites are never quartered.
  int coarse_levels = 1;
};

/// Sites (#X by 3) on or near the surface that minimise the CVT energy, along a space-filling
/// curve. Every connected component keeps the sites that are its share by area, at least 4 (if
/// there are 4 for each). Cells that are empty keep their site. After a cancellation: the right
/// number of sites, as far as they came. Working coordinates. Same bits for any number of threads.
std::vector<Vec3> optimize_cvt(const mesh::Surface& surface, const CvtOptions& options,
                               const parallel::Workers& workers, parallel::Monitor& monitor);

/// Minimises the CVT energy by L-BFGS (m = 7, preconditioned by the cells' masses) with at most
/// `evaluations` evaluations; the first step is Lloyd's. `sites` become the best found. `callback`
/// (may be empty) hears the number of each evaluation; returning false stops. Returns the energy.
double minimize_cvt(rvd::CellEvaluator& evaluator, std::vector<Vec3>& sites, int evaluations,
                    const parallel::Workers& workers, const std::function<bool(int)>& callback);

}  // namespace nonobtuse::pipeline
