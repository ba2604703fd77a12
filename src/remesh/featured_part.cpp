#include "remesh/featured_part.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <utility>

#include "features/crease_detection.h"
#include "features/facet_splitting.h"
#include "features/knot_insertion.h"
#include "features/narrow_places.h"
#include "mesh/topology.h"
#include "nonobtuse/error.h"
#include "rdt/delaunay_flips.h"
#include "rdt/vertex_reduction.h"
#include "remesh/initial_sampling.h"
#include "remesh/patch_meshing.h"
#include "remesh/refinement.h"
#include "remesh/request.h"
#include "remesh/size_field.h"
#include "remesh/valence_optimization.h"
#include "sizing/density.h"
#include "sizing/gradation.h"

namespace nonobtuse::pipeline {

namespace {

// Edge length of a uniform mesh in working coordinates, where area / #V = 1.
const double kEdgeLength = std::sqrt(2 / std::sqrt(3.0));
constexpr double kShortestCrease = 1.5;  // of an edge length; shorter ones that end freely go
constexpr double kFlatWidth = 1.8;       // of an edge length: of the sides of a prism to be kept
constexpr double kSnap = 0.02;           // of an edge length
constexpr double kFeatureEdge = 0.45;    // of an edge length: longest piece of a feature edge while
                                         // widths are measured
constexpr double kLeastSize = 0.05;      // of an edge length
constexpr int kSizeSteps = 8;
constexpr double kLeastAngle = 30;  // of the promise, degrees
constexpr double kDegreesPerRadian = 180 / 3.14159265358979323846;

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

std::vector<features::PatchDemand> patch_demands(const mesh::Surface& cut,
                                                 const Components& patches) {
  std::vector<features::PatchDemand> demands(patches.count());
  std::vector<std::vector<Index>> facets(patches.count());
  for (Index f = 0; f < static_cast<Index>(cut.triangles.size()); ++f)
    facets[patches.of_triangle[f]].push_back(f);
  for (Index p = 0; p < patches.count(); ++p) {
    demands[p].area = cut.size.empty()
                          ? patches.area[p]
                          : 0.5 * std::sqrt(3.0) * sizing::vertices_for(cut, cut.size, facets[p]);
    demands[p].euler = patches.euler[p];
  }
  return demands;
}

std::vector<features::CurveDemand> curve_demands(const FeaturePlan& plan,
                                                 const Components& patches) {
  const mesh::Surface& surface = plan.surface;
  const std::vector<mesh::EdgeSide> sides =
      mesh::edge_sides(surface.triangles, static_cast<Index>(surface.vertices.size()));
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
    const auto edge = std::minmax({curve.vertices[0], curve.vertices[1]});
    auto side = std::lower_bound(sides.begin(), sides.end(), edge,
                                 [](const mesh::EdgeSide& s, const std::pair<Index, Index>& e) {
                                   return std::pair(s.low, s.high) < e;
                                 });
    for (; side != sides.end() && std::pair(side->low, side->high) == edge; ++side)
      d.patches.push_back(patches.of_triangle[side->triangle]);
    demands.push_back(std::move(d));
  }
  return demands;
}

// Every second knot along every curve, and all that are fixed.
std::vector<char> coarse_knots(const mesh::CurveNetwork& network) {
  std::vector<Index> seen(network.curves.size(), 0);
  std::vector<char> coarse;
  for (const mesh::Knot& k : network.knots)
    coarse.push_back(
        k.curve < 0 || (seen[k.curve]++ + (network.curves[k.curve].closed ? 0 : 1)) % 2 == 0 ? 1
                                                                                             : 0);
  return coarse;
}

std::vector<Patch> cut_patches(const features::CutSurface& cut, const Components& components,
                               const std::vector<Index>& interior) {
  std::vector<Patch> patches(components.count());
  std::vector<std::vector<Vec3>> positions(patches.size());
  std::vector<std::vector<double>> sizes(patches.size());
  std::vector<std::vector<Triangle>> triangles(patches.size());
  std::vector<Index> local(cut.knot.size(), -1);
  for (Index f = 0; f < static_cast<Index>(cut.surface.triangles.size()); ++f) {
    const Index p = components.of_triangle[f];
    Triangle t = cut.surface.triangles[f];
    for (Index& v : t) {
      if (local[v] < 0) {
        local[v] = static_cast<Index>(positions[p].size());
        positions[p].push_back(cut.surface.vertices[v]);
        patches[p].knot.push_back(cut.knot[v]);
        if (!cut.surface.size.empty()) sizes[p].push_back(cut.surface.size[v]);
      }
      v = local[v];
    }
    triangles[p].push_back(t);
    patches[p].facet.push_back(f);
  }
  for (std::size_t p = 0; p < patches.size(); ++p) {
    patches[p].surface = mesh::make_surface(std::move(positions[p]), std::move(triangles[p]));
    patches[p].surface.size = std::move(sizes[p]);
    patches[p].euler = components.euler[static_cast<Index>(p)];
    patches[p].interior = interior[p];
  }
  return patches;
}

// The number of vertices once equal knots are one.
Index glued_count(const mesh::EditableMesh& mesh, std::size_t knots) {
  Index copies = 0;
  for (const Index k : mesh.knot) copies += k >= 0 ? 1 : 0;
  return mesh.vertex_count() - copies + static_cast<Index>(knots);
}

class FeaturedPart {
 public:
  FeaturedPart(const FeaturePlan& plan, Index vertices, const RemeshOptions& options,
               const parallel::Workers& workers, StageClock& clock)
      : plan_(plan), vertices_(vertices), options_(options), workers_(workers), clock_(clock) {}

