#include "remesh/featured_part.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "features/feature_edges.h"
#include "features/knot_insertion.h"
#include "mesh/topology.h"
#include "nonobtuse/error.h"
#include "rdt/delaunay_flips.h"
#include "rdt/vertex_reduction.h"
#include "refine/angle_goal.h"
#include "remesh/edge_parting.h"
#include "remesh/initial_sampling.h"
#include "remesh/patch_meshing.h"
#include "remesh/refinement.h"
#include "remesh/request.h"
#include "remesh/unavoidable_corners.h"
#include "remesh/valence_optimization.h"
#include "spatial/triangle_bvh.h"

namespace nonobtuse::pipeline {

namespace {

constexpr double kSnap = 0.02;      // of an edge length
constexpr double kLeastAngle = 30;  // of the promise, degrees
// Parts in which few angles miss the promise are meshed again, if that does not take long.
constexpr int kAttempts = 2;
constexpr std::size_t kMostBroken = 40;
constexpr Index kMostVerticesAgain = 20000;
constexpr double kFiner = 0.6;  // of the longest edge of a triangle that breaks it

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
    if (part_edges(plan_.manifold, mesh_) > 0 && plan_.manifold) return {};
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
    if (extra < 0) return add(-extra);
    if (extra == 0) return;
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

  // Sites that coincide leave vertices over: these go on the longest edges.
  void add(Index missing) {
    for (; missing > 0; --missing) {
      mesh::Edge longest;
      double most = 0;
      for (Index t = 0; t < mesh_.triangle_capacity(); ++t)
        for (int k = 0; k < 3 && mesh_.alive_triangle(t); ++k) {
          const mesh::Edge e{t, k};
          if (mesh_.adjacent(t, k) < 0) continue;
          const Index a = mesh_.tail(e);
          const double l =
              distance(mesh_.positions[a], mesh_.positions[mesh_.head(e)]) / size_at(foot_[a]);
          if (l > most) most = l, longest = e;
        }
      if (!longest.valid()) return;
      foot_.push_back(foot_[mesh_.tail(longest)]);
      mesh_.split_edge(longest, 0.5 * (mesh_.positions[mesh_.tail(longest)] +
                                       mesh_.positions[mesh_.head(longest)]));
    }
    rdt::delaunay_flips(cut_.surface, foot_, mesh_);
  }

  [[nodiscard]] double size_at(Index facet) const {
    const std::vector<double>& size = cut_.surface.size;
    return size.empty() ? 1 : size[cut_.surface.triangles[facet][0]];
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
    glued.narrow_corners = narrow_sectors(cut_, network_);
    if (options_.boundary == Boundary::Freeze)
      for (const NarrowCorner& c : frozen_corners(mesh_, network_))
        if (std::none_of(glued.narrow_corners.begin(), glued.narrow_corners.end(),
                         [&](const NarrowCorner& other) { return other.vertex == c.vertex; }))
          glued.narrow_corners.push_back(c);
    for (NarrowCorner& c : glued.narrow_corners) c.vertex = of_knot[c.vertex];
    std::sort(glued.feature_edges.begin(), glued.feature_edges.end());
    glued.feature_edges.erase(std::unique(glued.feature_edges.begin(), glued.feature_edges.end()),
                              glued.feature_edges.end());
    return glued;
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

// Triangles that break the promise and touch no narrow corner.
std::vector<Index> broken_triangles(const GluedMesh& glued) {
  std::vector<char> narrow(glued.mesh.vertices.size(), 0);
  for (const NarrowCorner& corner : glued.narrow_corners) narrow[corner.vertex] = 1;
  const refine::AngleTest promise({kLeastAngle, 90});
  std::vector<Index> broken;
  for (std::size_t t = 0; t < glued.mesh.triangles.size(); ++t) {
    const Triangle& v = glued.mesh.triangles[t];
    const std::vector<Vec3>& x = glued.mesh.vertices;
    if (narrow[v[0]] == 0 && narrow[v[1]] == 0 && narrow[v[2]] == 0 &&
        !promise.inside(x[v[0]], x[v[1]], x[v[2]]))
      broken.push_back(static_cast<Index>(t));
  }
  return broken;
}

std::vector<FinePlace> fine_places(const TriangleMesh& mesh, const std::vector<Index>& triangles) {
  std::vector<FinePlace> places;
  for (const Index t : triangles) {
    const auto& [a, b, c] = mesh.triangles[t];
    const std::vector<Vec3>& x = mesh.vertices;
    const double longest =
        std::max({distance(x[a], x[b]), distance(x[b], x[c]), distance(x[c], x[a])});
    places.push_back({(x[a] + x[b] + x[c]) / 3.0, kFiner * longest});
  }
  return places;
}

}  // namespace

GluedMesh remesh_features(const Part& part, const FeaturePlan& plan, Index vertices,
                          const RemeshOptions& options, const parallel::Workers& workers,
                          StageClock& clock) {
  GluedMesh best = FeaturedPart(plan, vertices, options, workers, clock).run();
  if (best.mesh.triangles.empty() || vertices > kMostVerticesAgain) return best;
  std::vector<Index> broken = broken_triangles(best);
  std::vector<FinePlace> fine = fine_places(best.mesh, broken);
  for (int attempt = 0; attempt < kAttempts && !broken.empty() && broken.size() <= kMostBroken;
       ++attempt) {
    if (clock.monitor().cancelled()) break;
    GluedMesh next;
    try {
      const FeaturePlan finer = clock.run(
          "features", 0, 0.02, [&] { return plan_features(part, vertices, options, fine); });
      next = FeaturedPart(finer, vertices, options, workers, clock).run();
    } catch (const TooFewVertices&) {
      break;
    }
    if (next.mesh.triangles.empty() || clock.monitor().cancelled()) break;
    std::vector<Index> left = broken_triangles(next);
    const std::vector<FinePlace> places = fine_places(next.mesh, left);
    fine.insert(fine.end(), places.begin(), places.end());
    if (left.size() >= broken.size()) continue;
    best = std::move(next);
    broken = std::move(left);
  }
  return best;
}

}  // namespace nonobtuse::pipeline
