#include "refine/distance_polish.h"

#include <algorithm>
#include <cmath>

#include "refine/neighborhood.h"
#include "refine/relaxation.h"

namespace nonobtuse::refine {
namespace {

constexpr int kRounds = 6;
constexpr int kPatience = 2;          // rounds that bring nothing
constexpr double kGrowth = 2;         // of the weights of the farthest points
constexpr double kNearLargest = 0.7;  // points at this part of the largest distance count as far
constexpr double kFarFactor = 3;      // in root mean square distances
constexpr double kNewWeight = 0.2;    // of vertices of M that become samples

// A sample, the middle of edge `edge` of the triangle, or a vertex, whichever is not -1.
struct FarPoint {
  double distance;
  Index triangle;
  Index sample, edge, vertex;

  double& factor(Fidelity& fidelity) const {
    return sample >= 0 ? fidelity.samples[sample].weight
           : edge >= 0 ? fidelity.edge_planes[triangle][edge].emphasis
                       : fidelity.vertex_planes[vertex].emphasis;
  }
};

spatial::TriangleBvh hierarchy(const mesh::EditableMesh& mesh, const parallel::Workers& workers) {
  std::vector<Triangle> triangles;
  for (const Triangle& t : mesh.triangles())
    if (t[0] >= 0) triangles.push_back(t);
  return {mesh.positions, triangles, workers};
}

// Keeps book of the points of both sides that are at least `far` from the other side.
class FarPoints {
 public:
  FarPoints(const mesh::EditableMesh& mesh, const Fidelity& fidelity, double far,
            const parallel::Workers& workers)
      : mesh_(mesh), fidelity_(fidelity), far_(far), workers_(workers) {
    std::vector<Index> triangles, vertices;
    for (Index t = 0; t < mesh.triangle_capacity(); ++t)
      if (mesh.alive_triangle(t)) triangles.push_back(t);
    for (Index v = 0; v < mesh.vertex_capacity(); ++v)
      if (mesh.alive_vertex(v)) vertices.push_back(v);
    add(triangles, vertices);
  }

  [[nodiscard]] const std::vector<FarPoint>& list() const { return points_; }

  /// The points of these triangles and these vertices (sorted) may be others now.
  void renew(const std::vector<Index>& triangles, const std::vector<Index>& vertices) {
    std::erase_if(points_, [&](const FarPoint& p) {
      return p.vertex >= 0 ? std::binary_search(vertices.begin(), vertices.end(), p.vertex)
                           : std::binary_search(triangles.begin(), triangles.end(), p.triangle);
    });
    add(triangles, vertices);
  }

 private:
  void add(const std::vector<Index>& triangles, const std::vector<Index>& vertices) {
    std::vector<std::vector<FarPoint>> found((triangles.size() + kChunk - 1) / kChunk);
    workers_.for_chunks(triangles.size(), kChunk,
                        [&](std::size_t begin, std::size_t end, std::size_t chunk) {
                          for (std::size_t i = begin; i < end; ++i)
                            find(triangles[i], found[chunk]);
                        });
    for (Index v : vertices) {
      if (mesh_.on_boundary(v)) continue;
      const double d = distance(mesh_.positions[v], fidelity_.vertex_planes[v].point);
      if (d >= far_) found.push_back({{d, mesh_.triangle_of(v), -1, -1, v}});
    }
    spatial::TriangleBvh bvh;
    for (const std::vector<FarPoint>& part : found) {
      for (const FarPoint& p : part) {
        if (p.sample >= 0 && bvh.order().empty()) bvh = hierarchy(mesh_, workers_);
        if (credible(p, bvh)) points_.push_back(p);
      }
    }
  }

