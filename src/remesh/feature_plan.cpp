#include "remesh/feature_plan.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <optional>
#include <utility>

#include "features/crease_detection.h"
#include "features/facet_splitting.h"
#include "features/knot_insertion.h"
#include "features/narrow_corners.h"
#include "features/narrow_places.h"
#include "mesh/topology.h"
#include "nonobtuse/error.h"
#include "remesh/initial_sampling.h"
#include "remesh/size_field.h"
#include "sizing/density.h"
#include "sizing/gradation.h"

namespace nonobtuse::pipeline {

namespace {

constexpr double kShortestCrease = 1.5;  // of an edge length; shorter ones that end freely go
constexpr double kFlatWidth = 1.8;       // of an edge length: of the sides of a prism to be kept
constexpr double kFeatureEdge = 0.45;    // of an edge length: longest piece of a feature edge while
                                         // widths are measured
constexpr double kLeastSize = 0.05;      // of an edge length
constexpr double kFirstEdge = 1;         // of an edge length: from narrow corners
constexpr double kTightReach = 4;        // of it: how far beside them no inner vertices are needed
constexpr double kSteepest = 0.75;       // by how much sizes fall along first edges, per length
constexpr double kRounding = 1e-9;
constexpr int kSizeSteps = 8;
// Creases that would make all other edges longer than this many times are given up, the nearest to
// each other first.
constexpr double kMostGrowth = 1.5;
constexpr double kWorthwhile = 0.9;                  // part of the growth that is left
constexpr double kCloseCreases[] = {0.1, 0.2, 0.4};  // of an edge length

// The input cut open, without knots: what the patches are.
features::CutSurface patches_of(const mesh::Surface& surface, const features::EdgeFlags& flags) {
  features::KnottedSurface plain;
  plain.vertices = surface.vertices;
  plain.size = surface.size;
  plain.triangles = surface.triangles;
  plain.flags = flags;
  plain.facet.resize(flags.size());
  std::iota(plain.facet.begin(), plain.facet.end(), 0);
  plain.knot.assign(surface.vertices.size(), -1);
  return features::cut_open(plain);
}

// The patches between the curves of a surface, whatever the sizes on it.
struct PatchLayout {
  Components patches;
  std::vector<std::vector<Index>> facets;         // of each patch
  std::vector<std::vector<Index>> curve_patches;  // of each curve, one entry per side

  PatchLayout(const mesh::Surface& surface, const features::EdgeFlags& flags,
              const features::FeatureGraph& graph)
      : patches(connected_components(patches_of(surface, flags).surface)),
        facets(patches.count()),
        curve_patches(graph.curves.size()) {
    for (Index f = 0; f < static_cast<Index>(surface.triangles.size()); ++f)
      facets[patches.of_triangle[f]].push_back(f);
    const std::vector<mesh::EdgeSide> sides =
        mesh::edge_sides(surface.triangles, static_cast<Index>(surface.vertices.size()));
    for (std::size_t c = 0; c < graph.curves.size(); ++c) {
      const std::vector<Index>& v = graph.curves[c].vertices;
      const auto edge = std::minmax({v[0], v[1]});
      auto side = std::lower_bound(sides.begin(), sides.end(), edge,
                                   [](const mesh::EdgeSide& s, const std::pair<Index, Index>& e) {
                                     return std::pair(s.low, s.high) < e;
                                   });
      for (; side != sides.end() && std::pair(side->low, side->high) == edge; ++side)
        curve_patches[c].push_back(patches.of_triangle[side->triangle]);
    }
  }
};

std::vector<features::PatchDemand> patch_demands(const mesh::Surface& surface,
                                                 const PatchLayout& layout) {
  std::vector<features::PatchDemand> demands(layout.patches.count());
  for (Index p = 0; p < layout.patches.count(); ++p) {
    demands[p].area =
        surface.size.empty()
            ? layout.patches.area[p]
            : 0.5 * std::sqrt(3.0) * sizing::vertices_for(surface, surface.size, layout.facets[p]);
    demands[p].euler = layout.patches.euler[p];
  }
  return demands;
}

std::vector<features::CurveDemand> curve_demands(const FeaturePlan& plan, const PatchLayout& layout,
                                                 const std::vector<features::FirstEdge>& single) {
  const mesh::Surface& surface = plan.surface;
  std::map<std::pair<Index, Index>, int> between;  // curves with the same ends
  std::vector<Index> degree(surface.vertices.size(), 0);
  for (const features::FeatureCurve& c : plan.graph.curves)
    if (!c.closed) ++degree[c.vertices.front()], ++degree[c.vertices.back()];
  std::vector<features::CurveDemand> demands;
  for (std::size_t c = 0; c < plan.graph.curves.size(); ++c) {
    const features::FeatureCurve& curve = plan.graph.curves[c];
    features::CurveDemand d;
    d.length = features::curve_lengths(surface, curve).metric.back();
    d.closed = curve.closed;
    const auto ends = std::minmax({curve.vertices.front(), curve.vertices.back()});
    if (curve.closed || ends.first == ends.second) {
      d.least = 3;
    } else {
      const bool free = degree[ends.first] == 1 && degree[ends.second] == 1;
      d.least = between[ends]++ > 0 || free ? 2 : 1;
    }
    if (plan.frozen[c] != 0)
      d.fixed = static_cast<Index>(std::count_if(curve.vertices.begin(), curve.vertices.end(),
                                                 [&](Index v) { return v < plan.originals; })) -
                (curve.closed ? 0 : 1);
    if (std::any_of(single.begin(), single.end(), [&](const features::FirstEdge& e) {
          return !curve.closed && ends == std::minmax({e.corner, e.end});
        }))
      d.fixed = 1;
    d.patches = layout.curve_patches[c];
    demands.push_back(std::move(d));
  }
  return demands;
}

class Planner {
 public:
  Planner(const Part& part, Index vertices, const RemeshOptions& options,
          const std::vector<FinePlace>& places)
      : vertices_(vertices), options_(options), points_(part.points), places_(places) {
    plan_.input = normalize(part.mesh, vertices);
    plan_.originals = static_cast<Index>(plan_.input.surface.vertices.size());
    set_sizes(part.length, plan_.input);
    plan_.surface = plan_.input.surface;
    plan_.flags = part.features;
  }

