#include "spatial/hilbert_order.h"

#include <algorithm>
#include <array>
#include <cstdint>

namespace nonobtuse::spatial {
namespace {

// Per axis: finer than any chunk needs, and 33 bits of key leave 31 for the index.
constexpr int kBits = 11;

// Skilling's AxestoTranspose for three axes, then the bits interleaved.
std::uint64_t hilbert_key(std::array<std::uint32_t, 3> x) {
  for (std::uint32_t q = 1U << (kBits - 1); q > 1; q >>= 1) {
    const std::uint32_t p = q - 1;
    for (std::uint32_t& axis : x) {
      if ((axis & q) != 0) {
        x[0] ^= p;
      } else {
        const std::uint32_t t = (x[0] ^ axis) & p;
        x[0] ^= t;
        axis ^= t;
      }
    }
  }
  x[1] ^= x[0];
  x[2] ^= x[1];
  std::uint32_t t = 0;
  for (std::uint32_t q = 1U << (kBits - 1); q > 1; q >>= 1)
    if ((x[2] & q) != 0) t ^= q - 1;
  std::uint64_t key = 0;
  for (int bit = kBits - 1; bit >= 0; --bit)
    for (const std::uint32_t axis : x) key = (key << 1) | (((axis ^ t) >> bit) & 1U);
  return key;
}

}  // namespace

std::vector<Index> hilbert_order(std::span<const Vec3> points) {
  std::vector<Index> order(points.size());
  if (points.empty()) return order;
  Vec3 low = points[0];
  Vec3 high = points[0];
  for (const Vec3& p : points) {
    low = min(low, p);
    high = max(high, p);
  }
  const Vec3 extent = high - low;
  const double side = std::max({extent.x, extent.y, extent.z});
  const double scale = side > 0 ? ((1 << kBits) - 1) / side : 0.0;
  std::vector<std::uint64_t> keys(points.size());  // key, then index
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec3 q = scale * (points[i] - low);
    const std::uint64_t key =
        hilbert_key({static_cast<std::uint32_t>(q.x), static_cast<std::uint32_t>(q.y),
                     static_cast<std::uint32_t>(q.z)});
    keys[i] = (key << 31) | i;
  }
  std::sort(keys.begin(), keys.end());
  for (std::size_t i = 0; i < keys.size(); ++i)
    order[i] = static_cast<Index>(keys[i] & 0x7fffffffU);
  return order;
}

}  // namespace nonobtuse::spatial
