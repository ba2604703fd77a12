#include "features/narrow_corners.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "features/facet_splitting.h"
#include "mesh/cut.h"
#include "mesh/sector_valence.h"
#include "mesh/topology.h"

namespace nonobtuse::features {

namespace {

constexpr double kNarrow = 30;     // degrees
constexpr double kOneFits = 60;    // degrees: two triangles would each have less than 30
constexpr double kLargest = 86;    // degrees, beside a corner with one triangle
constexpr double kOneEdge = 1.65;  // of the reach: a curve this short has one edge
constexpr double kWhole = 1.15;    // of the reach: a curve this short is a first edge
// A first edge leaves room on its curve for an edge of this many times its length.
constexpr double kRest = 0.6;
constexpr double kSame = 1e-6;  // of an edge: a vertex this near is the one wanted

// One end of a curve.
struct CurveEnd {
  Index curve = 0;
  bool back = false;
};

bool operator<(const CurveEnd& a, const CurveEnd& b) {
  return std::pair(a.curve, a.back) < std::pair(b.curve, b.back);
}
bool same(const CurveEnd& a, const CurveEnd& b) { return !(a < b) && !(b < a); }

class CornerSettler {
 public:
  CornerSettler(mesh::Surface& surface, EdgeFlags& flags, FeatureGraph& graph, double reach,
                const std::vector<char>& held)
      : surface_(surface), flags_(flags), graph_(graph), reach_(reach), held_(held) {}

  std::vector<FirstEdge> run() {
    find_narrow_ends();
    std::vector<FirstEdge> edges;
    for (const auto& [corner, ends] : narrow_) {
      const double r = common_reach(corner, ends);
      for (const CurveEnd& e : ends) edges.push_back({corner, place(e, r)});
    }
    if (!inserted_.empty()) split();
    for (const FirstEdge& e : edges) graph_.corner[e.end] = 1;
    return edges;
  }

 private:
  [[nodiscard]] double size_at(Index v) const {
    return surface_.size.empty() ? 1 : surface_.size[v];
  }

  // For every corner the ends of the curves that bound a narrow sector there.
  void find_narrow_ends() {
    std::map<std::pair<Index, Index>, CurveEnd> end_at;  // by corner and next vertex
    for (std::size_t c = 0; c < graph_.curves.size(); ++c) {
      const FeatureCurve& curve = graph_.curves[c];
      if (curve.closed) continue;
      const auto last = curve.vertices.size() - 1;
      ++curves_between_[ends_of(curve)];
      end_at[{curve.vertices[0], curve.vertices[1]}] = {static_cast<Index>(c), false};
      end_at[{curve.vertices[last], curve.vertices[last - 1]}] = {static_cast<Index>(c), true};
    }
    const auto vertices = static_cast<Index>(surface_.vertices.size());
    const mesh::Cut cut = mesh::cut_along(surface_.triangles, vertices,
                                          mesh::edge_sides(surface_.triangles, vertices),
                                          [&](const mesh::EdgeSide* first, const mesh::EdgeSide*) {
                                            return flagged(flags_, first->triangle, first->corner);
                                          });
    std::vector<double> degrees(cut.original.size(), 0);
    std::vector<std::vector<Index>> across(cut.original.size());  // ends of flagged edges
    for (std::size_t f = 0; f < cut.triangles.size(); ++f)
      for (int k = 0; k < 3; ++k) {
        const Triangle& t = surface_.triangles[f];
        if (graph_.corner[t[k]] == 0) continue;
        const Index sector = cut.triangles[f][k];
        const Index next = t[mesh::next(k)], previous = t[mesh::previous(k)];
        degrees[sector] += mesh::corner_degrees(surface_.vertices[t[k]], surface_.vertices[next],
                                                surface_.vertices[previous]);
        if (flagged(flags_, static_cast<Index>(f), mesh::previous(k)))
          across[sector].push_back(next);
        if (flagged(flags_, static_cast<Index>(f), mesh::next(k)))
          across[sector].push_back(previous);
      }
    for (std::size_t s = 0; s < degrees.size(); ++s) {
      if (across[s].size() != 2 || degrees[s] >= kOneFits) continue;
      std::vector<CurveEnd> ends;
      for (const Index u : across[s])
        if (const auto e = end_at.find({cut.original[s], u}); e != end_at.end())
          if (held_.empty() || held_[e->second.curve] == 0) ends.push_back(e->second);
      if (ends.size() != 2) continue;
      if (degrees[s] >= kNarrow && one_triangle_fits(ends)) continue;
      std::vector<CurveEnd>& all = narrow_[cut.original[s]];
      all.insert(all.end(), ends.begin(), ends.end());
    }
    for (auto& [corner, ends] : narrow_) {
      std::sort(ends.begin(), ends.end());
      ends.erase(std::unique(ends.begin(), ends.end(), same), ends.end());
    }
  }

