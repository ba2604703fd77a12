// The exact restricted Voronoi diagram (Yan et al. 2009; Levy, Bonneel 2012): the part of every
// facet nearest to each site, as a convex polygon with symbolic corners. Combinatorics are exact
// in the doubles given, ties broken by site index (numeric/side_predicates.h), so that pieces of
// neighbouring facets fit together whatever the input.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "mesh/surface.h"
#include "nonobtuse/mesh.h"
#include "numeric/side_predicates.h"
#include "parallel/workers.h"
#include "rvd/candidate_lists.h"

namespace nonobtuse::rvd {

using numeric::edge_of;
using numeric::edge_side;
using numeric::is_edge;
using numeric::Side;

/// Pieces of facet f: facet_start[f] .. facet_start[f+1]-1, by ascending site. Sides of piece p:
/// sides[side_start[p]] .. sides[side_start[p+1]-1], counter-clockwise; a side is the SITE across
/// it (>= 0) or edge_side(k) for the facet's edge k. Corner m lies between sides m-1 and m. The
/// corners are three or more and distinct (symbolically); their positions may coincide.
struct RestrictedVoronoi {
  std::vector<Index> facet_start;  ///< #F + 1
  std::vector<Index> site;         ///< #P
  std::vector<Index> side_start;   ///< #P + 1
  std::vector<Side> sides;

  [[nodiscard]] Index piece_count() const { return static_cast<Index>(site.size()); }
  [[nodiscard]] std::span<const Side> sides_of(Index piece) const {
    return {sides.data() + side_start[piece], sides.data() + side_start[piece + 1]};
  }
  /// The piece of a site in a facet, or -1.
  [[nodiscard]] Index find(Index facet, Index of_site) const;
  /// The piece across edge k of the facet: the same site's in the adjacent facet; -1 at a boundary.
  /// The piece must have that side.
  [[nodiscard]] Index across(const mesh::Surface& surface, Index facet, Index piece, int k) const;
};

/// Sites #X by 3, candidates as `facet_candidates` gives them. Deterministic.
RestrictedVoronoi restricted_voronoi(const mesh::Surface& surface, std::span<const Vec3> sites,
                                     const FacetCandidates& candidates,
                                     const parallel::Workers& workers);

/// Position of the corner of a cell between two sides (names as in RestrictedVoronoi), in doubles.
Vec3 corner_position(const mesh::Surface& surface, std::span<const Vec3> sites, Index facet,
                     Index site, Side before, Side after);

/// Positions of all corners of a piece, in order.
void corner_positions(const mesh::Surface& surface, std::span<const Vec3> sites,
                      const RestrictedVoronoi& diagram, Index facet, Index piece,
                      std::vector<Vec3>& out);

/// Part of the restricted edge between two cells inside one facet.
struct DualSegment {
  Index site = -1;   ///< the lower index
  Index other = -1;  ///< the higher one
  Index facet = -1;
  Vec3 from;  ///< `site` lies left of the way from `from` to `to`, seen along the facet's normal
  Vec3 to;
};

/// All segments, by facet, then site, then position in the piece.
std::vector<DualSegment> dual_segments(const mesh::Surface& surface, std::span<const Vec3> sites,
                                       const RestrictedVoronoi& diagram);

/// |dual(i, j)|: total length of the restricted edge between two cells.
struct DualEdge {
  Index site = -1;
  Index other = -1;  ///< > site
  double length = 0;
};

/// Sorted by (site, other); one entry for each pair of cells that touch.
std::vector<DualEdge> dual_edges(const mesh::Surface& surface, std::span<const Vec3> sites,
                                 const RestrictedVoronoi& diagram);

/// Integrals over the cells of the exact diagram; the density of the surface (size^-4, 1 if
/// uniform) is taken constant on the triangles that a piece falls into.
struct CellSums {
  double energy = 0;           ///< Eq. 1: sum over cells of the integral of |x - x_i|^2
  std::vector<double> mass;    ///< #X: of each cell; its area if the density is uniform
  std::vector<double> sites;   ///< #X: integral of size^-2, about 1; empty if uniform
  std::vector<Vec3> centroid;  ///< #X by 3; the site itself where the cell is empty
};

/// `owner` (#P): the cell each piece counts for, diagram.site for the plain cells.
CellSums cell_sums(const mesh::Surface& surface, std::span<const Vec3> sites,
                   const RestrictedVoronoi& diagram, std::span<const Index> owner);

}  // namespace nonobtuse::rvd
