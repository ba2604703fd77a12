#include "rvd/site_grid.h"

#include <algorithm>
#include <cmath>

#include "numeric/random.h"

namespace nonobtuse::rvd {
namespace {

std::int32_t to_cell(double x) {
  return static_cast<std::int32_t>(std::clamp(std::floor(x), -1e9, 1e9));
}

}  // namespace

SiteGrid::Cell SiteGrid::cell_of(const Vec3& p) const {
  const Vec3 q = inverse_cell_ * (p - origin_);
  return {to_cell(q.x), to_cell(q.y), to_cell(q.z)};
}

std::size_t SiteGrid::bucket_of(const Cell& c) const {
  std::uint64_t key = 0;
  for (const std::int32_t k : c) key = key * 0x9e3779b97f4a7c15ULL + static_cast<std::uint32_t>(k);
  return numeric::mix64(key) & mask_;
}

void SiteGrid::build(std::span<const Vec3> sites, double cell) {
  sites_ = sites;
  cell_ = cell;
  inverse_cell_ = 1 / cell;
  origin_ = sites.empty() ? Vec3{} : sites[0];
  std::size_t buckets = 1;
  while (buckets < sites.size()) buckets *= 2;
  mask_ = buckets - 1;
  start_.assign(buckets + 1, 0);
  std::vector<std::size_t> bucket(sites.size());
  for (std::size_t i = 0; i < sites.size(); ++i) {
    bucket[i] = bucket_of(cell_of(sites[i]));
    ++start_[bucket[i] + 1];
  }
  for (std::size_t b = 0; b < buckets; ++b) start_[b + 1] += start_[b];
  entries_.resize(sites.size());
  for (std::size_t i = sites.size(); i-- > 0;)  // backwards: ascending inside each bucket
    entries_[--start_[bucket[i] + 1]] = {sites[i], cell_of(sites[i]), static_cast<Index>(i)};
  // Now start_[b + 1] is the start of bucket b: shift back.
  for (std::size_t b = 0; b < buckets; ++b) start_[b] = start_[b + 1];
  start_[buckets] = static_cast<Index>(sites.size());
}

void SiteGrid::gather(const spatial::Box& box, std::vector<Index>& out) const {
  const Cell low = cell_of(box.low);
  const Cell high = cell_of(box.high);
  const auto inside = [&](const Vec3& p) {
    return p.x >= box.low.x && p.y >= box.low.y && p.z >= box.low.z && p.x <= box.high.x &&
           p.y <= box.high.y && p.z <= box.high.z;
  };
  double cells = 1;
  for (int k = 0; k < 3; ++k) cells *= 1.0 + high[k] - static_cast<double>(low[k]);
  if (cells > static_cast<double>(sites_.size())) {  // fewer sites than cells
    for (std::size_t i = 0; i < sites_.size(); ++i)
      if (inside(sites_[i])) out.push_back(static_cast<Index>(i));
    return;
  }
  for (std::int32_t z = low[2]; z <= high[2]; ++z)
    for (std::int32_t y = low[1]; y <= high[1]; ++y)
      for (std::int32_t x = low[0]; x <= high[0]; ++x) {
        const Cell c{x, y, z};
        const std::size_t b = bucket_of(c);
        for (Index e = start_[b]; e < start_[b + 1]; ++e)
          if (entries_[e].cell == c && inside(entries_[e].point)) out.push_back(entries_[e].site);
      }
}

void SiteGrid::improve(const Vec3& p, const Cell& c, double& best, Index& site) const {
  const std::size_t b = bucket_of(c);
  for (Index e = start_[b]; e < start_[b + 1]; ++e) {
    const double d = squared_distance(p, entries_[e].point);
    if (d < best || (d == best && entries_[e].site < site)) {
      best = d;
      site = entries_[e].site;
    }
  }
}

Index SiteGrid::nearest(const Vec3& p, Index hint) const {
  constexpr std::int32_t kRings = 4;
  Index site = hint;
  double best = squared_distance(p, sites_[hint]);
  const Cell center = cell_of(p);
  // Ring k of cells around p's own contains every point nearer than k cell edges (less rounding).
  for (std::int32_t ring = 0; ring <= kRings; ++ring) {
    const double reach = (ring - 1 - 1e-6) * cell_;
    if (ring > 0 && best < reach * reach) return site;
    for (std::int32_t z = -ring; z <= ring; ++z)
      for (std::int32_t y = -ring; y <= ring; ++y) {
        const bool face = std::abs(z) == ring || std::abs(y) == ring;
        for (std::int32_t x = -ring; x <= ring; x += face || ring == 0 ? 1 : 2 * ring)
          improve(p, {center[0] + x, center[1] + y, center[2] + z}, best, site);
      }
  }
  for (std::size_t i = 0; i < sites_.size(); ++i) {
    const double d = squared_distance(p, sites_[i]);
    if (d < best || (d == best && static_cast<Index>(i) < site)) {
      best = d;
      site = static_cast<Index>(i);
    }
  }
  return site;
}

}  // namespace nonobtuse::rvd