  // Vertex i of a curve, counted from one end.
  [[nodiscard]] Index vertex(const CurveEnd& e, std::size_t i) const {
    const std::vector<Index>& v = graph_.curves[e.curve].vertices;
    return e.back ? v[v.size() - 1 - i] : v[i];
  }
  [[nodiscard]] double from_corner(const CurveEnd& e, std::size_t i) const {
    return distance(surface_.vertices[vertex(e, 0)], surface_.vertices[vertex(e, i)]);
  }
  [[nodiscard]] std::size_t last(const CurveEnd& e) const {
    return graph_.curves[e.curve].vertices.size() - 1;
  }

  // How far the curve leads away from its corner before it comes back or ends; `whole` if it ends,
  // in a corner to which no other curve leads: two edges between the same vertices would be one.
  [[nodiscard]] double room(const CurveEnd& e, bool& whole) const {
    double far = 0;
    for (std::size_t i = 1; i <= last(e); ++i) {
      const double d = from_corner(e, i);
      whole = i == last(e);
      if (d <= far) {
        whole = false;
        break;
      }
      far = d;
    }
    if (whole) whole = curves_between_.at(ends_of(graph_.curves[e.curve])) == 1;
    return far;
  }
  [[nodiscard]] static std::pair<Index, Index> ends_of(const FeatureCurve& curve) {
    return std::minmax({curve.vertices.front(), curve.vertices.back()});
  }

  // Whether a triangle may have its other corners where the knots will be: they slide, but where
  // both curves are no longer than an edge.
  [[nodiscard]] bool one_triangle_fits(const std::vector<CurveEnd>& ends) const {
    const Index corner = vertex(ends[0], 0);
    std::array<Vec3, 2> p;
    for (int i = 0; i < 2; ++i) {
      bool whole = false;
      if (room(ends[i], whole) > kOneEdge * reach_ * size_at(corner) || !whole) return true;
      p[i] = surface_.vertices[vertex(ends[i], last(ends[i]))];
    }
    const Vec3& apex = surface_.vertices[corner];
    return mesh::corner_degrees(p[0], p[1], apex) <= kLargest &&
           mesh::corner_degrees(p[1], p[0], apex) <= kLargest;
  }

  // The longest first edges, no longer than the reach, that all curves have room for.
  [[nodiscard]] double common_reach(Index corner, const std::vector<CurveEnd>& ends) const {
    const double most = reach_ * size_at(corner);
    struct Room {
      double far;
      bool whole;
      double share;  // of it, that a first edge may take
    };
    std::vector<Room> rooms;
    std::vector<double> candidates{most};
    for (const CurveEnd& e : ends) {
      Room r{};
      r.far = room(e, r.whole);
      r.share = 1 / (1 + kRest + (also_narrow({e.curve, !e.back}) ? 1 : 0));
      rooms.push_back(r);
      if (r.whole && r.far <= kWhole * most) candidates.push_back(r.far);
      candidates.push_back(std::min(most, r.share * r.far));
    }
    const auto fits = [&](double length) {
      return std::all_of(rooms.begin(), rooms.end(), [&](const Room& r) {
        return length <= r.share * r.far || (r.whole && length == r.far);
      });
    };
    double longest = 0;
    for (const double c : candidates)
      if (c > longest && fits(c)) longest = c;
    return longest;
  }

  [[nodiscard]] bool also_narrow(const CurveEnd& e) const {
    const auto at = narrow_.find(vertex(e, 0));
    return at != narrow_.end() && std::any_of(at->second.begin(), at->second.end(),
                                              [&](const CurveEnd& o) { return same(o, e); });
  }

