// Initial sites: stratified by area along a space-filling curve (method: step 1 of Yan & Wonka
// 2016, Sec. 4.2, with one sample per stratum instead of independent ones).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "mesh/surface.h"

namespace nonobtuse::pipeline {

/// Connected components of the surface.
struct Components {
  std::vector<Index> of_triangle;       ///< #F
  std::vector<double> area;             ///< #C
  std::vector<Index> euler;             ///< #C: Euler characteristic
  std::vector<double> boundary_length;  ///< #C
  [[nodiscard]] Index count() const { return static_cast<Index>(area.size()); }
};
Components connected_components(const mesh::Surface& surface);

/// Sites per component, in proportion to area by largest remainders, and at least `least[c]` each
/// (empty: 4, what a closed mesh needs) as long as there are enough; with fewer sites the largest
/// components come first.
std::vector<Index> share_sites(const Components& components, Index sites,
                               std::span<const Index> least = {});

struct SampledSites {
  std::vector<Vec3> points;      ///< #X by 3, on the surface, along the curve
  std::vector<Index> component;  ///< #X
};

/// quota[c] points on component c: its area (with sizes: the integral of rho^(1/2), the density of
/// sites), taken along the curve, is cut into quota[c] equal strata with one uniformly distributed
/// point in each. Same seed, same points.
SampledSites sample_strata(const mesh::Surface& surface, const Components& components,
                           const std::vector<Index>& quota, std::uint64_t seed);

}  // namespace nonobtuse::pipeline
