#include "features/narrow_places.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <queue>
#include <utility>

#include "features/knot_insertion.h"
#include "features/vertex_balance.h"
#include "mesh/cut.h"
#include "mesh/topology.h"
#include "spatial/kd_tree.h"

namespace nonobtuse::features {

namespace {

constexpr double kOfWidth = 0.7;
constexpr double kOfRing = 1;     // between closed curves a strip needs no row of inner vertices
constexpr double kWedge = 4;      // paths along curves shorter than this many distances: a corner
constexpr double kInwards = 0.3;  // cosine: how squarely the other curve is faced
constexpr double kClosedSegments = 6;
constexpr double kTurnSegments = 8;
constexpr double kMostOfCurve = 0.5;

constexpr double kInfinite = std::numeric_limits<double>::infinity();

class WidthFinder {
 public:
  // One side of a feature edge, from inside its patch.
  struct Side {
    Index a = 0, b = 0;  // vertices of the cut surface
    Index patch = 0;
    Vec3 inward;
  };

  // Finds widths up to `reach`.
  WidthFinder(const mesh::Surface& surface, const EdgeFlags& flags, double reach)
      : surface_(surface), reach_(reach) {
    const auto vertices = static_cast<Index>(surface.vertices.size());
    const std::vector<mesh::EdgeSide> sides = mesh::edge_sides(surface.triangles, vertices);
    cut_ = mesh::cut_along(surface.triangles, vertices, sides,
                           [&](const mesh::EdgeSide* first, const mesh::EdgeSide*) {
                             return flagged(flags, first->triangle, first->corner);
                           });
    find_patches();
    link_features(sides, flags);
    find_sides(flags);
  }

  // `tight` (#V): 1 on curves that need not be told apart by inner vertices, 2 where no width
  // counts.
  void bound(const std::vector<char>& tight, std::vector<double>& bounds) {
    for_each_place([&](Index v, const Side& side, double width) {
      if (tight[v] == 2) return;
      const bool ring = tight[v] != 0 && tight[ends(side).first] != 0;
      bounds[v] = std::min(bounds[v], (ring ? kOfRing : kOfWidth) * width);
    });
  }

  // Calls visit(vertex, side across, width) for every vertex of a side of a curve that faces a
  // side at less than `reach`: the nearest one.
  template <class Visit>
  void for_each_place(const Visit& visit) {
    if (sides_.empty()) return;
    std::vector<Vec3> middles;
    double longest = 0;
    for (const Side& s : sides_) {
      middles.push_back(0.5 * (at(s.a) + at(s.b)));
      longest = std::max(longest, distance(at(s.a), at(s.b)));
    }
    const spatial::NearestSites index(middles);
    std::vector<spatial::NearestSites::Neighbor> near;
    for (Index p = 0; p < static_cast<Index>(cut_.original.size()); ++p) {
      if (patch_of_[p] < 0) continue;
      index.within(at(p), reach_ + 0.5 * longest, near);
      double width = reach_;
      const Side* across = nullptr;
      for (const auto& n : near)
        if (const double w = width_to(p, sides_[n.site], width); w < width)
          width = w, across = &sides_[n.site];
      if (across) visit(cut_.original[p], *across, width);
    }
  }

  // Ends of the side, as vertices of the surface.
  [[nodiscard]] std::pair<Index, Index> ends(const Side& side) const {
    return std::minmax({cut_.original[side.a], cut_.original[side.b]});
  }

 private:
  [[nodiscard]] const Vec3& at(Index cut_vertex) const {
    return surface_.vertices[cut_.original[cut_vertex]];
  }

  void find_patches() {
    adjacent_ = mesh::triangle_adjacency(cut_.triangles, static_cast<Index>(cut_.original.size()));
    patch_.assign(cut_.triangles.size(), -1);
    std::vector<Index> stack;
    Index count = 0;
    for (Index seed = 0; seed < static_cast<Index>(patch_.size()); ++seed) {
      if (patch_[seed] >= 0) continue;
      stack.assign(1, seed);
      patch_[seed] = count;
      while (!stack.empty()) {
        const Index t = stack.back();
        stack.pop_back();
        for (const Index u : adjacent_[t])
          if (u >= 0 && patch_[u] < 0) {
            patch_[u] = count;
            stack.push_back(u);
          }
      }
      ++count;
    }
  }

  // Neighbours along the features, for distances along them.
  void link_features(const std::vector<mesh::EdgeSide>& sides, const EdgeFlags& flags) {
    links_.resize(surface_.vertices.size());
    mesh::for_each_edge(sides, [&](const mesh::EdgeSide* first, const mesh::EdgeSide*) {
      if (!flagged(flags, first->triangle, first->corner)) return;
      links_[first->low].push_back(first->high);
      links_[first->high].push_back(first->low);
    });
    distance_.assign(surface_.vertices.size(), kInfinite);
  }

