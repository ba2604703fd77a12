// One triangle cut into the parts that belong to several sites, in barycentric coordinates. The
// difference of the squared distances to two sites is linear on a triangle, so a bisector is given
// by its values at the three corners and a part is a convex polygon (Sutherland & Hodgman,
// Reentrant polygon clipping, 1974).
#pragma once

#include <array>
#include <span>
#include <vector>

#include "nonobtuse/mesh.h"

namespace nonobtuse::rvd {

/// Integrals of the three barycentric coordinates over a part, divided by the triangle's area.
/// Their sum is the part's share of the area; (1/3, 1/3, 1/3) is the whole triangle.
using Moments = std::array<double, 3>;
/// Squared distances of a site to the triangle's corners.
using CornerDistances = std::array<double, 3>;

inline constexpr Moments kWhole{1.0 / 3, 1.0 / 3, 1.0 / 3};

/// The whole triangle with a linear density.
inline Moments whole_moments(const std::array<double, 3>& rho) {
  const double sum = rho[0] + rho[1] + rho[2];
  return {(sum + rho[0]) / 12, (sum + rho[1]) / 12, (sum + rho[2]) / 12};
}

/// The part cut off at the corner whose value g[k] alone is positive (or alone is not).
inline Moments corner_moments(const std::array<double, 3>& g, int k) {
  const int l = k == 2 ? 0 : k + 1;
  const int m = k == 0 ? 2 : k - 1;
  const double s = g[k] / (g[k] - g[l]);
  const double t = g[k] / (g[k] - g[m]);
  const double third = s * t / 3;
  Moments part{};
  part[l] = third * s;
  part[m] = third * t;
  part[k] = third * (3 - s - t);
  return part;
}

/// The part of the first of two sites, g = d_second - d_first at the corners; ties to the first.
inline Moments first_of_two(const std::array<double, 3>& g) {
  const bool p0 = g[0] >= 0;
  const bool p1 = g[1] >= 0;
  const bool p2 = g[2] >= 0;
  const int positive = int{p0} + int{p1} + int{p2};
  if (positive == 3) return kWhole;
  if (positive == 0) return {0, 0, 0};
  if (positive == 1) return corner_moments(g, p0 ? 0 : (p1 ? 1 : 2));
  const Moments rest = corner_moments(g, !p0 ? 0 : (!p1 ? 1 : 2));
  return {1.0 / 3 - rest[0], 1.0 / 3 - rest[1], 1.0 / 3 - rest[2]};
}

/// Working memory of one thread.
class FacetClipper {
 public:
  /// moments[i] of the part nearest to site i, for any number of sites >= 1; ties to the lowest i.
  /// The parts' moments add up to kWhole (the last is what the others leave). Returns the sites
  /// that may own a part; the moments of all others are zero and not written.
  std::span<const Index> clip(std::span<const CornerDistances> d, std::span<Moments> moments);

  /// The same with a density that is linear on the triangle, `rho` at its corners: the moments are
  /// integrals of density times barycentric coordinate, and add up to those of the triangle.
  std::span<const Index> clip(std::span<const CornerDistances> d, const std::array<double, 3>& rho,
                              std::span<Moments> moments);

  /// Appends the pairs i < j whose parts share a piece of their bisector.
  void adjacent(std::span<const CornerDistances> d, std::vector<std::array<Index, 2>>& pairs);

 private:
  struct Corner {
    double u, v;  // weights of corners 1 and 2
  };
  void keep_possible_owners(std::span<const CornerDistances> d);
  template <bool Tagged>
  void make_part(std::span<const CornerDistances> d, Index i);
  template <bool Tagged>
  std::size_t cut_polygon(Index j);
  [[nodiscard]] Moments polygon_moments() const;
  [[nodiscard]] Moments polygon_moments(const std::array<double, 3>& rho) const;

  std::vector<Index> alive_;
  std::size_t size_ = 0;  // corners of the polygon
  std::vector<Corner> polygon_, next_;
  std::vector<double> g_;                // of each corner, positive on the side that is kept
  std::vector<char> in_;                 // whether it is kept
  std::vector<Index> edge_, next_edge_;  // site across the edge that starts at each corner, or -1
};

}  // namespace nonobtuse::rvd
