// On which side of a bisector does a corner of a clipped facet lie? Exact, with symbolic
// perturbation (Levy, Robustness and efficiency of geometric programs, 2016: side1, side2, side3;
// Edelsbrunner, Muecke, Simulation of simplicity, 1990).
//
// On one facet everything follows from d_i(v) = |v - x_i|^2 at its three vertices v, since
// l_j = d_i - d_j is linear. A corner of a piece of cell i is given by the two sides that meet
// there, each an edge of the facet or the bisector of i with another site; its homogeneous
// barycentric coordinates are the cross product of the two lines' values at the vertices, and
// l_j there is a determinant of order 1, 2 or 3. Ties: site i has weight -e_i, with e_0 much larger
// than e_1, and so on: the lower index wins, no four cells ever meet, no cut passes through a
// vertex. The determinants are linear in the e's, so the first coefficient that is not zero
// decides.
#pragma once

#include <array>
#include <cmath>
#include <span>
#include <vector>

#include "nonobtuse/mesh.h"
#include "numeric/vec3.h"

namespace nonobtuse::numeric {

/// A side of a piece: >= 0 a bisector (index of the other site among the facet's candidates),
/// -1-k the facet's edge k (from vertex k+1 to vertex k+2).
using Side = Index;
constexpr Side edge_side(int k) { return -1 - k; }
constexpr bool is_edge(Side s) { return s < 0; }
constexpr int edge_of(Side s) { return -1 - s; }

/// A corner of a piece of cell i: where side `before` ends and side `after` begins
/// (counter-clockwise). `weights` are its homogeneous barycentric coordinates in doubles,
/// non-negative up to rounding.
struct Corner {
  Side before = -1;
  Side after = -1;
  std::array<double, 3> weights{};
  double error_slope = 0;  // |computed - exact| of weights . l <= slope * max|l| + offset
  double error_offset = 0;
};

/// The predicates of one facet. Not thread-safe; one per thread, reset for every facet.
class SidePredicates {
 public:
  /// Candidates in ascending order of their index (that is the order of the perturbation).
  /// The spans and vertices are read until the next reset.
  void reset(const std::array<Vec3, 3>& vertices, std::span<const Vec3> sites,
             std::span<const Index> candidates);

  [[nodiscard]] int candidate_count() const { return static_cast<int>(distances_.size()); }
  /// Squared distances of candidate i to the three vertices.
  [[nodiscard]] const std::array<double, 3>& distances(int i) const { return distances_[i]; }
  /// Bound of the error of a difference of two of them.
  [[nodiscard]] double difference_error() const { return error_; }

  /// The corner of a piece of cell i between two sides.
  [[nodiscard]] Corner corner(int i, Side before, Side after) const;

  /// -1 if the corner of cell i is nearer to i than to j, +1 otherwise; never 0.
  [[nodiscard]] int side(int i, const Corner& c, int j) const {
    const auto& di = distances_[i];
    const auto& dj = distances_[j];
    const double l0 = di[0] - dj[0];
    const double l1 = di[1] - dj[1];
    const double l2 = di[2] - dj[2];
    const double value = c.weights[0] * l0 + c.weights[1] * l1 + c.weights[2] * l2;
    const double largest = std::max(std::abs(l0), std::max(std::abs(l1), std::abs(l2))) + error_;
    const double bound = c.error_slope * largest + c.error_offset;
    if (value > bound) return 1;
    if (value < -bound) return -1;
    return exact_side(i, c.before, c.after, j);
  }

  /// The same without the floating-point filter.
  [[nodiscard]] int exact_side(int i, Side before, Side after, int j) const;

 private:
  std::array<Vec3, 3> vertices_{};
  std::span<const Vec3> sites_;
  std::span<const Index> candidates_;
  std::vector<std::array<double, 3>> distances_;
  double error_ = 0;
};

}  // namespace nonobtuse::numeric