  void find_sides(const EdgeFlags& flags) {
    patch_of_.assign(cut_.original.size(), -1);
    inward_.assign(cut_.original.size(), {});
    for (Index t = 0; t < static_cast<Index>(cut_.triangles.size()); ++t)
      for (int k = 0; k < 3; ++k) {
        if (!flagged(flags, t, k)) continue;
        const Index a = cut_.triangles[t][mesh::next(k)];
        const Index b = cut_.triangles[t][mesh::previous(k)];
        const Vec3 inward = normalized(cross(surface_.normals[t], at(b) - at(a)));
        sides_.push_back({a, b, patch_[t], inward});
        for (const Index v : {a, b}) {
          patch_of_[v] = patch_[t];
          inward_[v] += inward;
        }
      }
    for (Vec3& d : inward_) d = normalized(d);
  }

  // How far the side is from p straight through their patch, if that is less than `least`.
  double width_to(Index p, const Side& side, double least) {
    if (side.patch != patch_of_[p] || side.a == p || side.b == p) return least;
    const Vec3 edge = at(side.b) - at(side.a);
    const double l2 = squared_length(edge);
    const double w = l2 > 0 ? std::clamp(dot(at(p) - at(side.a), edge) / l2, 0.0, 1.0) : 0;
    const Vec3 q = at(side.a) + w * edge;
    const double d = distance(at(p), q);
    if (!(d < least) || !(d > 0)) return least;
    const bool end = squared_length(inward_[p]) == 0;  // of a crease: any direction is inwards
    if (!end && dot(q - at(p), inward_[p]) < kInwards * d) return least;
    if (dot(at(p) - q, side.inward) < kInwards * d) return least;
    return path(p, side, q, kWedge * d) < kWedge * d ? least : d;
  }

  // Length of the way from p to q along features, or infinite if that is more than `most`.
  double path(Index p, const Side& side, const Vec3& q, double most) {
    using Entry = std::pair<double, Index>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
    reached_.assign(1, cut_.original[p]);
    distance_[reached_.front()] = 0;
    queue.push({0, reached_.front()});
    while (!queue.empty()) {
      const auto [d, v] = queue.top();
      queue.pop();
      if (d > distance_[v] || d > most) continue;
      for (const Index u : links_[v]) {
        const double far = d + distance(surface_.vertices[u], surface_.vertices[v]);
        if (!(far < distance_[u])) continue;
        if (distance_[u] == kInfinite) reached_.push_back(u);
        distance_[u] = far;
        queue.push({far, u});
      }
    }
    const double result = std::min(distance_[cut_.original[side.a]] + distance(at(side.a), q),
                                   distance_[cut_.original[side.b]] + distance(at(side.b), q));
    for (const Index v : reached_) distance_[v] = kInfinite;
    return result;
  }

