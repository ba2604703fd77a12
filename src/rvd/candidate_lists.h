// Per facet, the sites that can own a part of it (method: facet candidate lists with a margin).
#pragma once

#include <span>
#include <vector>

#include "mesh/surface.h"
#include "nonobtuse/mesh.h"
#include "parallel/workers.h"

namespace nonobtuse::rvd {

/// Candidates of facet f: sites[start[f]] .. sites[start[f+1]-1], ascending, at least one. Every
/// site whose Voronoi cell meets the closed facet is among them, ties and rounding included.
struct FacetCandidates {
  std::vector<Index> start;  ///< #F + 1
  std::vector<Index> sites;

  [[nodiscard]] std::span<const Index> of(Index facet) const {
    return {sites.data() + start[facet], sites.data() + start[facet + 1]};
  }
};

/// Fresh lists for the given sites (#X by 3, #X >= 1; coincident sites allowed). Deterministic.
FacetCandidates facet_candidates(const mesh::Surface& surface, std::span<const Vec3> sites,
                                 const parallel::Workers& workers);

/// Integrals over the restricted Voronoi cells, uniform density.
struct CellIntegrals {
  double energy = 0;           ///< Eq. 1: sum over cells of the integral of |x - x_i|^2
  std::vector<double> mass;    ///< #X: area of each cell
  std::vector<Vec3> centroid;  ///< #X by 3; the site itself where the cell is empty
};

}  // namespace nonobtuse::rvd
