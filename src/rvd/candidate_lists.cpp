#include "rvd/candidate_lists.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "parallel/pool.h"
#include "rvd/facet_pieces.h"

namespace nonobtuse::rvd {
namespace {

bool dominated(const std::array<double, 3>& d, const std::array<double, 3>& by, double slack) {
  return (d[0] >= by[0] + slack) & (d[1] >= by[1] + slack) & (d[2] >= by[2] + slack);
}

}  // namespace

void CandidateLister::begin(const SiteGrid& grid, std::span<const Vec3> sites,
                            const spatial::Box& region) {
  for (const Index site : gathered_) local_[site] = -1;
  gathered_.clear();
  neighbors_.clear();
  sites_ = sites;
  grid.gather(region, gathered_);
  const std::size_t count = gathered_.size();
  x_.resize(count);
  y_.resize(count);
  z_.resize(count);
  near_.assign(count, {});
  for (std::size_t i = 0; i < count; ++i) {
    local_[gathered_[i]] = static_cast<Index>(i);
    const Vec3& x = sites[gathered_[i]];
    x_[i] = x.x;
    y_[i] = x.y;
    z_[i] = x.z;
  }
}

Index CandidateLister::local_of(Index site) {
  if (local_[site] < 0) {
    local_[site] = static_cast<Index>(gathered_.size());
    gathered_.push_back(site);
    x_.push_back(sites_[site].x);
    y_.push_back(sites_[site].y);
    z_.push_back(sites_[site].z);
    near_.emplace_back();
  }
  return local_[site];
}

void CandidateLister::announce(Index base, double radius, double margin) {
  Near& near = near_[local_of(base)];
  near.reach = std::max(near.reach, 2 * (radius + margin));
}

void CandidateLister::build(Near& near, Index local) {
  near.built = true;
  near.begin = neighbors_.size();
  const std::size_t count = x_.size();
  const Vec3 center{x_[local], y_[local], z_[local]};
  const double limit = near.reach * near.reach;
  distance2_.resize(count);
  for (std::size_t j = 0; j < count; ++j) {  // apart from the selection: vectorises
    const double dx = x_[j] - center.x;
    const double dy = y_[j] - center.y;
    const double dz = z_[j] - center.z;
    distance2_[j] = dx * dx + dy * dy + dz * dz;
  }
  for (std::size_t j = 0; j < count; ++j)
    if (distance2_[j] <= limit && static_cast<Index>(j) != local)
      neighbors_.push_back({distance2_[j], static_cast<Index>(j)});
  near.end = neighbors_.size();
  std::sort(neighbors_.begin() + static_cast<std::ptrdiff_t>(near.begin), neighbors_.end(),
            [](const Neighbor& a, const Neighbor& b) {
              return a.distance2 != b.distance2 ? a.distance2 < b.distance2 : a.local < b.local;
            });
}

inline CandidateLister::Candidate CandidateLister::candidate(const std::array<Vec3, 3>& corners,
                                                             Index local) const {
  const Vec3 x{x_[local], y_[local], z_[local]};
  return {{squared_distance(corners[0], x), squared_distance(corners[1], x),
           squared_distance(corners[2], x)},
          0,
          local};
}

// Nearest sites first, so that most others are dropped at once.
void CandidateLister::scan(const std::array<Vec3, 3>& corners, const Near& near, double reach,
                           double margin) {
  const auto add = [&](Candidate c) {
    const double radius = std::sqrt(std::max({c.d[0], c.d[1], c.d[2]}));
    c.slack = 4 * margin * (radius + margin);
    candidates_.push_back(c);
  };
  for (std::size_t n = near.begin; n < near.end; ++n) {
    if (neighbors_[n].distance2 > reach * reach) break;
    const Candidate c = candidate(corners, neighbors_[n].local);
    const bool drop = std::any_of(candidates_.begin(), candidates_.end(),
                                  [&](const Candidate& k) { return dominated(c.d, k.d, k.slack); });
    if (!drop) add(c);
  }
}

void CandidateLister::prune() {
  for (std::size_t i = 0; i < candidates_.size();) {
    bool drop = false;
    for (std::size_t k = i + 1; k < candidates_.size() && !drop; ++k)
      drop = dominated(candidates_[i].d, candidates_[k].d, candidates_[k].slack);
    if (drop)
      candidates_.erase(candidates_.begin() + static_cast<std::ptrdiff_t>(i));
    else
      ++i;
  }
}

double CandidateLister::list(const std::array<Vec3, 3>& corners, Index base, double radius,
                             double margin, double largest, std::vector<Index>& out) {
  const Index local = local_of(base);
  if (!near_[local].built) build(near_[local], local);
  const Near& near = near_[local];
  out.clear();
  const double nearest =
      near.begin < near.end ? std::sqrt(neighbors_[near.begin].distance2) : near.reach;
  // |x_j - x_b| > 2 (R + m) puts j out of reach of every point within R of x_b.
  if (nearest > 2 * (radius + margin)) {
    out.push_back(base);
    return std::min(largest, 0.5 * nearest - radius);
  }
  candidates_.clear();
  Candidate first = candidate(corners, local);
  first.slack = 4 * margin * (radius + margin);
  candidates_.push_back(first);
  scan(corners, near, 2 * (radius + margin), margin);
  prune();
  for (const Candidate& c : candidates_) out.push_back(gathered_[c.local]);
  std::sort(out.begin(), out.end());
  return margin;
}

namespace {

// Union of the pieces' lists, facet by facet; the pieces of a facet are scattered along the order.
FacetCandidates unite(const FacetPieces& pieces, std::size_t facets,
                      const std::vector<std::vector<Index>>& lists) {
  std::vector<Index> start(facets + 1, 0);
  for (const Index f : pieces.facet) ++start[f + 1];
  for (std::size_t f = 0; f < facets; ++f) start[f + 1] += start[f];
  std::vector<Index> fill(start.begin(), start.end() - 1);
  std::vector<Index> piece_of(pieces.count());
  for (Index p = 0; p < pieces.count(); ++p) piece_of[fill[pieces.facet[p]]++] = p;

  FacetCandidates result;
  result.start.assign(1, 0);
  std::vector<Index> merged;
  for (std::size_t f = 0; f < facets; ++f) {
    merged.clear();
    for (Index k = start[f]; k < start[f + 1]; ++k)
      merged.insert(merged.end(), lists[piece_of[k]].begin(), lists[piece_of[k]].end());
    std::sort(merged.begin(), merged.end());
    merged.erase(std::unique(merged.begin(), merged.end()), merged.end());
    result.sites.insert(result.sites.end(), merged.begin(), merged.end());
    result.start.push_back(static_cast<Index>(result.sites.size()));
  }
  return result;
}

}  // namespace

FacetCandidates facet_candidates(const mesh::Surface& surface, std::span<const Vec3> sites,
                                 const parallel::Workers& workers) {
  const FacetPieces pieces = facet_pieces(surface, static_cast<Index>(sites.size()));
  // Far above the rounding of squared distances and of the pieces' corners, far below any cell.
  const double margin = 1e-8 * pieces.spacing;
  SiteGrid grid;
  grid.build(sites, pieces.spacing > 0 ? 2.5 * pieces.spacing : 1.0);
  const auto count = static_cast<Index>(sites.size());
  parallel::Pool<CandidateLister> pool(
      [count] { return std::make_unique<CandidateLister>(count); });

  std::vector<std::vector<Index>> lists(pieces.count());
  workers.for_each(pieces.chunk_count(), 1, [&](std::size_t chunk) {
    const Index begin = pieces.chunk_start[chunk];
    const Index end = pieces.chunk_start[chunk + 1];
    std::vector<Index> base(end - begin);
    std::vector<double> radius(end - begin);
    double largest = 0;
    Index hint = 0;
    for (Index p = begin; p < end; ++p) {
      const std::array<Vec3, 3> c = pieces.corners_of(p);
      hint = base[p - begin] = grid.nearest((c[0] + c[1] + c[2]) / 3, hint);
      radius[p - begin] = std::sqrt(farthest_corner2(c, sites[hint]));
      largest = std::max(largest, radius[p - begin]);
    }
    pool.with([&](CandidateLister& lister) {
      lister.begin(grid, sites, inflated(pieces.box[chunk], 1.001 * largest + 4 * margin));
      for (Index p = begin; p < end; ++p)
        lister.announce(base[p - begin], radius[p - begin], margin);
      for (Index p = begin; p < end; ++p)
        lister.list(pieces.corners_of(p), base[p - begin], radius[p - begin], margin, margin,
                    lists[p]);
    });
  });
  return unite(pieces, surface.triangles.size(), lists);
}

}  // namespace nonobtuse::rvd