  // The vertex of the curve at distance r from its corner.
  Index place(const CurveEnd& e, double r) {
    std::size_t i = 1;
    while (i < last(e) && from_corner(e, i) < r) ++i;
    const Index b = vertex(e, i), a = vertex(e, i - 1);
    const double edge = distance(surface_.vertices[a], surface_.vertices[b]);
    if (from_corner(e, i) <= r + kSame * edge) return b;
    const double along = crossing(surface_.vertices[vertex(e, 0)], a, b, r);
    if (along * edge <= kSame * edge && i > 1) return a;
    const auto made =
        static_cast<Index>(surface_.vertices.size()) + static_cast<Index>(inserted_.size());
    inserted_.push_back(a < b ? EdgeVertex{a, b, along, made} : EdgeVertex{b, a, 1 - along, made});
    return made;
  }

  // Where the segment ab leaves the sphere of radius r around p: in [0, 1] from a.
  [[nodiscard]] double crossing(const Vec3& p, Index a, Index b, double r) const {
    const Vec3 d = surface_.vertices[b] - surface_.vertices[a];
    const Vec3 o = surface_.vertices[a] - p;
    const double dd = dot(d, d), od = dot(o, d);
    const double root = std::sqrt(std::max(0.0, od * od - dd * (dot(o, o) - r * r)));
    return std::clamp((root - od) / dd, 0.0, 1.0);
  }

  void split() {
    std::vector<Vec3> vertices = surface_.vertices;
    std::vector<double> size = surface_.size;
    for (const EdgeVertex& e : inserted_) {
      vertices.push_back((1 - e.along) * vertices[e.low] + e.along * vertices[e.high]);
      if (!size.empty()) size.push_back((1 - e.along) * size[e.low] + e.along * size[e.high]);
    }
    SplitFacets finer = split_facets(vertices, surface_.triangles, flags_, std::move(inserted_));
    surface_ = mesh::make_surface(std::move(vertices), std::move(finer.triangles));
    surface_.size = std::move(size);
    flags_ = std::move(finer.flags);
    graph_.corner.resize(surface_.vertices.size(), 0);
  }

  mesh::Surface& surface_;
  EdgeFlags& flags_;
  FeatureGraph& graph_;
  double reach_;
  const std::vector<char>& held_;
  std::map<std::pair<Index, Index>, Index> curves_between_;
  std::map<Index, std::vector<CurveEnd>> narrow_;
  std::vector<EdgeVertex> inserted_;
};

}  // namespace

std::vector<FirstEdge> settle_narrow_corners(mesh::Surface& surface, EdgeFlags& flags,
                                             FeatureGraph& graph, double reach,
                                             const std::vector<char>& held) {
  return CornerSettler(surface, flags, graph, reach, held).run();
}

std::vector<char> narrow_corner_marks(const mesh::Surface& surface, const FeatureGraph& graph,
                                      const std::vector<FirstEdge>& edges, double reach) {
  std::vector<char> marks(surface.vertices.size(), 0);
  if (edges.empty()) return marks;
  std::map<Index, Index> corner_of;  // of the outer ends
  for (const FirstEdge& e : edges) corner_of[e.end] = e.corner;
  const auto is_first = [&](Index a, Index b) {
    return std::any_of(edges.begin(), edges.end(),
                       [&](const FirstEdge& e) { return e.corner == a && e.end == b; });
  };
  const auto mark = [&](Index v, char as) { marks[v] = std::max(marks[v], as); };
  for (const FeatureCurve& curve : graph.curves) {
    if (curve.closed) continue;
    const Index front = curve.vertices.front(), back = curve.vertices.back();
    for (const auto& [from, to] : {std::pair(front, back), std::pair(back, front)}) {
      if (is_first(from, to)) {
        for (const Index v : curve.vertices)
          if (v != to) mark(v, 2);
      } else if (const auto at = corner_of.find(from); at != corner_of.end() && at->second != to) {
        for (const Index v : curve.vertices)
          if (distance(surface.vertices[v], surface.vertices[at->second]) < reach) mark(v, 1);
      }
    }
  }
  return marks;
}

}  // namespace nonobtuse::features
