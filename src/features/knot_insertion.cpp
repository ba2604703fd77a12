#include "features/knot_insertion.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>
#include <utility>

#include "mesh/cut.h"
#include "mesh/topology.h"

namespace nonobtuse::features {

namespace {

double size_at(const std::vector<double>& size, Index v) { return size.empty() ? 1 : size[v]; }

// A new vertex on an edge of the surface.
struct OnEdge {
  Index low, high;
  double along;  // from low to high, in (0, 1)
  Index vertex;
};

class Inserter {
 public:
  Inserter(const mesh::Surface& surface, const EdgeFlags& flags, const FeatureGraph& graph,
           double snap)
      : surface_(surface), flags_(flags), graph_(graph), snap_(snap) {
    out_.vertices = surface.vertices;
    out_.size = surface.size;
    out_.knot.assign(surface.vertices.size(), -1);
  }

  KnottedSurface run(const std::vector<Index>& segments, const std::vector<char>& frozen) {
    for (Index v = 0; v < static_cast<Index>(graph_.corner.size()); ++v)
      if (graph_.corner[v] != 0) add_knot({}, v);
    for (std::size_t c = 0; c < graph_.curves.size(); ++c) {
      add_curve(graph_.curves[c]);
      if (!frozen.empty() && frozen[c] != 0)
        freeze(graph_.curves[c]);
      else
        place(static_cast<Index>(c), segments[c]);
    }
    std::sort(on_edges_.begin(), on_edges_.end(), [](const OnEdge& a, const OnEdge& b) {
      return std::tie(a.low, a.high, a.along, a.vertex) < std::tie(b.low, b.high, b.along, b.vertex);
    });
    split_facets();
    return std::move(out_);
  }

 private:
  void add_knot(mesh::Knot knot, Index vertex) {
    out_.knot[vertex] = static_cast<Index>(out_.network.knots.size());
    out_.network.knots.push_back(knot);
    const bool of_surface = vertex < static_cast<Index>(surface_.vertices.size());
    out_.source.push_back(of_surface ? vertex : -1);
  }

  void add_curve(const FeatureCurve& curve) {
    std::vector<Vec3> points;
    for (const Index v : curve.vertices) points.push_back(surface_.vertices[v]);
    out_.network.curves.push_back(mesh::make_curve(std::move(points), curve.closed));
  }

  void freeze(const FeatureCurve& curve) {
    for (const Index v : curve.vertices)
      if (out_.knot[v] < 0) add_knot({}, v);
  }

  // Knots at equal steps of the metric; inside an edge the metric is taken as linear in the arc.
  void place(Index c, Index segments) {
    const FeatureCurve& curve = graph_.curves[c];
    const CurveLengths lengths = curve_lengths(surface_, curve);
    const auto count = static_cast<Index>(curve.vertices.size());
    const Index edges = curve.closed ? count : count - 1;
    Index i = 0;
    for (Index k = curve.closed ? 0 : 1; k < segments; ++k) {
      const double target = lengths.metric.back() * k / segments;
      while (i + 1 < edges && lengths.metric[i + 1] <= target) ++i;
      const double step = lengths.metric[i + 1] - lengths.metric[i];
      const double along = step > 0 ? std::clamp((target - lengths.metric[i]) / step, 0.0, 1.0) : 0;
      const double arc = lengths.arc[i] + along * (lengths.arc[i + 1] - lengths.arc[i]);
      const Index a = curve.vertices[i];
      const Index b = curve.vertices[(i + 1) % count];
      const double snap = snap_ * size_at(surface_.size, a);
      if (arc - lengths.arc[i] <= snap && free(a)) {
        add_knot({c, lengths.arc[i]}, a);
      } else if (lengths.arc[i + 1] - arc <= snap && free(b)) {
        add_knot({c, i + 1 == count ? 0 : lengths.arc[i + 1]}, b);
      } else {
        add_vertex(a, b, along);
        add_knot({c, arc}, static_cast<Index>(out_.vertices.size()) - 1);
      }
    }
  }

  [[nodiscard]] bool free(Index v) const { return out_.knot[v] < 0; }

  void add_vertex(Index a, Index b, double along) {
    const auto vertex = static_cast<Index>(out_.vertices.size());
    on_edges_.push_back(a < b ? OnEdge{a, b, along, vertex} : OnEdge{b, a, 1 - along, vertex});
    out_.vertices.push_back((1 - along) * surface_.vertices[a] + along * surface_.vertices[b]);
    if (!out_.size.empty())
      out_.size.push_back((1 - along) * surface_.size[a] + along * surface_.size[b]);
    out_.knot.push_back(-1);
  }

