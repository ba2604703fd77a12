// Centroidal Voronoi tessellation restricted to the surface (Yan & Wonka 2016, Eq. 1; Liu et al.,
// On centroidal Voronoi tessellation - energy smoothness and fast computation, 2009), coarse to
// fine: a good coarse tessellation, refined by the midpoints of its Delaunay edges, keeps its few
// irregular vertices, where a random start at full size leaves hundreds.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "mesh/surface.h"
#include "parallel/monitor.h"
#include "parallel/workers.h"
#include "rvd/cell_integrals.h"

namespace nonobtuse::pipeline {

/// Sites with the pairs of those whose cells touch.
struct TouchingSites {
  std::vector<Vec3> sites;                       ///< #X by 3
  std::vector<std::array<Index, 2>> adjacent{};  ///< i < j, sorted
};

struct CvtOptions {
  Index sites = 0;  ///< exactly this many, >= 1
  std::uint64_t seed = 0;
  /// Evaluations of the energy with all sites, and with about a quarter of them, at the most. They
  /// end earlier where `kStride` evaluations lower the energy by less than the tolerance (relative;
  /// 0 never): thin and knotty surfaces need three times as many as smooth ones.
  int iterations = 80;
  double tolerance = 4e-4;
  int coarse_iterations = 80;
  double coarse_tolerance = 2.5e-3;
  /// How often the sites are first quartered; 0 starts from random samples at full size. Parts
  /// with fewer than 64 sites are never quartered.
  int coarse_levels = 1;
  /// For a surface of one component the sites of the coarsest level, optimised already, if that is
  /// as many as are wanted there; else they are sampled.
  TouchingSites start{};
  /// Whether sites move from light cells into heavy ones before a level that comes of a coarser
  /// one.
  bool balanced = false;
  bool recorded = true;  ///< whether the iterations with all sites go into the history
};

/// Sites (#X by 3) on or near the surface that minimise the CVT energy, along a space-filling
/// curve. Every connected component keeps the sites that are its share by area, at least 4 (if
/// there are 4 for each). Cells that are empty keep their site. After a cancellation: the right
/// number of sites, as far as they came. Working coordinates. Same bits for any number of threads.
std::vector<Vec3> optimize_cvt(const mesh::Surface& surface, const CvtOptions& options,
                               const parallel::Workers& workers, parallel::Monitor& monitor);

/// The sites on one level alone, without a coarser one, and which cells touch: three pairs per
/// site, less three times the Euler characteristic, where a closed surface has cells that are discs
/// and meet once. After a cancellation there may be no pairs.
TouchingSites optimize_level(const mesh::Surface& surface, const CvtOptions& options,
                             const parallel::Workers& workers, parallel::Monitor& monitor);

/// Evaluations between two looks at the energy by which a descent ends early.
inline constexpr int kStride = 5;

/// Where a descent stands.
struct DescentState {
  int evaluations = 0;  ///< made so far
  double energy = 0;    ///< least so far
  std::span<const Vec3> sites;
};

/// Minimises the CVT energy by L-BFGS (m = 7, preconditioned by the cells' masses) with at most
/// `evaluations` evaluations, or until `kStride` of them gain less than `tolerance` (relative); the
/// first step is Lloyd's. `sites` become the best found. `callback` (may be empty) hears of each
/// evaluation before it is made; returning false stops. Sites marked in `fixed`
/// (#X, or empty) stay where they are. Returns the energy.
double minimize_cvt(rvd::CellEvaluator& evaluator, std::vector<Vec3>& sites, int evaluations,
                    double tolerance, const parallel::Workers& workers,
                    const std::function<bool(const DescentState&)>& callback,
                    std::span<const char> fixed = {});

}  // namespace nonobtuse::pipeline