  const mesh::Surface& surface_;
  double reach_;
  mesh::Cut cut_;
  std::vector<std::array<Index, 3>> adjacent_;
  std::vector<Index> patch_;     // of cut triangles
  std::vector<Index> patch_of_;  // of cut vertices on features
  std::vector<Vec3> inward_;
  std::vector<Side> sides_;
  std::vector<std::vector<Index>> links_;
  std::vector<double> distance_;
  std::vector<Index> reached_;
};

// Segments that a curve needs to keep its shape.
double least_segments(const mesh::Surface& surface, const FeatureCurve& curve, double length) {
  if (curve.closed || curve.vertices.front() == curve.vertices.back()) return kClosedSegments;
  const double chord =
      distance(surface.vertices[curve.vertices.front()], surface.vertices[curve.vertices.back()]);
  return std::max(1.0, std::ceil(kTurnSegments * (1 - chord / length) - 0.1));
}

template <class Visit>
void for_each_link(const FeatureCurve& curve, const Visit& visit) {
  const std::vector<Index>& v = curve.vertices;
  for (std::size_t i = 1; i < v.size(); ++i) visit(v[i - 1], v[i]);
  if (curve.closed) visit(v.back(), v.front());
}

using CurveOfEdge = std::map<std::pair<Index, Index>, Index>;

std::pair<Index, Index> edge_ends(const mesh::Surface& surface, Index facet, int k) {
  const Triangle& t = surface.triangles[facet];
  return std::minmax({t[mesh::next(k)], t[mesh::previous(k)]});
}

// How much the surface turns at each curve: integral of 1 - cosine over its length.
std::vector<double> total_turns(const mesh::Surface& surface, const EdgeFlags& flags,
                                const CurveOfEdge& curve_of, std::size_t curves) {
  std::vector<double> turn(curves, 0);
  for (Index f = 0; f < static_cast<Index>(flags.size()); ++f)
    for (int k = 0; k < 3; ++k) {
      const Index g = surface.adjacent[f][k];
      if (!flagged(flags, f, k) || g < f) continue;
      const std::pair<Index, Index> ends = edge_ends(surface, f, k);
      const auto at = curve_of.find(ends);
      if (at == curve_of.end()) continue;
      const double l = distance(surface.vertices[ends.first], surface.vertices[ends.second]);
      turn[at->second] += l * (1 - dot(surface.normals[f], surface.normals[g]));
    }
  return turn;
}

// #curves: the least vertex of all curves that a curve is connected with, not counting curves
// shorter than `shortest`.
std::vector<Index> networks(const mesh::Surface& surface, const FeatureGraph& graph,
                            double shortest) {
  std::vector<Index> label(surface.vertices.size());
  std::iota(label.begin(), label.end(), 0);
  const auto root = [&](Index v) {
    while (label[v] != v) v = label[v] = label[label[v]];
    return v;
  };
  for (const FeatureCurve& curve : graph.curves) {
    if (curve_lengths(surface, curve).arc.back() < shortest) continue;
    const Index a = root(curve.vertices.front()), b = root(curve.vertices.back());
    label[std::max(a, b)] = std::min(a, b);
  }
  std::vector<Index> result;
  for (const FeatureCurve& curve : graph.curves) result.push_back(root(curve.vertices.front()));
  return result;
}

}  // namespace

std::vector<double> narrow_places(const mesh::Surface& surface, const EdgeFlags& flags,
                                  const FeatureGraph& graph, double h, bool frugal,
                                  const std::vector<char>& marks) {
  std::vector<double> bounds(surface.vertices.size(), kInfinite);
  for (const FeatureCurve& curve : graph.curves) {
    const double length = curve_lengths(surface, curve).arc.back();
    const double bound = length / (kCurveSpacing * least_segments(surface, curve, length));
    if (!(bound < h)) continue;
    for (const Index v : curve.vertices) bounds[v] = std::min(bounds[v], bound);
  }
  std::vector<char> tight = marks;
  tight.resize(surface.vertices.size(), 0);
  for (const FeatureCurve& curve : graph.curves)
    for (const Index v : curve.vertices)
      if (frugal && curve.closed && tight[v] == 0) tight[v] = 1;
  WidthFinder(surface, flags, h / kOfWidth).bound(tight, bounds);
  return bounds;
}

bool merge_close_curves(const mesh::Surface& surface, const FeatureGraph& graph, double width,
                        EdgeFlags& flags) {
  if (graph.curves.empty()) return false;
  CurveOfEdge curve_of;
  for (std::size_t c = 0; c < graph.curves.size(); ++c)
    for_each_link(graph.curves[c], [&](Index a, Index b) {
      curve_of[std::minmax({a, b})] = static_cast<Index>(c);
    });
  const std::vector<double> turn = total_turns(surface, flags, curve_of, graph.curves.size());
  std::vector<std::vector<Index>> across(surface.vertices.size());  // curves near a vertex
  WidthFinder finder(surface, flags, width);
  finder.for_each_place([&](Index v, const WidthFinder::Side& side, double) {
    across[v].push_back(curve_of.at(finder.ends(side)));
  });
  std::vector<Index> order(graph.curves.size());
  std::iota(order.begin(), order.end(), 0);
  // Of equals, as the two rims of a plate, whole networks yield, so that they do not take turns.
  const std::vector<Index> network = networks(surface, graph, 2 * width);
  const double unit = std::max(1e-300, 1e-6 * *std::max_element(turn.begin(), turn.end()));
  const auto key = [&](Index c) { return std::pair(std::round(turn[c] / unit), network[c]); };
  std::stable_sort(order.begin(), order.end(), [&](Index a, Index b) { return key(a) < key(b); });
  std::vector<Index> rank(order.size());
  for (std::size_t i = 0; i < order.size(); ++i) rank[order[i]] = static_cast<Index>(i);
  CurveOfEdge given_up;
  for (Index c = 0; c < static_cast<Index>(graph.curves.size()); ++c) {
    const FeatureCurve& curve = graph.curves[c];
    if (curve.boundary || curve.facets != 2) continue;
    const auto yields = [&](Index v) {
      return std::any_of(across[v].begin(), across[v].end(),
                         [&](Index other) { return rank[other] > rank[c]; });
    };
    double close = 0, whole = 0;
    for_each_link(curve, [&](Index a, Index b) {
      const double l = distance(surface.vertices[a], surface.vertices[b]);
      whole += l;
      if (!yields(a) || !yields(b)) return;
      close += l;
      given_up[std::minmax({a, b})] = c;
    });
    if (close > kMostOfCurve * whole)
      for_each_link(curve, [&](Index a, Index b) { given_up[std::minmax({a, b})] = c; });
  }
  for (Index f = 0; f < static_cast<Index>(flags.size()); ++f)
    for (int k = 0; k < 3; ++k) {
      if (given_up.count(edge_ends(surface, f, k)) != 0)
        flags[f] = static_cast<std::uint8_t>(flags[f] & ~(1 << k));
    }
  return !given_up.empty();
}

}  // namespace nonobtuse::features
