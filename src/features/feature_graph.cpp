#include "features/feature_graph.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "mesh/topology.h"

namespace nonobtuse::features {

namespace {

// A feature edge once, with its number of facets.
struct GraphEdge {
  Index a = 0, b = 0;
  Index facets = 2;
  bool used = false;
};

class Tracer {
 public:
  Tracer(const mesh::Surface& surface, const EdgeFlags& flags, std::vector<char> corner) {
    graph_.corner = std::move(corner);
    const auto vertices = static_cast<Index>(surface.vertices.size());
    graph_.corner.resize(vertices, 0);
    mesh::for_each_edge(
        mesh::edge_sides(surface.triangles, vertices),
        [&](const mesh::EdgeSide* first, const mesh::EdgeSide* last) {
          if (flagged(flags, first->triangle, first->corner))
            edges_.push_back({first->low, first->high, static_cast<Index>(last - first)});
        });
    start_.assign(vertices + 1, 0);
    for (const GraphEdge& e : edges_) ++start_[e.a + 1], ++start_[e.b + 1];
    for (Index v = 0; v < vertices; ++v) start_[v + 1] += start_[v];
    at_.resize(2 * edges_.size());
    std::vector<Index> fill(start_.begin(), start_.end() - 1);
    for (std::size_t e = 0; e < edges_.size(); ++e) {
      at_[fill[edges_[e].a]++] = static_cast<Index>(e);
      at_[fill[edges_[e].b]++] = static_cast<Index>(e);
    }
    for (Index v = 0; v < vertices; ++v) {
      const Index degree = start_[v + 1] - start_[v];
      if (degree == 0)
        graph_.corner[v] = 0;
      else if (degree != 2 || edges_[at_[start_[v]]].facets != edges_[at_[start_[v] + 1]].facets)
        graph_.corner[v] = 1;
    }
  }

  FeatureGraph run() {
    const auto vertices = static_cast<Index>(graph_.corner.size());
    for (Index v = 0; v < vertices; ++v)
      if (graph_.corner[v] != 0)
        for (Index i = start_[v]; i < start_[v + 1]; ++i)
          if (!edges_[at_[i]].used) trace(v, at_[i]);
    for (std::size_t e = 0; e < edges_.size(); ++e)
      if (!edges_[e].used) trace(edges_[e].a, static_cast<Index>(e));
    return std::move(graph_);
  }

 private:
  void trace(Index v, Index e) {
    FeatureCurve curve;
    const Index first = v;
    curve.facets = edges_[e].facets;
    curve.boundary = curve.facets == 1;
    curve.vertices.push_back(v);
    for (;;) {
      edges_[e].used = true;
      v = edges_[e].a == v ? edges_[e].b : edges_[e].a;
      if (graph_.corner[v] != 0) {
        curve.vertices.push_back(v);
        break;
      }
      if (v == first) {
        curve.closed = true;
        break;
      }
      curve.vertices.push_back(v);
      e = at_[start_[v]] == e ? at_[start_[v] + 1] : at_[start_[v]];
    }
    graph_.curves.push_back(std::move(curve));
  }

  FeatureGraph graph_;
  std::vector<GraphEdge> edges_;
  std::vector<Index> start_, at_;  // edges at each vertex
};

constexpr double kTurnScale = 0.75;     // of h: the half-length of the secants
constexpr double kCosSharpTurn = 0.77;  // a little below 40 degrees
constexpr double kCosVerySharp = 0.4;   // kept however near the next corner is
constexpr double kCornerSpacing = 0.7;  // of h
// Where the polyline's own segments are longer than this many h, a turn of 12 degrees is a corner:
// the curve is coarser than the mesh.
constexpr double kLongSegment = 1.8;
constexpr double kCosSlightTurn = 0.978;

double size_at(const mesh::Surface& surface, Index v) {
  return surface.size.empty() ? 1 : surface.size[v];
}

// A curve as a polyline that can be asked for points by arc.
class Polyline {
 public:
  Polyline(const mesh::Surface& surface, const FeatureCurve& curve)
      : surface_(surface), curve_(curve), lengths_(curve_lengths(surface, curve)) {}

