#include "rvd/site_grid.h"

#include <algorithm>
#include <cstdlib>

#include "numeric/random.h"

namespace nonobtuse::rvd {
namespace {

// Cells beyond the range of a key share the outermost ones: slower, never wrong.
constexpr std::int32_t kOutermost = (1 << 20) - 1;

std::int32_t to_cell(double x) {
  const double bound = kOutermost;
  const double inside = x > -bound ? (x < bound ? x : bound) : -bound;
  const auto k = static_cast<std::int32_t>(inside);  // towards zero
  return k > inside ? k - 1 : k;
}

std::uint64_t key_of(const std::array<std::int32_t, 3>& c) {
  std::uint64_t key = 0;
  for (const std::int32_t k : c) key = (key << 21) | static_cast<std::uint32_t>(k + kOutermost + 1);
  return key;
}

}  // namespace

SiteGrid::Cell SiteGrid::cell_of(const Vec3& p) const {
  const Vec3 q = inverse_cell_ * (p - origin_);
  return {to_cell(q.x), to_cell(q.y), to_cell(q.z)};
}

std::size_t SiteGrid::bucket_of(std::uint64_t key) const { return numeric::mix64(key) & mask_; }

void SiteGrid::build(std::span<const Vec3> sites, double cell) {
  sites_ = sites;
  cell_ = cell;
  inverse_cell_ = 1 / cell;
  origin_ = sites.empty() ? Vec3{} : sites[0];
  std::size_t buckets = 1;
  while (buckets < sites.size()) buckets *= 2;
  mask_ = buckets - 1;
  start_.assign(buckets + 1, 0);
  std::vector<std::uint64_t> key(sites.size());
  for (std::size_t i = 0; i < sites.size(); ++i) {
    key[i] = key_of(cell_of(sites[i]));
    ++start_[bucket_of(key[i]) + 1];
  }
  for (std::size_t b = 0; b < buckets; ++b) start_[b + 1] += start_[b];
  entries_.resize(sites.size());
  for (std::size_t i = sites.size(); i-- > 0;)  // backwards: ascending inside each bucket
    entries_[--start_[bucket_of(key[i]) + 1]] = {sites[i], key[i], static_cast<Index>(i)};
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
        const std::uint64_t key = key_of({x, y, z});
        const std::size_t b = bucket_of(key);
        for (Index e = start_[b]; e < start_[b + 1]; ++e)
          if (entries_[e].key == key && inside(entries_[e].point)) out.push_back(entries_[e].site);
      }
}

void SiteGrid::improve(const Vec3& p, const Cell& c, double& best, Index& site) const {
  const std::size_t b = bucket_of(key_of(c));
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
  const Vec3 q = inverse_cell_ * (p - origin_);
  // Distance of p to the cells at offset k along one axis, in cell edges, less rounding.
  const auto gap = [](double x, std::int32_t cell, std::int32_t k) {
    if (k == 0) return 0.0;
    return std::max(0.0, (k > 0 ? cell + k - x : x - (cell + k + 1)) - 1e-6);
  };
  improve(p, center, best, site);
  for (std::int32_t ring = 1; ring <= kRings; ++ring) {
    const double limit = inverse_cell_ * inverse_cell_;
    bool reached = false;
    for (std::int32_t z = -ring; z <= ring; ++z) {
      const double dz = gap(q.z, center[2], z);
      for (std::int32_t y = -ring; y <= ring; ++y) {
        const double dy = gap(q.y, center[1], y);
        if (dz * dz + dy * dy > limit * best) continue;
        const bool face = std::abs(z) == ring || std::abs(y) == ring;
        for (std::int32_t x = -ring; x <= ring; x += face ? 1 : 2 * ring) {
          const double dx = gap(q.x, center[0], x);
          if (dx * dx + dy * dy + dz * dz > limit * best) continue;
          reached = true;
          improve(p, {center[0] + x, center[1] + y, center[2] + z}, best, site);
        }
      }
    }
    if (!reached) return site;  // further rings are further away
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