  FeaturePlan run() {
    if (options_.features == Features::Auto)
      features::flag_coarse_creases(plan_.surface, kFlatWidth * kEdgeLength, plan_.flags);
    Start best{plan_.surface, plan_.flags};
    double growth = attempt(best);
    const double found = crease_length();
    if (growth <= kMostGrowth) return std::move(plan_);
    frugal_ = true;
    growth = attempt(best);
    bool last = true;  // whether the plan is that of `best`
    // Creases too near each other would take the vertices from everything else.
    for (const double close : kCloseCreases) {
      if (growth <= kMostGrowth || !may_give_up()) break;
      std::optional<Start> merged = merge_close_creases(best, close * kEdgeLength);
      if (!merged) continue;
      const double with = attempt(*merged);
      last = with <= growth;
      if (last) growth = with, best = std::move(*merged);
    }
    if (!last || !std::isfinite(growth)) start(best), settle();
    const double lost = found - crease_length();
    if (lost > kRounding * found) plan_.given_up = lost / plan_.input.map.scale;
    return std::move(plan_);
  }

 private:
  // What a plan is made from.
  struct Start {
    mesh::Surface surface;
    features::EdgeFlags flags;
  };

  bool start(const Start& from) {
    plan_.surface = from.surface;
    plan_.flags = from.flags;
    return find_curves();
  }

  // By how much edges grow where there are no features: infinite if there are too few vertices.
  double attempt(const Start& from) {
    if (!start(from)) return 0;
    try {
      return settle();
    } catch (const TooFewVertices&) {
      return std::numeric_limits<double>::infinity();
    }
  }

  // Curves and corners of the flags; false if there are none.
  bool find_curves() {
    layout_.reset();
    features::prune_creases(plan_.surface, kShortestCrease * kEdgeLength, plan_.flags);
    plan_.graph = features::feature_graph(plan_.surface, plan_.flags, {});
    if (plan_.graph.curves.empty() && points_.empty()) return false;
    plan_.graph = graph(plan_.surface, plan_.flags,
                        features::sharp_turns(plan_.surface, plan_.graph, kEdgeLength));
    plan_.manifold =
        points_.empty() && std::all_of(plan_.graph.curves.begin(), plan_.graph.curves.end(),
                                       [](const auto& curve) { return curve.facets <= 2; });
    find_frozen();
    first_edges_ = features::settle_narrow_corners(plan_.surface, plan_.flags, plan_.graph,
                                                   kFirstEdge * kEdgeLength, plan_.frozen);
    if (first_edges_.empty()) return true;
    plan_.graph = graph(plan_.surface, plan_.flags, plan_.graph.corner);
    find_frozen();
    return true;
  }

