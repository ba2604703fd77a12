// Error bounds. u = 2^-53. A squared distance d has relative error 5u (differences, squares, two
// sums), so a difference l of two has absolute error E <= 6.1 u (d_i + d_j) <= 12.2 u max d; E
// below is 16 u max d. The weights of a corner are 1, values l, or 2 x 2 determinants of such; the
// bounds add up first-order terms with every magnitude enlarged by E, which covers the higher
// orders.
#include "numeric/side_predicates.h"

#include <algorithm>

#include "numeric/expansion.h"

namespace nonobtuse::numeric {

namespace {

constexpr double kUnit = 0x1p-53;

constexpr int next(int k) { return k == 2 ? 0 : k + 1; }
constexpr int previous(int k) { return k == 0 ? 2 : k - 1; }

using Row = std::array<Expansion, 3>;

// |v - x|^2 - |v - y|^2 = (y - x) . ((v - x) + (v - y))
Expansion exact_difference(const Vec3& v, const Vec3& x, const Vec3& y) {
  const auto part = [](double vk, double xk, double yk) {
    return Expansion::difference(yk, xk) *
           (Expansion::difference(vk, xk) + Expansion::difference(vk, yk));
  };
  return part(v.x, x.x, y.x) + part(v.y, x.y, y.y) + part(v.z, x.z, y.z);
}

Expansion determinant(const Expansion& a, const Expansion& b, const Expansion& c,
                      const Expansion& d) {
  return a * d - b * c;
}

// det(1, a, b): orientation of two lines, the sum of the components of a x b.
Expansion turn(const Row& a, const Row& b) {
  return determinant(a[1] - a[0], a[2] - a[0], b[1] - b[0], b[2] - b[0]);
}

// Sign of the perturbation: `terms` are (index, coefficient of e_index).
template <std::size_t N>
int perturbed_sign(std::array<std::pair<int, Expansion>, N> terms) {
  std::sort(terms.begin(), terms.end(),
            [](const auto& a, const auto& b) { return a.first < b.first; });
  for (const auto& [index, coefficient] : terms)
    if (const int sign = coefficient.sign(); sign != 0) return sign;
  return 0;
}

}  // namespace

void SidePredicates::reset(const std::array<Vec3, 3>& vertices, std::span<const Vec3> sites,
                           std::span<const Index> candidates) {
  vertices_ = vertices;
  sites_ = sites;
  candidates_ = candidates;
  distances_.resize(candidates.size());
  double largest = 0;
  for (std::size_t c = 0; c < candidates.size(); ++c) {
    const Vec3& x = sites[candidates[c]];
    for (int k = 0; k < 3; ++k) {
      distances_[c][k] = squared_distance(vertices[k], x);
      largest = std::max(largest, distances_[c][k]);
    }
  }
  error_ = 16 * kUnit * largest;
}

Corner SidePredicates::corner(int i, Side before, Side after) const {
  Corner c;
  c.before = before;
  c.after = after;
  const auto line = [&](Side s) {
    const auto& di = distances_[i];
    const auto& dj = distances_[s];
    return std::array<double, 3>{di[0] - dj[0], di[1] - dj[1], di[2] - dj[2]};
  };
  const auto magnitude = [&](const std::array<double, 3>& l) {
    return std::max(std::abs(l[0]), std::max(std::abs(l[1]), std::abs(l[2]))) + error_;
  };
  if (is_edge(before) && is_edge(after)) {  // a vertex: the one on both edges
    c.weights[3 - edge_of(before) - edge_of(after)] = 1;
    c.error_offset = error_;
    return c;
  }
  if (is_edge(before) || is_edge(after)) {  // a bisector cuts an edge
    const int k = edge_of(is_edge(before) ? before : after);
    const auto l = line(is_edge(before) ? after : before);
    const double sign = is_edge(before) ? 1 : -1;
    c.weights[next(k)] = sign * l[previous(k)];
    c.weights[previous(k)] = -sign * l[next(k)];
    const double size = magnitude(l);
    c.error_slope = 2 * error_ + 8 * kUnit * size;
    c.error_offset = 2.1 * size * error_;
    return c;
  }
  const auto a = line(before);
  const auto b = line(after);
  for (int k = 0; k < 3; ++k)
    c.weights[k] = a[next(k)] * b[previous(k)] - a[previous(k)] * b[next(k)];
  const double size_a = magnitude(a);
  const double size_b = magnitude(b);
  // Three weights, each off by 2 E (|a| + |b|) and rounding, and three products.
  c.error_slope = 6.5 * error_ * (size_a + size_b) + 40 * kUnit * size_a * size_b;
  c.error_offset = 6.5 * error_ * size_a * size_b;
  return c;
}

int SidePredicates::exact_side(int i, Side before, Side after, int j) const {
  const auto value = [&](int k, int other) {
    return exact_difference(vertices_[k], sites_[candidates_[i]], sites_[candidates_[other]]);
  };
  if (is_edge(before) && is_edge(after)) {
    const int sign = value(3 - edge_of(before) - edge_of(after), j).sign();
    return sign != 0 ? sign : (i < j ? -1 : 1);
  }
  if (is_edge(before) || is_edge(after)) {
    const int k = edge_of(is_edge(before) ? before : after);
    const int a = is_edge(before) ? after : before;
    const int orientation = is_edge(before) ? -1 : 1;
    const Expansion a0 = value(next(k), a);
    const Expansion a1 = value(previous(k), a);
    const Expansion j0 = value(next(k), j);
    const Expansion j1 = value(previous(k), j);
    if (const int sign = determinant(a0, a1, j0, j1).sign(); sign != 0) return orientation * sign;
    return orientation *
           perturbed_sign<3>({{{i, (j0 - j1) - (a0 - a1)}, {a, j1 - j0}, {j, a0 - a1}}});
  }
  const auto row = [&](int other) {
    return Row{value(0, other), value(1, other), value(2, other)};
  };
  const Row a = row(before);
  const Row b = row(after);
  const Row l = row(j);
  const Expansion full = l[0] * determinant(a[1], a[2], b[1], b[2]) +
                         l[1] * determinant(a[2], a[0], b[2], b[0]) +
                         l[2] * determinant(a[0], a[1], b[0], b[1]);
  if (const int sign = full.sign(); sign != 0) return sign;
  const Expansion ab = turn(a, b);
  const Expansion al = turn(a, l);
  const Expansion bl = turn(b, l);
  return perturbed_sign<4>({{{i, al - bl - ab}, {before, bl}, {after, -al}, {j, ab}}});
}

}  // namespace nonobtuse::numeric
