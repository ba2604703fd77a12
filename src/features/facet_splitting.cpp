#include "features/facet_splitting.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <tuple>
#include <utility>

#include "mesh/topology.h"

namespace nonobtuse::features {

namespace {

constexpr double kMostFacets = 16;  // per facet of the input and vertex of the result

class Splitter {
 public:
  Splitter(const std::vector<Vec3>& vertices, std::vector<EdgeVertex> inserted)
      : vertices_(vertices), inserted_(std::move(inserted)) {
    std::sort(inserted_.begin(), inserted_.end(), [](const EdgeVertex& a, const EdgeVertex& b) {
      return std::tie(a.low, a.high, a.along, a.vertex) <
             std::tie(b.low, b.high, b.along, b.vertex);
    });
  }

  void split(const Triangle& t, std::uint8_t flags, Index facet, SplitFacets& out) {
    stack_.push_back({t, {}, flags});
    for (int k = 0; k < 3; ++k)
      stack_.front().inserted[k] = between(t[mesh::next(k)], t[mesh::previous(k)]);
    while (!stack_.empty()) {
      const Piece piece = std::move(stack_.back());
      stack_.pop_back();
      const int k = longest(piece);
      if (k >= 0) {
        bisect(piece, k);
        continue;
      }
      out.triangles.push_back(piece.corners);
      out.flags.push_back(piece.flags);
      out.facet.push_back(facet);
    }
  }

 private:
  struct Piece {
    Triangle corners;
    std::array<std::vector<Index>, 3> inserted;  // on edge k, from corner k+1 to corner k+2
    std::uint8_t flags;
  };

  // New vertices on the edge from a to b, in that order.
  [[nodiscard]] std::vector<Index> between(Index a, Index b) const {
    const auto key = std::pair(std::min(a, b), std::max(a, b));
    auto at = std::lower_bound(
        inserted_.begin(), inserted_.end(), key,
        [](const EdgeVertex& e, const auto& k) { return std::pair(e.low, e.high) < k; });
    std::vector<Index> found;
    for (; at != inserted_.end() && std::pair(at->low, at->high) == key; ++at)
      found.push_back(at->vertex);
    if (a > b) std::reverse(found.begin(), found.end());
    return found;
  }

  // The longest edge with new vertices; -1 if there is none.
  [[nodiscard]] int longest(const Piece& piece) const {
    int k = -1;
    double most = -1;
    for (int j = 0; j < 3; ++j) {
      if (piece.inserted[j].empty()) continue;
      const double d = squared_distance(vertices_[piece.corners[mesh::next(j)]],
                                        vertices_[piece.corners[mesh::previous(j)]]);
      if (d > most) k = j, most = d;
    }
    return k;
  }

  void bisect(const Piece& piece, int k) {
    const auto bit = [&](int edge, int as) {
      return static_cast<std::uint8_t>((piece.flags >> edge & 1) << as);
    };
    const int n = mesh::next(k);
    const int p = mesh::previous(k);
    const std::vector<Index>& line = piece.inserted[k];
    const auto middle = line.begin() + static_cast<std::ptrdiff_t>(line.size() / 2);
    const auto& c = piece.corners;
    stack_.push_back({{c[k], *middle, c[p]},
                      {std::vector<Index>(middle + 1, line.end()), piece.inserted[n], {}},
                      static_cast<std::uint8_t>(bit(k, 0) | bit(n, 1))});
    stack_.push_back({{c[k], c[n], *middle},
                      {std::vector<Index>(line.begin(), middle), {}, piece.inserted[p]},
                      static_cast<std::uint8_t>(bit(k, 0) | bit(p, 2))});
  }

  const std::vector<Vec3>& vertices_;
  std::vector<EdgeVertex> inserted_;
  std::vector<Piece> stack_;
};

// The middles of all edges that are too long, appended to the vertices and sizes.
std::vector<EdgeVertex> long_edges(const std::vector<Triangle>& triangles, const EdgeFlags& flags,
                                   double bound, double feature_bound, std::vector<Vec3>& vertices,
                                   std::vector<double>& size) {
  std::vector<EdgeVertex> inserted;
  const auto count = static_cast<Index>(vertices.size());
  mesh::for_each_edge(
      mesh::edge_sides(triangles, count), [&](const mesh::EdgeSide* first, const mesh::EdgeSide*) {
        const Index a = first->low;
        const Index b = first->high;
        const double local = size.empty() ? 1 : std::min(size[a], size[b]);
        const double most =
            local * (flagged(flags, first->triangle, first->corner) ? feature_bound : bound);
        if (squared_distance(vertices[a], vertices[b]) <= most * most) return;
        inserted.push_back({a, b, 0.5, static_cast<Index>(vertices.size())});
        vertices.push_back(0.5 * (vertices[a] + vertices[b]));
        if (!size.empty()) size.push_back(0.5 * (size[a] + size[b]));
      });
  return inserted;
}

}  // namespace

SplitFacets split_facets(const std::vector<Vec3>& vertices, const std::vector<Triangle>& triangles,
                         const EdgeFlags& flags, std::vector<EdgeVertex> inserted) {
  SplitFacets out;
  Splitter splitter(vertices, std::move(inserted));
  for (std::size_t f = 0; f < triangles.size(); ++f)
    splitter.split(triangles[f], flags[f], static_cast<Index>(f), out);
  return out;
}

ResolvedSurface resolve_surface(const mesh::Surface& surface, const EdgeFlags& flags, double bound,
                                double feature_bound) {
  ResolvedSurface result;
  std::vector<Vec3> vertices = surface.vertices;
  std::vector<double> size = surface.size;
  SplitFacets facets{surface.triangles, flags, {}};
  facets.facet.resize(facets.triangles.size());
  std::iota(facets.facet.begin(), facets.facet.end(), 0);
  // On a needle, edges as short as its neighbours' would be more than anything else needs.
  const double most = kMostFacets * (static_cast<double>(surface.triangles.size()) + surface.area);
  while (static_cast<double>(facets.triangles.size()) < most) {
    std::vector<EdgeVertex> inserted =
        long_edges(facets.triangles, facets.flags, bound, feature_bound, vertices, size);
    if (inserted.empty()) break;
    SplitFacets finer = split_facets(vertices, facets.triangles, facets.flags, std::move(inserted));
    for (Index& f : finer.facet) f = facets.facet[f];
    facets = std::move(finer);
  }
  result.surface = mesh::make_surface(std::move(vertices), std::move(facets.triangles));
  result.surface.size = std::move(size);
  result.flags = std::move(facets.flags);
  result.facet = std::move(facets.facet);
  return result;
}

}  // namespace nonobtuse::features
