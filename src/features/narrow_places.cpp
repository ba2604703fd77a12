#include "features/narrow_places.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
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
constexpr double kWedge = 4;      // paths along curves shorter than this many distances: a corner
constexpr double kInwards = 0.3;  // cosine: how squarely the other curve is faced
constexpr double kClosedSegments = 6;
constexpr double kTurnSegments = 8;

constexpr double kInfinite = std::numeric_limits<double>::infinity();

// One side of a feature edge, from inside its patch.
struct Side {
  Index a = 0, b = 0;  // vertices of the cut surface
  Index patch = 0;
  Vec3 inward;
};

class WidthFinder {
 public:
  WidthFinder(const mesh::Surface& surface, const EdgeFlags& flags, double h)
      : surface_(surface), reach_(h / kOfWidth) {
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

  void bound(std::vector<double>& bounds) {
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
      for (const auto& n : near) width = std::min(width, width_to(p, sides_[n.site], width));
      if (width < reach_)
        bounds[cut_.original[p]] = std::min(bounds[cut_.original[p]], kOfWidth * width);
    }
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

}  // namespace

std::vector<double> narrow_places(const mesh::Surface& surface, const EdgeFlags& flags,
                                  const FeatureGraph& graph, double h) {
  std::vector<double> bounds(surface.vertices.size(), kInfinite);
  for (const FeatureCurve& curve : graph.curves) {
    const double length = curve_lengths(surface, curve).arc.back();
    const double bound = length / (kCurveSpacing * least_segments(surface, curve, length));
    if (!(bound < h)) continue;
    for (const Index v : curve.vertices) bounds[v] = std::min(bounds[v], bound);
  }
  WidthFinder(surface, flags, h).bound(bounds);
  return bounds;
}

}  // namespace nonobtuse::features
