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

struct FarPoint {
  double distance;
  Index triangle;
  double* factor;  // what scales the point's weight
};

double sample_distance(const mesh::EditableMesh& mesh, Index t, const Sample& sample) {
  const std::array<Vec3, 3> p = corners(mesh, t);
  return std::sqrt(TriangleFrame(p[0], p[1], p[2]).closest(sample.point).squared_distance);
}

spatial::TriangleBvh hierarchy(const mesh::EditableMesh& mesh, const parallel::Workers& workers) {
  std::vector<Triangle> triangles;
  for (const Triangle& t : mesh.triangles())
    if (t[0] >= 0) triangles.push_back(t);
  return {mesh.positions, triangles, workers};
}

// Whether a distance to the point's own sheet can be meant: on crumpled surfaces the foot may be
// lost on a wrong one, far beyond what is nearest at all.
bool credible(double own, double squared_nearest) { return squared_nearest >= 0.25 * own * own; }

// Points of both sides at least `far` from the other side.
std::vector<FarPoint> far_points(const mesh::EditableMesh& mesh, Fidelity& fidelity, double far,
                                 const parallel::Workers& workers) {
  std::vector<FarPoint> points;
  const auto add_plane = [&](TangentPlane& plane, const Vec3& p, Index t) {
    const double d = distance(p, plane.point);
    if (d < far) return;
    if (credible(d, fidelity.surface_bvh().closest(p).squared_distance))
      points.push_back({d, t, &plane.emphasis});
  };
  spatial::TriangleBvh bvh;
  bool built = false;
  for (Index t = 0; t < mesh.triangle_capacity(); ++t) {
    if (!mesh.alive_triangle(t)) continue;
    for (Index s = fidelity.first[t]; s >= 0; s = fidelity.samples[s].next) {
      Sample& sample = fidelity.samples[s];
      const double d = sample_distance(mesh, t, sample);
      if (d < far) continue;
      if (!built) bvh = hierarchy(mesh, workers), built = true;
      if (credible(d, bvh.closest(sample.point).squared_distance))
        points.push_back({d, t, &sample.weight});
    }
    const std::array<Vec3, 3> p = corners(mesh, t);
    for (int k = 0; k < 3; ++k) add_plane(fidelity.edge_planes[t][k], midpoint(p, k), t);
  }
  for (Index v = 0; v < mesh.vertex_capacity(); ++v)
    if (mesh.alive_vertex(v) && !mesh.on_boundary(v))
      add_plane(fidelity.vertex_planes[v], mesh.positions[v], mesh.triangle_of(v));
  return points;
}

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
  std::vector<FarPoint> points = far_points(mesh, fidelity, kFarFactor * rms, workers);
  double largest = largest_distance(points), least = largest;
  mesh::EditableMesh best_mesh = mesh;
  Fidelity best_fidelity = fidelity;
  for (int round = 0, idle = 0; round < kRounds && idle < kPatience && !points.empty(); ++round) {
    if (!keep_going(static_cast<double>(round) / kRounds)) break;
    std::vector<Index> places;
    for (const FarPoint& p : points) {
      if (p.distance < kNearLargest * largest) continue;
      *p.factor *= kGrowth;
      places.push_back(p.triangle);
    }
    std::vector<Index> active = dilated(mesh, places, 2);
    fidelity.knots.add_copies(mesh, active);
    const std::vector<Index> touched = triangles_around(mesh, active);
    for (int i = 0; i < 2; ++i) {
      relax(mesh, fidelity, active, {options.shape, 3, options.on_surface}, workers);
      fidelity.rewalk(mesh, touched);
    }
    fidelity.emphasize_far_vertices(mesh, std::max(least, kFarFactor * rms), kNewWeight, 1,
                                    workers);
    points = far_points(mesh, fidelity, kFarFactor * rms, workers);
    largest = largest_distance(points);
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
