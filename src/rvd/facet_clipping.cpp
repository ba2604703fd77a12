#include "rvd/facet_clipping.h"

#include <algorithm>

namespace nonobtuse::rvd {

// A site that is nowhere nearer than another one owns nothing; of equals the lowest index stays.
void FacetClipper::keep_undominated(std::span<const CornerDistances> d) {
  alive_.clear();
  const auto count = static_cast<Index>(d.size());
  for (Index i = 0; i < count; ++i) {
    bool drop = false;
    for (Index k = 0; k < count && !drop; ++k) {
      if (k == i || d[i][0] < d[k][0] || d[i][1] < d[k][1] || d[i][2] < d[k][2]) continue;
      drop = k < i || d[i] != d[k];
    }
    if (!drop) alive_.push_back(i);
  }
}

template <bool Tagged>
void FacetClipper::make_part(std::span<const CornerDistances> d, Index i) {
  polygon_.assign({{0, 0}, {1, 0}, {0, 1}});
  if constexpr (Tagged) edge_.assign(3, -1);
  for (const Index j : alive_) {
    if (j == i) continue;
    const double g0 = d[j][0] - d[i][0];
    const double gu = (d[j][1] - d[i][1]) - g0;
    const double gv = (d[j][2] - d[i][2]) - g0;
    next_.clear();
    if constexpr (Tagged) next_edge_.clear();
    const std::size_t size = polygon_.size();
    double g_a = g0 + gu * polygon_[0].u + gv * polygon_[0].v;
    for (std::size_t a = 0; a < size; ++a) {
      const Corner& pa = polygon_[a];
      const Corner& pb = polygon_[a + 1 == size ? 0 : a + 1];
      const double g_b = g0 + gu * pb.u + gv * pb.v;
      if (g_a >= 0) {
        next_.push_back(pa);
        if constexpr (Tagged) next_edge_.push_back(edge_[a]);
      }
      if ((g_a >= 0) != (g_b >= 0)) {
        const double t = g_a / (g_a - g_b);
        next_.push_back({pa.u + t * (pb.u - pa.u), pa.v + t * (pb.v - pa.v)});
        // Leaving the half-plane the bisector begins; entering it the old edge goes on.
        if constexpr (Tagged) next_edge_.push_back(g_a >= 0 ? j : edge_[a]);
      }
      g_a = g_b;
    }
    polygon_.swap(next_);
    if constexpr (Tagged) edge_.swap(next_edge_);
    if (polygon_.size() < 3) {
      polygon_.clear();
      return;
    }
  }
}

Moments FacetClipper::polygon_moments() const {
  double share = 0;
  double u = 0;
  double v = 0;
  for (std::size_t k = 2; k < polygon_.size(); ++k) {
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

void FacetClipper::clip(std::span<const CornerDistances> d, std::span<Moments> moments) {
  std::fill(moments.begin(), moments.end(), Moments{0, 0, 0});
  keep_undominated(d);
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
}

void FacetClipper::adjacent(std::span<const CornerDistances> d,
                            std::vector<std::array<Index, 2>>& pairs) {
  keep_undominated(d);
  for (const Index i : alive_) {
    make_part<true>(d, i);
    for (std::size_t k = 0; k < polygon_.size(); ++k) {
      const Corner& a = polygon_[k];
      const Corner& b = polygon_[k + 1 == polygon_.size() ? 0 : k + 1];
      if (edge_[k] > i && (a.u != b.u || a.v != b.v)) pairs.push_back({i, edge_[k]});
    }
  }
}

}  // namespace nonobtuse::rvd