  GluedMesh run() {
    parallel::Monitor& monitor = clock_.monitor();
    clock_.run("features", 0, 0.02, [&] { cut(); });
    clock_.run("cvt", 0.02, 0.5, [&] { mesh_patches(); });
    reduce();
    // Too few vertices between the features: the edges of two patches would become one.
    if (separate_chords() > 0 && plan_.manifold) return {};
    if (!monitor.cancelled()) {
      const spatial::TriangleBvh bvh(cut_.surface.vertices, cut_.surface.triangles, workers_);
      clock_.run("valence", 0.5, 0.55, [&] {
        return optimize_valence(cut_.surface, bvh, mesh_, workers_, monitor, &network_);
      });
      clock_.run("refinement", 0.55, 1, [&] {
        return refine(cut_.surface, bvh, mesh_, refinement_options(options_), workers_, monitor,
                      &network_);
      });
    }
    return glue();
  }

 private:
  void cut() {
    features::KnottedSurface knotted =
        features::insert_knots(plan_.surface, plan_.flags, plan_.graph, plan_.balance.segments,
                               plan_.frozen, kSnap * kEdgeLength, plan_.originals);
    network_ = std::move(knotted.network);
    source_ = std::move(knotted.source);
    cut_ = features::cut_open(knotted);
  }

  // Every patch on its own: sites of one can then never own a part of another.
  void mesh_patches() {
    const Components components = connected_components(cut_.surface);
    const std::vector<Patch> patches = cut_patches(cut_, components, plan_.balance.interior);
    const std::vector<char> coarse = coarse_knots(network_);
    std::vector<Vec3> positions;
    std::vector<Triangle> triangles;
    std::vector<Index> knot;
    double done = 0;
    for (std::size_t p = 0; p < patches.size(); ++p) {
      const PatchMesh meshed = mesh_patch(patches[p], coarse, options_.seed + 0x9e3779b9 * p,
                                          workers_, clock_.monitor());
      const auto shift = static_cast<Index>(positions.size());
      for (const Triangle& t : meshed.mesh.triangles())
        triangles.push_back({t[0] + shift, t[1] + shift, t[2] + shift});
      for (Index v = 0; v < meshed.mesh.vertex_count(); ++v) {
        positions.push_back(meshed.mesh.positions[v]);
        knot.push_back(meshed.mesh.knot[v]);
        foot_.push_back(patches[p].facet[meshed.foot[v]]);
      }
      done += components.area[static_cast<Index>(p)];
      clock_.monitor().tick(done / cut_.surface.area);
    }
    mesh_ = mesh::EditableMesh(std::move(positions), std::move(triangles));
    mesh_.knot = std::move(knot);
  }

  // Where the topology of one patch needed more vertices, others give theirs.
  void reduce() {
    const Index extra = glued_count(mesh_, network_.knots.size()) - vertices_;
    if (extra <= 0) return;
    rdt::reduce_vertices(cut_.surface, mesh_.vertex_count() - extra, mesh_, foot_);
    rdt::delaunay_flips(cut_.surface, foot_, mesh_);
    const Index left = glued_count(mesh_, network_.knots.size());
    if (left > vertices_)
      throw TooFewVertices(
          fmt::format("The features and the topology of the surface need more than "
                      "the {} vertices asked for: {} were reached.",
                      vertices_, left),
          left);
  }

