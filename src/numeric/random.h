// SplitMix64 (Steele, Lea, Flood 2014) as a counted generator: the k-th number of stream s is a
// function of (seed, s, k) alone, so that parallel code draws the same numbers for any number of
// threads. Own distributions, since those of the standard library differ between implementations.
#pragma once

#include <cstdint>

namespace nonobtuse::numeric {

constexpr std::uint64_t mix64(std::uint64_t z) {
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
  return z ^ (z >> 31);
}

class Random {
 public:
  /// One stream per element (facet, seed, sample): pass its index as `stream`.
  constexpr explicit Random(std::uint64_t seed, std::uint64_t stream = 0)
      : state_(mix64(seed + 0x9e3779b97f4a7c15ULL) ^ mix64(stream * 0xd1342543de82ef95ULL + 1)) {}

  constexpr std::uint64_t next() { return mix64(state_ += 0x9e3779b97f4a7c15ULL); }
  /// Uniform in [0, 1), a multiple of 2^-53.
  constexpr double uniform() { return static_cast<double>(next() >> 11) * 0x1p-53; }
  /// Uniform in [0, n), n > 0; the bias below 2^-32 for n < 2^32 does not matter here.
  constexpr std::uint64_t below(std::uint64_t n) { return ((next() >> 32) * n) >> 32; }

 private:
  std::uint64_t state_;
};

}  // namespace nonobtuse::numeric