  [[nodiscard]] Index count() const { return static_cast<Index>(curve_.vertices.size()); }
  [[nodiscard]] double arc(Index i) const { return lengths_.arc[i]; }
  [[nodiscard]] double length() const { return lengths_.arc.back(); }
  // The shorter of the segments before and after vertex i.
  [[nodiscard]] double segment(Index i) const {
    const double before = i > 0 ? arc(i) - arc(i - 1) : length() - arc(count() - 1);
    return std::min(before, lengths_.arc[i + 1] - arc(i));
  }
  [[nodiscard]] Vec3 vertex(Index i) const {
    return surface_.vertices[curve_.vertices[i % count()]];
  }
  // Open curves end at their ends.
  [[nodiscard]] Vec3 point(double at) const {
    if (curve_.closed) {
      at -= length() * std::floor(at / length());
    } else {
      at = std::clamp(at, 0.0, length());
    }
    const auto& arcs = lengths_.arc;
    Index i = static_cast<Index>(std::upper_bound(arcs.begin(), arcs.end(), at) - arcs.begin()) - 1;
    i = std::clamp<Index>(i, 0, (curve_.closed ? count() : count() - 1) - 1);
    const double step = arcs[i + 1] - arcs[i];
    const double w = step > 0 ? (at - arcs[i]) / step : 0;
    return (1 - w) * vertex(i) + w * vertex(i + 1);
  }
  // Cosine of the turn at vertex i between secants of length r.
  [[nodiscard]] double turn(Index i, double r) const {
    const Vec3 p = vertex(i);
    return dot(normalized(p - point(arc(i) - r)), normalized(point(arc(i) + r) - p));
  }

