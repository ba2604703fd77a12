// Knuth, The Art of Computer Programming 2, section 4.3.1, algorithms A, S, M.
#include "numeric/wide_integer.h"

#include <cmath>
#include <cstddef>

namespace nonobtuse::numeric {

namespace {

using Limbs = std::vector<std::uint32_t>;

void trim(Limbs& limbs) {
  while (!limbs.empty() && limbs.back() == 0) limbs.pop_back();
}

bool less(const Limbs& a, const Limbs& b) {
  if (a.size() != b.size()) return a.size() < b.size();
  for (std::size_t i = a.size(); i-- > 0;)
    if (a[i] != b[i]) return a[i] < b[i];
  return false;
}

Limbs added(const Limbs& a, const Limbs& b) {
  const Limbs& longer = a.size() < b.size() ? b : a;
  const Limbs& shorter = a.size() < b.size() ? a : b;
  Limbs out(longer);
  std::uint64_t carry = 0;
  for (std::size_t i = 0; i < out.size(); ++i) {
    carry += out[i];
    if (i < shorter.size()) carry += shorter[i];
    out[i] = static_cast<std::uint32_t>(carry);
    carry >>= 32;
  }
  if (carry != 0) out.push_back(static_cast<std::uint32_t>(carry));
  return out;
}

// a - b for a >= b.
Limbs subtracted(const Limbs& a, const Limbs& b) {
  Limbs out(a);
  std::uint64_t borrow = 0;
  for (std::size_t i = 0; i < out.size(); ++i) {
    const std::uint64_t take = borrow + (i < b.size() ? b[i] : 0);
    borrow = out[i] < take ? 1 : 0;
    out[i] = static_cast<std::uint32_t>(out[i] - take);
  }
  trim(out);
  return out;
}

}  // namespace

WideInteger WideInteger::scaled(double value, int unit) {
  WideInteger result;
  if (value == 0) return result;
  int exponent = 0;
  const double fraction = std::frexp(std::abs(value), &exponent);
  std::uint64_t mantissa = static_cast<std::uint64_t>(std::ldexp(fraction, 53));
  int shift = exponent - 53 - unit;
  for (; shift < 0; ++shift) mantissa >>= 1;  // zeros only, since the quotient is an integer
  result.negative_ = value < 0;
  result.limbs_.assign(static_cast<std::size_t>(shift / 32), 0);
  const int bits = shift % 32;
  const std::uint64_t low = mantissa << bits;
  result.limbs_.push_back(static_cast<std::uint32_t>(low));
  result.limbs_.push_back(static_cast<std::uint32_t>(low >> 32));
  if (bits > 0) result.limbs_.push_back(static_cast<std::uint32_t>(mantissa >> (64 - bits)));
  trim(result.limbs_);
  return result;
}

WideInteger WideInteger::sum(const WideInteger& a, const WideInteger& b, bool b_negative) {
  WideInteger result;
  if (a.negative_ == b_negative) {
    result.limbs_ = added(a.limbs_, b.limbs_);
    result.negative_ = a.negative_;
  } else if (less(a.limbs_, b.limbs_)) {
    result.limbs_ = subtracted(b.limbs_, a.limbs_);
    result.negative_ = b_negative;
  } else {
    result.limbs_ = subtracted(a.limbs_, b.limbs_);
    result.negative_ = a.negative_;
  }
  return result;
}

WideInteger operator+(const WideInteger& a, const WideInteger& b) {
  return WideInteger::sum(a, b, b.negative_);
}

WideInteger operator-(const WideInteger& a, const WideInteger& b) {
  return WideInteger::sum(a, b, !b.negative_);
}

WideInteger operator*(const WideInteger& a, const WideInteger& b) {
  WideInteger result;
  result.negative_ = a.negative_ != b.negative_;
  result.limbs_.assign(a.limbs_.size() + b.limbs_.size(), 0);
  for (std::size_t i = 0; i < a.limbs_.size(); ++i) {
    std::uint64_t carry = 0;
    for (std::size_t j = 0; j < b.limbs_.size(); ++j) {
      carry += std::uint64_t{a.limbs_[i]} * b.limbs_[j] + result.limbs_[i + j];
      result.limbs_[i + j] = static_cast<std::uint32_t>(carry);
      carry >>= 32;
    }
    result.limbs_[i + b.limbs_.size()] = static_cast<std::uint32_t>(carry);
  }
  trim(result.limbs_);
  return result;
}

}  // namespace nonobtuse::numeric
