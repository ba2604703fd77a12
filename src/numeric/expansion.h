// Exact arithmetic on sums of doubles (Shewchuk, Adaptive Precision Floating-Point Arithmetic and
// Fast Robust Geometric Predicates, 1997). An expansion is a sum of doubles that do not overlap,
// sorted by increasing magnitude, without zeros: its sign is that of its last term. Exact as long
// as no product over- or underflows, that is for coordinates normalised to about 1.
#pragma once

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace nonobtuse::numeric {

/// The terms of an expansion: the first few in place, since nearly all expansions are short and
/// most of the cost of long ones was their allocation.
class ExpansionTerms {
 public:
  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] bool empty() const { return size_ == 0; }
  [[nodiscard]] double* begin() { return spilled_.empty() ? in_place_ : spilled_.data(); }
  [[nodiscard]] double* end() { return begin() + size_; }
  [[nodiscard]] const double* begin() const {
    return spilled_.empty() ? in_place_ : spilled_.data();
  }
  [[nodiscard]] const double* end() const { return begin() + size_; }
  [[nodiscard]] double operator[](std::size_t i) const { return begin()[i]; }
  [[nodiscard]] double back() const { return begin()[size_ - 1]; }
  void push_back(double value) {
    if (size_ < kInPlace) {
      in_place_[size_++] = value;
      return;
    }
    if (spilled_.empty()) spilled_.assign(in_place_, in_place_ + size_);
    spilled_.push_back(value);
    ++size_;
  }

  ExpansionTerms() = default;
  ExpansionTerms(const ExpansionTerms& other) { *this = other; }
  ExpansionTerms(ExpansionTerms&& other) noexcept { *this = std::move(other); }
  ExpansionTerms& operator=(const ExpansionTerms& other) {
    if (this == &other) return *this;
    spilled_ = other.spilled_;
    copy_in_place(other);
    return *this;
  }
  ExpansionTerms& operator=(ExpansionTerms&& other) noexcept {
    if (this == &other) return *this;
    spilled_ = std::move(other.spilled_);
    copy_in_place(other);
    other.spilled_.clear();
    other.size_ = 0;
    return *this;
  }

 private:
  static constexpr std::size_t kInPlace = 32;

  void copy_in_place(const ExpansionTerms& other) {
    size_ = other.size_;
    if (size_ <= kInPlace) std::copy_n(other.in_place_, size_, in_place_);
  }

  double in_place_[kInPlace];    // not initialised beyond size_
  std::vector<double> spilled_;  // all terms, once there are more
  std::size_t size_ = 0;
};

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
  ExpansionTerms terms_;
};

}  // namespace nonobtuse::numeric