 private:
  const mesh::Surface& surface_;
  const FeatureCurve& curve_;
  CurveLengths lengths_;
};

void mark_turns(const mesh::Surface& surface, const FeatureCurve& curve, double h,
                std::vector<char>& marks) {
  const Polyline line(surface, curve);
  struct Turn {
    double cosine;
    Index i;
  };
  std::vector<Turn> turns;
  const Index first = curve.closed ? 0 : 1;
  const Index last = curve.closed ? line.count() : line.count() - 1;
  for (Index i = first; i < last; ++i) {
    const double local = h * size_at(surface, curve.vertices[i]);
    const double near = line.turn(i, 1e-3 * local);
    const double far = line.turn(i, kTurnScale * local);
    const bool coarse = line.segment(i) > kLongSegment * local;
    if (std::max(near, far) < (coarse ? kCosSlightTurn : kCosSharpTurn))
      turns.push_back({std::max(near, far), i});
  }
  std::sort(turns.begin(), turns.end(), [](const Turn& a, const Turn& b) {
    return a.cosine != b.cosine ? a.cosine < b.cosine : a.i < b.i;
  });
  std::vector<double> taken;
  if (!curve.closed) taken = {0, line.length()};
  for (const Turn& t : turns) {
    const double at = line.arc(t.i);
    const double apart = kCornerSpacing * h * size_at(surface, curve.vertices[t.i]);
    const bool crowded = std::any_of(taken.begin(), taken.end(), [&](double other) {
      double d = std::abs(other - at);
      if (curve.closed) d = std::min(d, line.length() - d);
      return d < apart;
    });
    if (crowded && t.cosine > kCosVerySharp) continue;
    taken.push_back(at);
    marks[curve.vertices[t.i]] = 1;
  }
}

// A corner for every side of the bounding box that only curves touch, none of them in a corner.
void mark_box(const mesh::Surface& surface, const FeatureGraph& graph, std::vector<char>& marks) {
  std::vector<char> on_curve(surface.vertices.size(), 0);
  for (const FeatureCurve& c : graph.curves)
    for (const Index v : c.vertices) on_curve[v] = 1;
  const auto coordinate = [&](Index v, int side) {
    const Vec3& p = surface.vertices[v];
    const double c = side / 2 == 0 ? p.x : side / 2 == 1 ? p.y : p.z;
    return side % 2 == 0 ? c : -c;
  };
  for (int side = 0; side < 6; ++side) {
    double most = -std::numeric_limits<double>::infinity();
    for (const Triangle& t : surface.triangles)
      for (const Index v : t) most = std::max(most, coordinate(v, side));
    Index candidate = -1;
    bool held = false;
    for (const Triangle& t : surface.triangles)
      for (const Index v : t) {
        if (coordinate(v, side) < most) continue;
        if (on_curve[v] == 0 || graph.corner[v] != 0 || marks[v] != 0) held = true;
        if (candidate < 0 || v < candidate) candidate = v;
      }
    if (!held) marks[candidate] = 1;
  }
}

}  // namespace

Index FeatureGraph::corner_count() const {
  return static_cast<Index>(std::count(corner.begin(), corner.end(), 1));
}

FeatureGraph feature_graph(const mesh::Surface& surface, const EdgeFlags& flags,
                           std::vector<char> corner) {
  return Tracer(surface, flags, std::move(corner)).run();
}

CurveLengths curve_lengths(const mesh::Surface& surface, const FeatureCurve& curve) {
  CurveLengths lengths;
  double arc = 0;
  double metric = 0;
  const auto count = static_cast<Index>(curve.vertices.size());
  for (Index i = 0; i < count; ++i) {
    lengths.arc.push_back(arc);
    lengths.metric.push_back(metric);
    if (i + 1 == count && !curve.closed) break;
    const Index a = curve.vertices[i];
    const Index b = curve.vertices[(i + 1) % count];
    const double d = distance(surface.vertices[a], surface.vertices[b]);
    arc += d;
    metric += 0.5 * d * (1 / size_at(surface, a) + 1 / size_at(surface, b));
  }
  lengths.arc.push_back(arc);
  lengths.metric.push_back(metric);
  return lengths;
}

std::vector<char> sharp_turns(const mesh::Surface& surface, const FeatureGraph& graph, double h) {
  std::vector<char> marks(surface.vertices.size(), 0);
  for (const FeatureCurve& curve : graph.curves) mark_turns(surface, curve, h, marks);
  mark_box(surface, graph, marks);
  return marks;
}

bool prune_creases(const mesh::Surface& surface, double shortest, EdgeFlags& flags) {
  bool any = false;
  for (bool again = true; again;) {
    again = false;
    const FeatureGraph graph = feature_graph(surface, flags, {});
    std::vector<Index> degree(surface.vertices.size(), 0);
    for (const FeatureCurve& c : graph.curves)
      if (!c.closed) ++degree[c.vertices.front()], ++degree[c.vertices.back()];
    std::vector<std::array<Index, 2>> dropped;
    for (const FeatureCurve& c : graph.curves) {
      if (c.closed || c.facets != 2) continue;
      if (degree[c.vertices.front()] != 1 && degree[c.vertices.back()] != 1) continue;
      if (curve_lengths(surface, c).metric.back() >= shortest) continue;
      for (std::size_t i = 0; i + 1 < c.vertices.size(); ++i)
        dropped.push_back({std::min(c.vertices[i], c.vertices[i + 1]),
                           std::max(c.vertices[i], c.vertices[i + 1])});
    }
    if (dropped.empty()) break;
    std::sort(dropped.begin(), dropped.end());
    for (std::size_t f = 0; f < flags.size(); ++f)
      for (int k = 0; k < 3; ++k) {
        if (!flagged(flags, static_cast<Index>(f), k)) continue;
        const Triangle& t = surface.triangles[f];
        const Index a = t[mesh::next(k)];
        const Index b = t[mesh::previous(k)];
        if (!std::binary_search(dropped.begin(), dropped.end(),
                                std::array<Index, 2>{std::min(a, b), std::max(a, b)}))
          continue;
        flags[f] = static_cast<std::uint8_t>(flags[f] & ~(1 << k));
        again = any = true;
      }
  }
  return any;
}

}  // namespace nonobtuse::features
