#include "spatial/hilbert_order.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>

namespace nonobtuse::spatial {
namespace {

// Per axis: finer than any chunk needs, and 33 bits of key leave 31 for the index.
constexpr int kBits = 11;
constexpr int kStates = 96;

// Skilling's transform, level by level from the coarsest bits, as an automaton: what the levels
// above do to the bits below is an order of the axes, a reflection of each, and the parity that
// turns the Gray code's bits. A state numbers these, 16 * order + 2 * reflections + parity.
struct Automaton {
  std::array<std::array<std::uint8_t, 8>, kStates> digit{};  // three bits of the key
  std::array<std::array<std::uint8_t, 8>, kStates> next{};
};

constexpr std::array<std::array<int, 3>, 6> kOrders{
    {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}}};

constexpr int number_of(const std::array<int, 3>& order) {
  for (int k = 0; k < 6; ++k)
    if (kOrders[k] == order) return k;
  return -1;
}

constexpr Automaton make_automaton() {
  Automaton automaton;
  for (int state = 0; state < kStates; ++state) {
    for (int bits = 0; bits < 8; ++bits) {
      // After the levels above, axis i shows bit order[i] of the input, reflected.
      std::array<int, 3> order = kOrders[state / 16];
      std::array<int, 3> reflected{(state >> 1) & 1, (state >> 2) & 1, (state >> 3) & 1};
      std::array<int, 3> b{};
      for (int i = 0; i < 3; ++i) b[i] = ((bits >> order[i]) & 1) ^ reflected[i];
      for (int i = 0; i < 3; ++i) {
        if (b[i] != 0) {
          reflected[0] ^= 1;
        } else {
          std::swap(order[0], order[i]);
          std::swap(reflected[0], reflected[i]);
        }
      }
      const int parity = state & 1;
      const int g1 = b[1] ^ b[0];
      const int g2 = b[2] ^ g1;
      automaton.digit[state][bits] =
          static_cast<std::uint8_t>(((b[0] ^ parity) << 2) | ((g1 ^ parity) << 1) | (g2 ^ parity));
      automaton.next[state][bits] =
          static_cast<std::uint8_t>(16 * number_of(order) + 2 * reflected[0] + 4 * reflected[1] +
                                    8 * reflected[2] + (parity ^ g2));
    }
  }
  return automaton;
}

constexpr Automaton kAutomaton = make_automaton();

std::uint64_t hilbert_key(std::uint32_t x, std::uint32_t y, std::uint32_t z) {
  std::uint64_t key = 0;
  std::uint8_t state = 0;
  for (int bit = kBits - 1; bit >= 0; --bit) {
    const std::uint32_t bits = ((x >> bit) & 1U) | ((y >> bit) & 1U) << 1 | ((z >> bit) & 1U) << 2;
    key = (key << 3) | kAutomaton.digit[state][bits];
    state = kAutomaton.next[state][bits];
  }
  return key;
}

// Sorts by the upper 33 bits, which leaves equal ones in their order: three passes of 11 bits.
void sort_keys(std::vector<std::uint64_t>& keys) {
  constexpr std::size_t kBuckets = 1U << kBits;
  std::vector<std::uint64_t> other(keys.size());
  for (int shift = 31; shift < 64; shift += kBits) {
    std::array<std::size_t, kBuckets + 1> start{};
    const auto bucket = [shift](std::uint64_t key) { return (key >> shift) & (kBuckets - 1); };
    for (const std::uint64_t key : keys) ++start[bucket(key) + 1];
    for (std::size_t b = 0; b < kBuckets; ++b) start[b + 1] += start[b];
    for (const std::uint64_t key : keys) other[start[bucket(key)]++] = key;
    keys.swap(other);
  }
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
        hilbert_key(static_cast<std::uint32_t>(q.x), static_cast<std::uint32_t>(q.y),
                    static_cast<std::uint32_t>(q.z));
    keys[i] = (key << 31) | i;
  }
  sort_keys(keys);
  for (std::size_t i = 0; i < keys.size(); ++i)
    order[i] = static_cast<Index>(keys[i] & 0x7fffffffU);
  return order;
}

}  // namespace nonobtuse::spatial
