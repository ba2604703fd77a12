// Exact arithmetic on sums of doubles (Shewchuk, Adaptive Precision Floating-Point Arithmetic and
// Fast Robust Geometric Predicates, 1997). An expansion is a sum of doubles that do not overlap,
// sorted by increasing magnitude, without zeros: its sign is that of its last term. Exact as long
// as no product over- or underflows, that is for coordinates normalised to about 1.
#pragma once

#include <cstddef>
#include <vector>

namespace nonobtuse::numeric {

class Expansion {
 public:
  Expansion() = default;  // zero
  explicit Expansion(double value);
  /// a - b and a * b of two doubles, exactly.
  static Expansion difference(double a, double b);
  static Expansion product(double a, double b);

  [[nodiscard]] int sign() const;         ///< -1, 0, +1; exact
  [[nodiscard]] double estimate() const;  ///< the nearest sum in doubles
  [[nodiscard]] std::size_t size() const { return terms_.size(); }

  friend Expansion operator+(const Expansion& a, const Expansion& b);
  friend Expansion operator-(const Expansion& a, const Expansion& b);
  friend Expansion operator*(const Expansion& a, const Expansion& b);
  friend Expansion operator*(const Expansion& a, double b);
  friend Expansion operator-(const Expansion& a);

 private:
  std::vector<double> terms_;
};

}  // namespace nonobtuse::numeric