  // Of all curves but boundaries.
  [[nodiscard]] double crease_length() const {
    double sum = 0;
    for (const features::FeatureCurve& curve : plan_.graph.curves) {
      if (curve.boundary) continue;
      const std::vector<Index>& v = curve.vertices;
      for (std::size_t i = 1; i < v.size(); ++i)
        sum += distance(plan_.surface.vertices[v[i - 1]], plan_.surface.vertices[v[i]]);
      if (curve.closed)
        sum += distance(plan_.surface.vertices[v.back()], plan_.surface.vertices[v[0]]);
    }
    return sum;
  }

  // Shares the vertices out. Returns how many times longer edges become where no features are.
  double settle() {
    const double growth = find_sizes();
    balance();
    return growth;
  }

  // Creases that we found ourselves need not be kept.
  [[nodiscard]] bool may_give_up() const {
    const auto crease = [](const features::FeatureCurve& c) {
      return !c.boundary && c.facets == 2;
    };
    return options_.features == Features::Auto && options_.feature_edges.empty() &&
           std::any_of(plan_.graph.curves.begin(), plan_.graph.curves.end(), crease);
  }

  // Of creases nearer to each other than `width` the blunter go; nothing if there are none.
  [[nodiscard]] std::optional<Start> merge_close_creases(const Start& from, double width) {
    start(from);
    features::ResolvedSurface fine = features::resolve_surface(
        plan_.surface, plan_.flags, kEdgeLength, kFeatureEdge * kEdgeLength);
    const features::FeatureGraph graph = this->graph(fine.surface, fine.flags, plan_.graph.corner);
    if (!features::merge_close_curves(fine.surface, graph, width, fine.flags)) return {};
    return Start{std::move(fine.surface), std::move(fine.flags)};
  }

  // With the points in which patches touch among its corners.
  [[nodiscard]] features::FeatureGraph graph(const mesh::Surface& surface,
                                             const features::EdgeFlags& flags,
                                             std::vector<char> corner) const {
    corner.resize(surface.vertices.size(), 0);
    for (const Index v : points_) corner[v] = 1;
    features::FeatureGraph result = features::feature_graph(surface, flags, std::move(corner));
    for (const Index v : points_) result.corner[v] = 1;
    return result;
  }

  void find_frozen() {
    plan_.frozen.clear();
    for (const features::FeatureCurve& c : plan_.graph.curves)
      plan_.frozen.push_back(c.boundary && options_.boundary == Boundary::Freeze ? 1 : 0);
  }

  void balance() {
    if (!layout_) layout_.emplace(plan_.surface, plan_.flags, plan_.graph);
    plan_.balance = features::balance_vertices(curve_demands(plan_, *layout_, first_edges_),
                                               patch_demands(plan_.surface, *layout_),
                                               plan_.graph.corner_count(), vertices_);
  }

  // Edges shorter than asked for where features need it, and along frozen boundaries as long as
  // they are there. Returns by how much edges grow where neither matters.
  double find_sizes() {
    const double largest =
        plan_.surface.size.empty()
            ? 1
            : *std::max_element(plan_.surface.size.begin(), plan_.surface.size.end());
    features::ResolvedSurface fine = features::resolve_surface(
        plan_.surface, plan_.flags, kEdgeLength, kFeatureEdge * kEdgeLength);
    features::FeatureGraph graph = this->graph(fine.surface, fine.flags, plan_.graph.corner);
    std::vector<double> bounds = features::narrow_places(
        fine.surface, fine.flags, graph, largest * kEdgeLength, frugal_,
        features::narrow_corner_marks(fine.surface, graph, first_edges_,
                                      kTightReach * kFirstEdge * kEdgeLength));
    bound_places(fine.surface, bounds);
    const std::vector<double> asked = fine.surface.size;
    const auto local = [&](std::size_t v) { return asked.empty() ? 1.0 : asked[v]; };
    const std::vector<double> given = frozen_lengths(fine.surface);
    bool narrow = !given.empty();
    for (std::size_t v = 0; v < bounds.size(); ++v)
      narrow = narrow || bounds[v] < kEdgeLength * local(v);
    if (!narrow) return 1;
    plan_.surface = std::move(fine.surface);
    plan_.flags = std::move(fine.flags);
    plan_.graph = std::move(graph);
    layout_.reset();
    find_frozen();
    // The bounds are lengths and stay; the rest grows until the whole asks for the right number.
    double h = kEdgeLength;
    for (int step = 0; step < kSizeSteps; ++step) {
      std::vector<double>& size = plan_.surface.size;
      size.resize(bounds.size());
      for (std::size_t v = 0; v < size.size(); ++v)
        size[v] = std::min(h * local(v), std::max(bounds[v], kLeastSize * kEdgeLength));
      for (std::size_t v = 0; v < given.size(); ++v)
        if (given[v] > 0) size[v] = given[v];
      sizing::limit_gradation(plan_.surface, options_.gradation, size);
      raise_to(given, options_.gradation, size);
      raise_to(first_lengths(), kSteepest, size);
      balance();
      h *= plan_.balance.edge_length;
      if (std::abs(plan_.balance.edge_length - 1) < 1e-3) break;
    }
    // In the units that the other stages expect.
    std::vector<double> length = std::move(plan_.surface.size);
    NormalizedInput sized{std::move(plan_.surface), {}};
    set_sizes(length, sized);
    plan_.surface = std::move(sized.surface);
    return h / kEdgeLength;
  }

