// Centroidal Voronoi tessellation restricted to the surface (Yan & Wonka 2016, Eq. 1; Liu et al.
// 2009), coarse to fine.
#pragma once

#include <cstdint>
#include <vector>

#include "mesh/surface.h"
#include "parallel/monitor.h"
#include "parallel/workers.h"

namespace nonobtuse::remesh {

struct CvtOptions {
  Index sites = 0;  ///< exactly this many
  std::uint64_t seed = 0;
  int iterations = 40;  ///< L-BFGS evaluations at the finest level
};

/// Sites (#X by 3) on or near the surface that minimise the CVT energy. Working coordinates.
std::vector<Vec3> optimize_cvt(const mesh::Surface& surface, const CvtOptions& options,
                               const parallel::Workers& workers, parallel::Monitor& monitor);

}  // namespace nonobtuse::remesh
