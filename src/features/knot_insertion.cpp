#include "features/knot_insertion.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "features/facet_splitting.h"
#include "mesh/cut.h"
#include "mesh/topology.h"

namespace nonobtuse::features {

namespace {

double size_at(const std::vector<double>& size, Index v) { return size.empty() ? 1 : size[v]; }

class Inserter {
 public:
  Inserter(const mesh::Surface& surface, const EdgeFlags& flags, const FeatureGraph& graph,
           double snap, Index originals)
      : surface_(surface), flags_(flags), graph_(graph), snap_(snap), originals_(originals) {
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
    SplitFacets split =
        split_facets(out_.vertices, surface_.triangles, flags_, std::move(on_edges_));
    out_.triangles = std::move(split.triangles);
    out_.flags = std::move(split.flags);
    out_.facet = std::move(split.facet);
    return std::move(out_);
  }

 private:
  void add_knot(mesh::Knot knot, Index vertex) {
    out_.knot[vertex] = static_cast<Index>(out_.network.knots.size());
    out_.network.knots.push_back(knot);
    out_.source.push_back(vertex < originals_ ? vertex : -1);
  }

  void add_curve(const FeatureCurve& curve) {
    std::vector<Vec3> points;
    for (const Index v : curve.vertices) points.push_back(surface_.vertices[v]);
    out_.network.curves.push_back(mesh::make_curve(std::move(points), curve.closed));
  }

  void freeze(const FeatureCurve& curve) {
    for (const Index v : curve.vertices)
      if (v < originals_ && out_.knot[v] < 0) add_knot({}, v);
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
    on_edges_.push_back(a < b ? EdgeVertex{a, b, along, vertex}
                              : EdgeVertex{b, a, 1 - along, vertex});
    out_.vertices.push_back((1 - along) * surface_.vertices[a] + along * surface_.vertices[b]);
    if (!out_.size.empty())
      out_.size.push_back((1 - along) * surface_.size[a] + along * surface_.size[b]);
    out_.knot.push_back(-1);
  }

  const mesh::Surface& surface_;
  const EdgeFlags& flags_;
  const FeatureGraph& graph_;
  double snap_;
  Index originals_;
  KnottedSurface out_;
  std::vector<EdgeVertex> on_edges_;
};

}  // namespace

KnottedSurface insert_knots(const mesh::Surface& surface, const EdgeFlags& flags,
                            const FeatureGraph& graph, const std::vector<Index>& segments,
                            const std::vector<char>& frozen, double snap, Index originals) {
  return Inserter(surface, flags, graph, snap, originals).run(segments, frozen);
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