  // Flips interior edges between knots that are joined elsewhere too, since gluing would make them
  // one edge of four faces. Returns how many are left.
  Index separate_chords() {
    using Pair = std::pair<Index, Index>;
    const auto pair_of = [&](mesh::Edge e) {
      const Index k = mesh_.knot[mesh_.tail(e)], l = mesh_.knot[mesh_.head(e)];
      return Pair{std::min(k, l), std::max(k, l)};
    };
    std::vector<Pair> taken;
    std::vector<mesh::Edge> chords;
    for (Index t = 0; t < mesh_.triangle_capacity(); ++t) {
      if (!mesh_.alive_triangle(t)) continue;
      for (int k = 0; k < 3; ++k) {
        const mesh::Edge e{t, k};
        if (mesh_.adjacent(t, k) < 0) {
          taken.push_back(pair_of(e));
        } else if (mesh_.adjacent(t, k) > t && pair_of(e).first >= 0) {
          chords.push_back(e);
        }
      }
    }
    std::sort(taken.begin(), taken.end());
    std::vector<std::pair<Pair, Index>> ends;  // of each chord: its knots and its vertices
    std::vector<Pair> vertices;
    for (const mesh::Edge& e : chords) {
      ends.emplace_back(pair_of(e), static_cast<Index>(vertices.size()));
      vertices.emplace_back(mesh_.tail(e), mesh_.head(e));
    }
    std::sort(ends.begin(), ends.end());
    Index left = 0;
    for (std::size_t i = 0; i < ends.size(); ++i) {
      const Pair& knots = ends[i].first;
      const bool again = i > 0 && ends[i - 1].first == knots;
      if (!again && knots.first != knots.second &&
          !std::binary_search(taken.begin(), taken.end(), knots))
        continue;
      const Pair& v = vertices[ends[i].second];
      const mesh::Edge e = mesh_.find_edge(v.first, v.second);
      const bool flips = e.valid() && mesh_.can_flip(e) &&
                         (mesh_.knot[mesh_.opposite_vertex(e)] < 0 ||
                          mesh_.knot[mesh_.opposite_vertex(mesh_.twin(e))] < 0);
      if (flips)
        mesh_.flip(e);
      else
        ++left;
    }
    return left;
  }

  GluedMesh glue() const {
    GluedMesh glued;
    std::vector<Index> of_knot(network_.knots.size(), -1);
    std::vector<Index> number(mesh_.vertex_capacity(), -1);
    for (Index v = 0; v < mesh_.vertex_capacity(); ++v) {
      if (!mesh_.alive_vertex(v)) continue;
      const Index k = mesh_.knot[v];
      if (k >= 0 && of_knot[k] >= 0) {
        number[v] = of_knot[k];
        continue;
      }
      number[v] = static_cast<Index>(glued.mesh.vertices.size());
      if (k >= 0) of_knot[k] = number[v];
      glued.mesh.vertices.push_back(mesh_.positions[v]);
      // Knots that refinement has added come after those with a source.
      const bool given = k >= 0 && k < static_cast<Index>(source_.size());
      glued.source.push_back(given && network_.knots[k].curve < 0 ? source_[k] : -1);
    }
    for (Index t = 0; t < mesh_.triangle_capacity(); ++t) {
      if (!mesh_.alive_triangle(t)) continue;
      const Triangle& c = mesh_.triangle(t);
      glued.mesh.triangles.push_back({number[c[0]], number[c[1]], number[c[2]]});
      for (int e = 0; e < 3; ++e) {
        if (mesh_.adjacent(t, e) >= 0) continue;
        const Index a = number[c[mesh::next(e)]];
        const Index b = number[c[mesh::previous(e)]];
        glued.feature_edges.push_back({std::min(a, b), std::max(a, b)});
      }
    }
    glued.narrow_corners = narrow_corners(of_knot);
    std::sort(glued.feature_edges.begin(), glued.feature_edges.end());
    glued.feature_edges.erase(std::unique(glued.feature_edges.begin(), glued.feature_edges.end()),
                              glued.feature_edges.end());
    return glued;
  }

  // Sectors of the surface at fixed knots with a face angle below the promise.
  [[nodiscard]] std::vector<NarrowCorner> narrow_corners(const std::vector<Index>& of_knot) const {
    std::vector<double> angle(cut_.knot.size(), 0);
    for (const Triangle& t : cut_.surface.triangles)
      for (int k = 0; k < 3; ++k) {
        if (cut_.knot[t[k]] < 0) continue;
        const Vec3 a = cut_.surface.vertices[t[mesh::next(k)]] - cut_.surface.vertices[t[k]];
        const Vec3 b = cut_.surface.vertices[t[mesh::previous(k)]] - cut_.surface.vertices[t[k]];
        angle[t[k]] += std::atan2(length(cross(a, b)), dot(a, b)) * kDegreesPerRadian;
      }
    std::vector<NarrowCorner> corners;
    for (std::size_t v = 0; v < angle.size(); ++v) {
      const Index k = cut_.knot[v];
      if (k >= 0 && network_.knots[k].curve < 0 && angle[v] < kLeastAngle)
        corners.push_back({of_knot[k], angle[v], 0});
    }
    return corners;
  }

