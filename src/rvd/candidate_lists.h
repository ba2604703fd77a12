// Per facet, the sites that can own a part of it (method: facet candidate lists with a margin).
#pragma once

#include <array>
#include <span>
#include <vector>

#include "mesh/surface.h"
#include "nonobtuse/mesh.h"
#include "parallel/workers.h"
#include "rvd/site_grid.h"
#include "spatial/box.h"

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

/// Finds candidate lists of facets near one another; the working memory of one thread.
///
/// With d_j(p) = |p - x_j|^2, d_j - d_k is linear on a facet, so the values at its corners decide:
/// j can be dropped if some k in the list has d_j >= d_k + 4 m (R_k + m) at all three corners, R_k
/// the largest distance of x_k to a corner. Then no site wrongly dropped can own a point of the
/// facet until some site has moved by more than the margin m.
class CandidateLister {
 public:
  explicit CandidateLister(Index site_count) : local_(site_count, -1) {}

  /// Starts with the sites inside `region`, which must contain every site that could matter.
  void begin(const SiteGrid& grid, std::span<const Vec3> sites, const spatial::Box& region);
  /// Announces a facet whose nearest site (about) is `base`, at most `radius` from its corners.
  void announce(Index base, double radius, double margin);
  /// Lists an announced facet into `out` (global indices, ascending). Returns the margin for which
  /// the list holds: at least `margin`, more if a single site is left, at most `largest`.
  double list(const std::array<Vec3, 3>& corners, Index base, double radius, double margin,
              double largest, std::vector<Index>& out);

 private:
  struct Neighbor {
    double distance2;
    Index local;
  };
  struct Near {  // the sites around one base, in order of distance, up to `reach`
    double reach = 0;
    std::size_t begin = 0;
    std::size_t end = 0;
    bool built = false;
  };
  struct Candidate {
    std::array<double, 3> d;  // squared distances to the corners
    double slack;             // 4 m (R + m)
    Index local;
  };
  Index local_of(Index site);
  void build(Near& near, Index local);
  [[nodiscard]] Candidate candidate(const std::array<Vec3, 3>& corners, Index local) const;
  void scan(const std::array<Vec3, 3>& corners, const Near& near, double reach, double margin);
  void prune();

  std::vector<Index> local_;  // #X: index among the gathered, or -1
  std::vector<Index> gathered_;
  std::span<const Vec3> sites_;
  std::vector<double> x_, y_, z_;  // coordinates of the gathered
  std::vector<double> distance2_;
  std::vector<Near> near_;
  std::vector<Neighbor> neighbors_;
  std::vector<Candidate> candidates_;
};

}  // namespace nonobtuse::rvd
