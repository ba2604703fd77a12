// Integers of any size, for predicates on coordinates so far apart in magnitude that expansions of
// doubles would underflow. Schoolbook arithmetic: slow, and almost never needed.
#pragma once

#include <cstdint>
#include <vector>

namespace nonobtuse::numeric {

class WideInteger {
 public:
  WideInteger() = default;  // zero
  /// value / 2^unit, which must be an integer; value must be finite.
  static WideInteger scaled(double value, int unit);

  [[nodiscard]] int sign() const { return limbs_.empty() ? 0 : (negative_ ? -1 : 1); }

  friend WideInteger operator+(const WideInteger& a, const WideInteger& b);
  friend WideInteger operator-(const WideInteger& a, const WideInteger& b);
  friend WideInteger operator*(const WideInteger& a, const WideInteger& b);

 private:
  static WideInteger sum(const WideInteger& a, const WideInteger& b, bool b_negative);

  bool negative_ = false;
  std::vector<std::uint32_t> limbs_;  // least first, the last one not 0
};

}  // namespace nonobtuse::numeric
