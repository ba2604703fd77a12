// The facets of the surface as the floating-point engine walks them: cut where they are longer
// than a cell, ordered along a space-filling curve, grouped in chunks of some fifty cells. Depends
// on the surface and the number of sites alone, so that sums over chunks always have the same bits.
#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "mesh/surface.h"
#include "spatial/box.h"

namespace nonobtuse::rvd {

struct FacetPieces {
  std::vector<Vec3> vertices;                 ///< renumbered in order of first use
  std::vector<std::array<Index, 3>> corners;  ///< #P by 3, oriented like the facet
  std::vector<Index> facet;                   ///< #P: the facet each piece belongs to
  std::vector<double> area;                   ///< #P
  std::vector<Index> chunk_start;             ///< #chunks + 1: the pieces of each chunk
  std::vector<spatial::Box> box;              ///< #chunks
  double spacing = 0;                         ///< h: mean distance of neighbouring sites
  std::vector<double> size;        ///< #vertices: local distance in units of h; empty: uniform
  std::vector<double> chunk_size;  ///< #chunks: the largest size in each; empty: uniform

  [[nodiscard]] std::array<Vec3, 3> corners_of(Index piece) const {
    const std::array<Index, 3>& t = corners[piece];
    return {vertices[t[0]], vertices[t[1]], vertices[t[2]]};
  }
  [[nodiscard]] bool uniform() const { return size.empty(); }
  /// Density at the corners of a piece: size^-4.
  [[nodiscard]] std::array<double, 3> density_of(Index piece) const {
    std::array<double, 3> rho{1, 1, 1};
    if (uniform()) return rho;
    for (int k = 0; k < 3; ++k) {
      const double s = size[corners[piece][k]];
      rho[k] = 1 / (s * s * s * s);
    }
    return rho;
  }
  /// Mean distance of neighbouring sites in a chunk, at its largest.
  [[nodiscard]] double chunk_spacing(Index chunk) const {
    return uniform() ? spacing : spacing * chunk_size[chunk];
  }
  /// The same at a piece, at its least.
  [[nodiscard]] double piece_spacing(Index piece) const {
    if (uniform()) return spacing;
    const std::array<Index, 3>& t = corners[piece];
    return spacing * std::min({size[t[0]], size[t[1]], size[t[2]]});
  }
  [[nodiscard]] Index count() const { return static_cast<Index>(corners.size()); }
  [[nodiscard]] Index chunk_count() const { return static_cast<Index>(box.size()); }
};

/// Largest squared distance of x to a corner, hence to any point of the triangle.
inline double farthest_corner2(const std::array<Vec3, 3>& corners, const Vec3& x) {
  return std::max({squared_distance(corners[0], x), squared_distance(corners[1], x),
                   squared_distance(corners[2], x)});
}

/// The box grown by `by` on all sides.
inline spatial::Box inflated(spatial::Box box, double by) {
  box.low = box.low - Vec3{by, by, by};
  box.high += Vec3{by, by, by};
  return box;
}

/// What a piece counts in numbers of sites: its area times the mean of size^-2.
inline double sites_of(const FacetPieces& pieces, Index piece) {
  if (pieces.uniform()) return pieces.area[piece];
  double sum = 0;
  for (const Index v : pieces.corners[piece]) sum += 1 / (pieces.size[v] * pieces.size[v]);
  return pieces.area[piece] * sum / 3;
}

/// Bisects facets at their longest edge until no edge is longer than 2h, where
/// h = sqrt(2 area / (sqrt(3) site_count)) is the edge of a regular triangulation. With sizes h is
/// the local one, and edges along which it varies much are bisected too, since the density is taken
/// linear on a piece. The pieces need not be conforming. O(#P log #P) time, O(#P) memory.
FacetPieces facet_pieces(const mesh::Surface& surface, Index site_count);

}  // namespace nonobtuse::rvd
