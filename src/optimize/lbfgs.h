// Limited-memory BFGS (Liu & Nocedal, On the limited memory BFGS method for large scale
// optimization, 1989): the two-loop recursion on vectors of points, with a preconditioner of the
// caller's as initial inverse Hessian. Line searches belong to the caller.
#pragma once

#include <deque>
#include <functional>
#include <span>
#include <vector>

#include "numeric/vec3.h"
#include "parallel/workers.h"

namespace nonobtuse::optimize {

/// Sum of a_i . b_i, added in a fixed order for any number of threads. Same sizes.
double dot(std::span<const Vec3> a, std::span<const Vec3> b, const parallel::Workers& workers);

/// The last few pairs (step, change of gradient). Not thread-safe; parallel inside.
class LbfgsHistory {
 public:
  /// out = P^-1 in for a symmetric positive definite P near the Hessian; `in` and `out` (#X by 3)
  /// do not overlap. A scalar factor of P does not matter once there is a pair: see `direction`.
  using Preconditioner = std::function<void(std::span<const Vec3> in, std::span<Vec3> out)>;

  explicit LbfgsHistory(int pairs = 7) : limit_(pairs) {}

  void clear() { pairs_.clear(); }
  [[nodiscard]] int size() const { return static_cast<int>(pairs_.size()); }

  /// Adds s = x_new - x_old and y = gradient_new - gradient_old (#X by 3 each), unless s.y <= 0
  /// (negative curvature): then returns false and keeps the history as it is.
  bool add(std::span<const Vec3> s, std::span<const Vec3> y, const parallel::Workers& workers);

  /// out = -H gradient, where H starts from gamma P^-1 with gamma = s.y / (y.P^-1 y) of the last
  /// pair (1 without pairs). Always a descent direction for a positive definite P.
  void direction(std::span<const Vec3> gradient, std::span<Vec3> out,
                 const Preconditioner& preconditioner, const parallel::Workers& workers) const;

 private:
  struct Pair {
    std::vector<Vec3> s;
    std::vector<Vec3> y;
    double sy = 0;
  };
  int limit_;
  std::deque<Pair> pairs_;  // oldest first
};

}  // namespace nonobtuse::optimize