  const FeaturePlan& plan_;
  Index vertices_;
  const RemeshOptions& options_;
  const parallel::Workers& workers_;
  StageClock& clock_;
  mesh::CurveNetwork network_;
  std::vector<Index> source_;  // #knots
  features::CutSurface cut_;
  mesh::EditableMesh mesh_;
  std::vector<Index> foot_;
};

class Planner {
 public:
  Planner(const Part& part, Index vertices, const RemeshOptions& options)
      : vertices_(vertices), options_(options), points_(part.points) {
    plan_.input = normalize(part.mesh, vertices);
    plan_.originals = static_cast<Index>(plan_.input.surface.vertices.size());
    set_sizes(part.length, plan_.input);
    plan_.surface = plan_.input.surface;
    plan_.flags = part.features;
  }

  FeaturePlan run() {
    if (options_.features == Features::Auto)
      features::flag_coarse_creases(plan_.surface, kFlatWidth * kEdgeLength, plan_.flags);
    features::prune_creases(plan_.surface, kShortestCrease * kEdgeLength, plan_.flags);
    plan_.graph = features::feature_graph(plan_.surface, plan_.flags, {});
    if (plan_.graph.curves.empty() && points_.empty()) return std::move(plan_);
    plan_.graph = graph(plan_.surface, plan_.flags,
                        features::sharp_turns(plan_.surface, plan_.graph, kEdgeLength));
    plan_.manifold =
        points_.empty() && std::all_of(plan_.graph.curves.begin(), plan_.graph.curves.end(),
                                       [](const auto& curve) { return curve.facets <= 2; });
    find_frozen();
    find_sizes();
    balance();
    return std::move(plan_);
  }

 private:
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
    const features::CutSurface cut = patches_of(plan_.surface, plan_.flags);
    const Components patches = connected_components(cut.surface);
    plan_.balance = features::balance_vertices(curve_demands(plan_, patches),
                                               patch_demands(cut.surface, patches),
                                               plan_.graph.corner_count(), vertices_);
  }

  // Edges shorter than asked for where features need it, and along frozen boundaries as long as
  // they are there.
  void find_sizes() {
    const double largest =
        plan_.surface.size.empty()
            ? 1
            : *std::max_element(plan_.surface.size.begin(), plan_.surface.size.end());
    features::ResolvedSurface fine = features::resolve_surface(
        plan_.surface, plan_.flags, kEdgeLength, kFeatureEdge * kEdgeLength);
    features::FeatureGraph graph = this->graph(fine.surface, fine.flags, plan_.graph.corner);
    const std::vector<double> bounds =
        features::narrow_places(fine.surface, fine.flags, graph, largest * kEdgeLength);
    const std::vector<double> asked = fine.surface.size;
    const auto local = [&](std::size_t v) { return asked.empty() ? 1.0 : asked[v]; };
    const std::vector<double> given = frozen_lengths(fine.surface);
    bool narrow = !given.empty();
    for (std::size_t v = 0; v < bounds.size(); ++v)
      narrow = narrow || bounds[v] < kEdgeLength * local(v);
    if (!narrow) return;
    plan_.surface = std::move(fine.surface);
    plan_.flags = std::move(fine.flags);
    plan_.graph = std::move(graph);
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
      raise_to(given, size);
      balance();
      h *= plan_.balance.edge_length;
      if (std::abs(plan_.balance.edge_length - 1) < 1e-3) break;
    }
    // In the units that the other stages expect.
    std::vector<double> length = std::move(plan_.surface.size);
    NormalizedInput sized{std::move(plan_.surface), {}};
    set_sizes(length, sized);
    plan_.surface = std::move(sized.surface);
    balance();
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

  // Sizes not below what the given ones, falling by the gradation with distance, leave.
  void raise_to(const std::vector<double>& given, std::vector<double>& size) const {
    if (given.empty()) return;
    const double largest = *std::max_element(given.begin(), given.end());
    std::vector<double> fall(size.size(), std::numeric_limits<double>::infinity());
    for (std::size_t v = 0; v < given.size(); ++v)
      if (given[v] > 0) fall[v] = largest - given[v];
    sizing::limit_gradation(plan_.surface, options_.gradation, fall);
    for (std::size_t v = 0; v < size.size(); ++v) size[v] = std::max(size[v], largest - fall[v]);
  }

  Index vertices_;
  const RemeshOptions& options_;
  const std::vector<Index>& points_;
  FeaturePlan plan_;
};

}  // namespace

FeaturePlan plan_features(const Part& part, Index vertices, const RemeshOptions& options) {
  return Planner(part, vertices, options).run();
}

GluedMesh remesh_features(const FeaturePlan& plan, Index vertices, const RemeshOptions& options,
                          const parallel::Workers& workers, StageClock& clock) {
  return FeaturedPart(plan, vertices, options, workers, clock).run();
}

}  // namespace nonobtuse::pipeline