  // Bounds at the vertices within an edge of a fine place, the nearest at any rate.
  void bound_places(const mesh::Surface& fine, std::vector<double>& bounds) const {
    for (const FinePlace& place : places_) {
      std::size_t nearest = 0;
      double least = std::numeric_limits<double>::infinity();
      for (std::size_t v = 0; v < bounds.size(); ++v) {
        const double d = distance(fine.vertices[v], place.at);
        if (d < least) least = d, nearest = v;
        if (d < place.length) bounds[v] = std::min(bounds[v], place.length);
      }
      bounds[nearest] = std::min(bounds[nearest], place.length);
    }
  }

  // #V: the mean length of the frozen edges at a vertex, 0 elsewhere; empty if there are none.
  [[nodiscard]] std::vector<double> frozen_lengths(const mesh::Surface& fine) const {
    std::vector<double> lengths;
    for (std::size_t c = 0; c < plan_.graph.curves.size(); ++c) {
      if (plan_.frozen[c] == 0) continue;
      lengths.resize(fine.vertices.size(), 0);
      const std::vector<Index>& v = plan_.graph.curves[c].vertices;
      for (std::size_t i = 0; i < v.size(); ++i) {
        const bool closed = plan_.graph.curves[c].closed;
        const std::size_t before = i > 0 ? i - 1 : closed ? v.size() - 1 : i + 1;
        const std::size_t after = i + 1 < v.size() ? i + 1 : closed ? 0 : i - 1;
        const double mean = 0.5 * (distance(fine.vertices[v[before]], fine.vertices[v[i]]) +
                                   distance(fine.vertices[v[after]], fine.vertices[v[i]]));
        lengths[v[i]] = mean / features::kCurveSpacing;
      }
    }
    return lengths;
  }

  // #V: what fits the first edge at a narrow corner, 0 elsewhere; empty if there are none.
  [[nodiscard]] std::vector<double> first_lengths() const {
    std::vector<double> lengths;
    if (first_edges_.empty()) return lengths;
    lengths.resize(plan_.surface.vertices.size(), 0);
    for (const features::FirstEdge& e : first_edges_)
      lengths[e.corner] =
          distance(plan_.surface.vertices[e.corner], plan_.surface.vertices[e.end]) /
          features::kCurveSpacing;
    return lengths;
  }

  // Sizes not below what the given ones, falling by the gradation with distance, leave.
  void raise_to(const std::vector<double>& given, double gradation,
                std::vector<double>& size) const {
    if (given.empty()) return;
    const double largest = *std::max_element(given.begin(), given.end());
    std::vector<double> fall(size.size(), std::numeric_limits<double>::infinity());
    for (std::size_t v = 0; v < given.size(); ++v)
      if (given[v] > 0) fall[v] = largest - given[v];
    sizing::limit_gradation(plan_.surface, gradation, fall);
    for (std::size_t v = 0; v < size.size(); ++v) size[v] = std::max(size[v], largest - fall[v]);
  }

  Index vertices_;
  const RemeshOptions& options_;
  const std::vector<Index>& points_;
  const std::vector<FinePlace>& places_;
  FeaturePlan plan_;
  std::optional<PatchLayout> layout_;  // of the plan's surface and flags, if it was asked for
  std::vector<features::FirstEdge> first_edges_;  // of narrow corners
  bool frugal_ = false;
};

}  // namespace

FeaturePlan plan_features(const Part& part, Index vertices, const RemeshOptions& options,
                          const std::vector<FinePlace>& fine) {
  return Planner(part, vertices, options, fine).run();
}

}  // namespace nonobtuse::pipeline