  // New vertices on the edge from a to b, in that order.
  [[nodiscard]] std::vector<Index> between(Index a, Index b) const {
    const auto key = std::pair(std::min(a, b), std::max(a, b));
    auto at = std::lower_bound(
        on_edges_.begin(), on_edges_.end(), key,
        [](const OnEdge& e, const auto& k) { return std::pair(e.low, e.high) < k; });
    std::vector<Index> vertices;
    for (; at != on_edges_.end() && std::pair(at->low, at->high) == key; ++at)
      vertices.push_back(at->vertex);
    if (a > b) std::reverse(vertices.begin(), vertices.end());
    return vertices;
  }

  struct Piece {
    Triangle corners;
    std::array<std::vector<Index>, 3> inserted;  // on edge k, from corner k+1 to corner k+2
    std::uint8_t flags;
  };

  // Bisects a facet at the middle one of the new vertices on an edge, until none is left. Every
  // facet on its own: an edge may have any number of them.
  void split_facets() {
    for (Index f = 0; f < static_cast<Index>(surface_.triangles.size()); ++f) {
      const Triangle& t = surface_.triangles[f];
      std::vector<Piece> stack{{t, {}, flags_[f]}};
      for (int k = 0; k < 3; ++k)
        if (flagged(flags_, f, k))
          stack.front().inserted[k] = between(t[mesh::next(k)], t[mesh::previous(k)]);
      while (!stack.empty()) {
        const Piece piece = std::move(stack.back());
        stack.pop_back();
        int k = 0;
        for (int j = 1; j < 3; ++j)
          if (piece.inserted[j].size() > piece.inserted[k].size()) k = j;
        if (piece.inserted[k].empty()) {
          out_.triangles.push_back(piece.corners);
          out_.flags.push_back(piece.flags);
          out_.facet.push_back(f);
        } else {
          bisect(piece, k, stack);
        }
      }
    }
  }

  static void bisect(const Piece& piece, int k, std::vector<Piece>& stack) {
    const auto bit = [&](int edge, int as) {
      return static_cast<std::uint8_t>((piece.flags >> edge & 1) << as);
    };
    const int n = mesh::next(k);
    const int p = mesh::previous(k);
    const std::vector<Index>& line = piece.inserted[k];
    const auto middle = line.begin() + static_cast<std::ptrdiff_t>(line.size() / 2);
    const auto& c = piece.corners;
    stack.push_back({{c[k], *middle, c[p]},
                     {std::vector<Index>(middle + 1, line.end()), piece.inserted[n], {}},
                     static_cast<std::uint8_t>(bit(k, 0) | bit(n, 1))});
    stack.push_back({{c[k], c[n], *middle},
                     {std::vector<Index>(line.begin(), middle), {}, piece.inserted[p]},
                     static_cast<std::uint8_t>(bit(k, 0) | bit(p, 2))});
  }

  const mesh::Surface& surface_;
  const EdgeFlags& flags_;
  const FeatureGraph& graph_;
  double snap_;
  KnottedSurface out_;
  std::vector<OnEdge> on_edges_;
};

}  // namespace

KnottedSurface insert_knots(const mesh::Surface& surface, const EdgeFlags& flags,
                            const FeatureGraph& graph, const std::vector<Index>& segments,
                            const std::vector<char>& frozen, double snap) {
  return Inserter(surface, flags, graph, snap).run(segments, frozen);
}

CutSurface cut_open(const KnottedSurface& knotted) {
  const auto vertices = static_cast<Index>(knotted.vertices.size());
  mesh::Cut fans =
      mesh::cut_along(knotted.triangles, vertices, mesh::edge_sides(knotted.triangles, vertices),
                      [&](const mesh::EdgeSide* first, const mesh::EdgeSide*) {
                        return flagged(knotted.flags, first->triangle, first->corner);
                      });
  CutSurface cut;
  std::vector<Vec3> positions;
  std::vector<double> size;
  for (const Index v : fans.original) {
    positions.push_back(knotted.vertices[v]);
    if (!knotted.size.empty()) size.push_back(knotted.size[v]);
    cut.knot.push_back(knotted.knot[v]);
  }
  cut.surface = mesh::make_surface(std::move(positions), std::move(fans.triangles));
  cut.surface.size = std::move(size);
  cut.facet = knotted.facet;
  return cut;
}

}  // namespace nonobtuse::features
