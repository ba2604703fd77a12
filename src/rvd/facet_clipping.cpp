#include "rvd/facet_clipping.h"

namespace nonobtuse::rvd {

// The nearest sites of the corners, and all that are not further than each of these everywhere.
void FacetClipper::keep_possible_owners(std::span<const CornerDistances> d) {
  alive_.clear();
  const auto count = static_cast<Index>(d.size());
  std::array<Index, 3> nearest{0, 0, 0};
  for (Index i = 1; i < count; ++i)
    for (int k = 0; k < 3; ++k) nearest[k] = d[i][k] < d[nearest[k]][k] ? i : nearest[k];
  if (nearest[0] == nearest[1] && nearest[1] == nearest[2]) {  // cells are convex
    alive_.push_back(nearest[0]);
    return;
  }
  const auto further = [&](Index i, Index k) {
    return (d[i][0] >= d[k][0]) & (d[i][1] >= d[k][1]) & (d[i][2] >= d[k][2]);
  };
  for (Index i = 0; i < count; ++i) {
    const bool is_nearest = i == nearest[0] || i == nearest[1] || i == nearest[2];
    if (is_nearest || !(further(i, nearest[0]) || further(i, nearest[1]) || further(i, nearest[2])))
      alive_.push_back(i);
  }
}

// Where distances are equal the lower index owns the point: half-planes against lower ones are
// open, against higher ones closed, so that even sites at one place divide the triangle.
template <bool Tagged>
void FacetClipper::make_part(std::span<const CornerDistances> d, Index i) {
  const std::size_t most = alive_.size() + 3;
  if (polygon_.size() < most) {
    polygon_.resize(most);
    next_.resize(most);
    edge_.resize(most);
    next_edge_.resize(most);
    g_.resize(most);
    in_.resize(most);
  }
  polygon_[0] = {0, 0};
  polygon_[1] = {1, 0};
  polygon_[2] = {0, 1};
  if constexpr (Tagged) edge_[0] = edge_[1] = edge_[2] = -1;
  size_ = 3;
  for (const Index j : alive_) {
    if (j == i) continue;
    const double g0 = d[j][0] - d[i][0];
    const double gu = (d[j][1] - d[i][1]) - g0;
    const double gv = (d[j][2] - d[i][2]) - g0;
    const bool open = j < i;
    std::size_t inside = 0;
    for (std::size_t a = 0; a < size_; ++a) {
      const double g = g0 + gu * polygon_[a].u + gv * polygon_[a].v;
      g_[a] = g;
      in_[a] = static_cast<char>(open ? g > 0 : g >= 0);
      inside += static_cast<std::size_t>(in_[a]);
    }
    if (inside == size_) continue;
    size_ = inside == 0 ? 0 : cut_polygon<Tagged>(j);
    if (size_ == 0) return;
  }
}

// Keeps what lies inside by `g_` and `in_`; returns how many corners.
template <bool Tagged>
std::size_t FacetClipper::cut_polygon(Index j) {
  std::size_t kept = 0;
  for (std::size_t a = 0; a < size_; ++a) {
    const std::size_t b = a + 1 == size_ ? 0 : a + 1;
    const Corner pa = polygon_[a];
    if (in_[a] != 0) {
      if constexpr (Tagged) next_edge_[kept] = edge_[a];
      next_[kept++] = pa;
    }
    if (in_[a] != in_[b]) {
      const Corner pb = polygon_[b];
      const double t = g_[a] / (g_[a] - g_[b]);
      // Leaving the half-plane the bisector begins; entering it the old edge goes on.
      if constexpr (Tagged) next_edge_[kept] = in_[a] != 0 ? j : edge_[a];
      next_[kept++] = {pa.u + t * (pb.u - pa.u), pa.v + t * (pb.v - pa.v)};
    }
  }
  polygon_.swap(next_);
  if constexpr (Tagged) edge_.swap(next_edge_);
  return kept < 3 ? 0 : kept;
}

Moments FacetClipper::polygon_moments() const {
  double share = 0;
  double u = 0;
  double v = 0;
  for (std::size_t k = 2; k < size_; ++k) {
    const Corner& a = polygon_[0];
    const Corner& b = polygon_[k - 1];
    const Corner& c = polygon_[k];
    const double w = (b.u - a.u) * (c.v - a.v) - (b.v - a.v) * (c.u - a.u);
    share += w;
    u += w * (a.u + b.u + c.u);
    v += w * (a.v + b.v + c.v);
  }
  u /= 3;
  v /= 3;
  return {share - u - v, u, v};
}

// On a triangle of a fan with densities r_i at its corners c_i, a coordinate b has the integral
// ((sum r) (sum b) + sum r_i b_i) / 12 times the triangle's area.
Moments FacetClipper::polygon_moments(const std::array<double, 3>& rho) const {
  const auto density = [&](const Corner& c) {
    return rho[0] + c.u * (rho[1] - rho[0]) + c.v * (rho[2] - rho[0]);
  };
  double mass = 0;
  double u = 0;
  double v = 0;
  for (std::size_t k = 2; k < size_; ++k) {
    const Corner& a = polygon_[0];
    const Corner& b = polygon_[k - 1];
    const Corner& c = polygon_[k];
    const double w = ((b.u - a.u) * (c.v - a.v) - (b.v - a.v) * (c.u - a.u)) / 12;
    const double ra = density(a);
    const double rb = density(b);
    const double rc = density(c);
    const double sum = ra + rb + rc;
    mass += 4 * w * sum;
    u += w * (sum * (a.u + b.u + c.u) + ra * a.u + rb * b.u + rc * c.u);
    v += w * (sum * (a.v + b.v + c.v) + ra * a.v + rb * b.v + rc * c.v);
  }
  return {mass - u - v, u, v};
}

std::span<const Index> FacetClipper::clip(std::span<const CornerDistances> d,
                                          const std::array<double, 3>& rho,
                                          std::span<Moments> moments) {
  keep_possible_owners(d);
  Moments rest = whole_moments(rho);
  for (std::size_t k = 0; k + 1 < alive_.size(); ++k) {
    make_part<false>(d, alive_[k]);
    const Moments m = polygon_moments(rho);
    moments[alive_[k]] = m;
    for (int l = 0; l < 3; ++l) rest[l] -= m[l];
  }
  moments[alive_.back()] = rest;
  return alive_;
}

std::span<const Index> FacetClipper::clip(std::span<const CornerDistances> d,
                                          std::span<Moments> moments) {
  keep_possible_owners(d);
  Moments rest = kWhole;
  const auto take = [&](const Moments& m) {
    for (int k = 0; k < 3; ++k) rest[k] -= m[k];
  };
  if (alive_.size() == 2) {
    const CornerDistances& a = d[alive_[0]];
    const CornerDistances& b = d[alive_[1]];
    moments[alive_[0]] = first_of_two({b[0] - a[0], b[1] - a[1], b[2] - a[2]});
    take(moments[alive_[0]]);
  } else {
    for (std::size_t k = 0; k + 1 < alive_.size(); ++k) {
      make_part<false>(d, alive_[k]);
      moments[alive_[k]] = polygon_moments();
      take(moments[alive_[k]]);
    }
  }
  moments[alive_.back()] = rest;
  return alive_;
}

void FacetClipper::adjacent(std::span<const CornerDistances> d,
                            std::vector<std::array<Index, 2>>& pairs) {
  keep_possible_owners(d);
  for (const Index i : alive_) {
    make_part<true>(d, i);
    for (std::size_t k = 0; k < size_; ++k) {
      const Corner& a = polygon_[k];
      const Corner& b = polygon_[k + 1 == size_ ? 0 : k + 1];
      if (edge_[k] > i && (a.u != b.u || a.v != b.v)) pairs.push_back({i, edge_[k]});
    }
  }
}

}  // namespace nonobtuse::rvd
