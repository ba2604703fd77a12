#include "refine/distance_polish.h"

#include <algorithm>
#include <cmath>

#include "refine/neighborhood.h"
#include "refine/relaxation.h"

namespace nonobtuse::refine {
namespace {

constexpr int kRounds = 6;
constexpr double kGrowth = 2;         // of the weights of the farthest points
constexpr double kNearLargest = 0.7;  // points at this part of the largest distance count as far
constexpr double kFarFactor = 5;      // in root mean square distances
constexpr double kNewWeight = 0.2;    // of vertices of M that become samples

double sample_distance(const mesh::EditableMesh& mesh, Index t, const Sample& sample) {
  const std::array<Vec3, 3> p = corners(mesh, t);
  return std::sqrt(TriangleFrame(p[0], p[1], p[2]).closest(sample.point).squared_distance);
}

// Calls visit(distance, triangle, factor) for every point measured; `factor` is what scales the
// point's weight.
template <class Visit>
void for_points(const mesh::EditableMesh& mesh, Fidelity& fidelity, const Visit& visit) {
  for (Index t = 0; t < mesh.triangle_capacity(); ++t) {
    if (!mesh.alive_triangle(t)) continue;
    for (Index s = fidelity.first[t]; s >= 0; s = fidelity.samples[s].next)
      visit(sample_distance(mesh, t, fidelity.samples[s]), t, fidelity.samples[s].weight);
    const std::array<Vec3, 3> p = corners(mesh, t);
    TangentPlane& plane = fidelity.centroid_planes[t];
    visit(distance((p[0] + p[1] + p[2]) / 3, plane.point), t, plane.emphasis);
  }
  for (Index v = 0; v < mesh.vertex_capacity(); ++v)
    if (mesh.alive_vertex(v) && !mesh.on_boundary(v))
      visit(distance(mesh.positions[v], fidelity.vertex_planes[v].point), mesh.triangle_of(v),
            fidelity.vertex_planes[v].emphasis);
}

}  // namespace

double largest_distance(const mesh::EditableMesh& mesh, const Fidelity& fidelity) {
  double largest = 0;
  for_points(mesh, const_cast<Fidelity&>(fidelity),
             [&](double d, Index, double&) { largest = std::max(largest, d); });
  return largest;
}

void polish_distance(mesh::EditableMesh& mesh, Fidelity& fidelity, const TrialOptions& options,
                     const parallel::Workers& workers,
                     const std::function<bool(double)>& keep_going) {
  const AngleTest goal(options.goal);
  const double rms = std::sqrt(fidelity.mean_square(mesh));
  fidelity.emphasize_far_vertices(mesh, kFarFactor * rms, kNewWeight, 1, workers);
  const std::size_t outside = triangles_outside(mesh, goal).size();
  double least = largest_distance(mesh, fidelity);
  mesh::EditableMesh best_mesh = mesh;
  Fidelity best_fidelity = fidelity;
  for (int round = 0; round < kRounds; ++round) {
    if (!keep_going(static_cast<double>(round) / kRounds)) break;
    const double far = std::max(kNearLargest * largest_distance(mesh, fidelity), kFarFactor * rms);
    std::vector<Index> places;
    for_points(mesh, fidelity, [&](double d, Index t, double& factor) {
      if (d < far) return;
      factor *= kGrowth;
      places.push_back(t);
    });
    if (places.empty()) break;
    const std::vector<Index> active = dilated(mesh, places, 2);
    const std::vector<Index> touched = triangles_around(mesh, active);
    for (int i = 0; i < 2; ++i) {
      relax(mesh, fidelity, active, {options.shape, 3, options.on_surface}, workers);
      fidelity.rewalk(mesh, touched);
    }
    const double largest = largest_distance(mesh, fidelity);
    if (largest >= least || triangles_outside(mesh, goal).size() > outside) continue;
    least = largest;
    best_mesh = mesh;
    best_fidelity = fidelity;
  }
  mesh = std::move(best_mesh);
  fidelity = std::move(best_fidelity);
}

}  // namespace nonobtuse::refine