  void find(Index t, std::vector<FarPoint>& found) const {
    const std::array<Vec3, 3> p = corners(mesh_, t);
    const TriangleFrame frame(p[0], p[1], p[2]);
    for (Index s = fidelity_.first[t]; s >= 0; s = fidelity_.samples[s].next) {
      const double d2 = frame.closest(fidelity_.samples[s].point).squared_distance;
      if (d2 >= far_ * far_) found.push_back({std::sqrt(d2), t, s, -1, -1});
    }
    for (int k = 0; k < 3; ++k) {
      const double d = distance(midpoint(p, k), fidelity_.edge_planes[t][k].point);
      if (d >= far_) found.push_back({d, t, -1, k, -1});
    }
  }

  // Whether a distance to the point's own sheet can be meant: on crumpled surfaces the foot may be
  // lost on a wrong one, far beyond what is nearest at all.
  [[nodiscard]] bool credible(const FarPoint& p, const spatial::TriangleBvh& bvh) const {
    const double limit = 0.25 * p.distance * p.distance;
    if (p.sample >= 0) return bvh.closest(fidelity_.samples[p.sample].point, limit).triangle < 0;
    const Vec3 x =
        p.edge >= 0 ? midpoint(corners(mesh_, p.triangle), p.edge) : mesh_.positions[p.vertex];
    return fidelity_.surface_bvh().closest(x, limit).triangle < 0;
  }

  static constexpr std::size_t kChunk = 512;
  const mesh::EditableMesh& mesh_;
  const Fidelity& fidelity_;
  double far_;
  const parallel::Workers& workers_;
  std::vector<FarPoint> points_;
};

double largest_distance(const std::vector<FarPoint>& points) {
  double largest = 0;
  for (const FarPoint& p : points) largest = std::max(largest, p.distance);
  return largest;
}

}  // namespace

void polish_distance(mesh::EditableMesh& mesh, Fidelity& fidelity, const TrialOptions& options,
                     const parallel::Workers& workers,
                     const std::function<bool(double)>& keep_going) {
  const AngleTest goal(options.goal);
  const double rms = std::sqrt(fidelity.mean_square(mesh));
  fidelity.emphasize_far_vertices(mesh, kFarFactor * rms, kNewWeight, 1, workers);
  const std::size_t outside = triangles_outside(mesh, goal).size();
  FarPoints points(mesh, fidelity, kFarFactor * rms, workers);
  if (points.list().empty()) return;
  double largest = largest_distance(points.list()), least = largest;
  mesh::EditableMesh best_mesh = mesh;
  Fidelity best_fidelity = fidelity;
  for (int round = 0, idle = 0; round < kRounds && idle < kPatience && !points.list().empty();
       ++round) {
    if (!keep_going(static_cast<double>(round) / kRounds)) break;
    std::vector<Index> places;
    for (const FarPoint& p : points.list()) {
      if (p.distance < kNearLargest * largest) continue;
      p.factor(fidelity) *= kGrowth;
      places.push_back(p.triangle);
    }
    std::vector<Index> active = dilated(mesh, places, 2);
    fidelity.knots.add_copies(mesh, active);
    const std::vector<Index> touched = triangles_around(mesh, active);
    std::vector<Index> changed = touched;
    for (int i = 0; i < 2; ++i) {
      relax(mesh, fidelity, active, {options.shape, 3, options.on_surface}, workers);
      const std::vector<Index> receivers = fidelity.rewalk(mesh, touched);
      changed.insert(changed.end(), receivers.begin(), receivers.end());
    }
    sort_unique(changed);
    fidelity.emphasize_far_vertices(mesh, std::max(least, kFarFactor * rms), kNewWeight, 1, workers,
                                    &changed);
    points.renew(changed, active);
    largest = largest_distance(points.list());
    if (largest >= least || triangles_outside(mesh, goal).size() > outside) {
      ++idle;
      continue;
    }
    idle = 0;
    least = largest;
    best_mesh = mesh;
    best_fidelity = fidelity;
  }
  mesh = std::move(best_mesh);
  fidelity = std::move(best_fidelity);
}

}  // namespace nonobtuse::refine
