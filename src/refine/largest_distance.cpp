#include "refine/largest_distance.h"

#include <algorithm>
#include <cmath>

#include "refine/neighborhood.h"

namespace nonobtuse::refine {
namespace {

TriangleFrame frame_of(const std::array<Vec3, 3>& p) { return {p[0], p[1], p[2]}; }

constexpr int kBisections = 2;  // of half edges
constexpr double kHasty = 0.7;  // edges with both ends nearer than this part are skipped in haste

// A point of T whose distance from its own foot on M is known.
struct Known {
  Vec3 point;
  double distance;
  Index facet;
};

// The points of a triangle of T that may be farther than `far` from their own feet on M: corners,
// points of the edges by bisection, as the distance grows no faster than one walks, and the
// centroid. Every edge is seen from the side of lower index. visit(point, distance, plane that
// pulls it: of edge k, or 3 + k for corner k) gives what counts as far from then on.
template <class Visit>
class PointSearch {
 public:
  PointSearch(const mesh::EditableMesh& mesh, const Fidelity& fidelity, double far,
              const Visit& visit, bool hasty)
      : mesh_(mesh), fidelity_(fidelity), far_(far), visit_(visit), hasty_(hasty) {}

  double search(Index t) {
    const std::array<Vec3, 3> p = corners(mesh_, t);
    std::array<Known, 3> ends;
    for (int k = 0; k < 3; ++k) {
      const TangentPlane& plane = fidelity_.vertex_planes[mesh_.triangle(t)[k]];
      if (plane.facet < 0 || fidelity_.edge_planes[t][k].facet < 0) return far_;
      ends[k] = {p[k], distance(p[k], plane.point), plane.facet};
      look(ends[k], 3 + k);
    }
    for (int k = 0; k < 3; ++k) {
      if (mesh_.adjacent(t, k) < t) continue;
      const TangentPlane& plane = fidelity_.edge_planes[t][k];
      const Vec3 m = midpoint(p, k);
      const Known middle{m, distance(m, plane.point), plane.facet};
      look(middle, k);
      bisect(ends[mesh::next(k)], middle, k, kBisections);
      bisect(middle, ends[mesh::previous(k)], k, kBisections);
    }
    const Vec3 center = (1.0 / 3) * (p[0] + p[1] + p[2]);
    look(known(center, fidelity_.edge_planes[t][0].facet), 0);
    return far_;
  }

 private:
  [[nodiscard]] Known known(const Vec3& p, Index facet) const {
    const TangentPlane foot = fidelity_.walk_foot(p, facet);
    return {p, distance(p, foot.point), foot.facet};
  }
  void look(const Known& at, int plane) {
    if (at.distance > far_) far_ = visit_(at.point, at.distance, plane);
  }
  void bisect(const Known& a, const Known& b, int plane, int depth) {
    if (depth == 0) return;
    if (hasty_ && std::max(a.distance, b.distance) < kHasty * far_) return;
    if (0.5 * (a.distance + b.distance + distance(a.point, b.point)) <= far_) return;
    const Known middle = known(0.5 * (a.point + b.point), a.facet);
    look(middle, plane);
    bisect(a, middle, plane, depth - 1);
    bisect(middle, b, plane, depth - 1);
  }

  const mesh::EditableMesh& mesh_;
  const Fidelity& fidelity_;
  double far_;
  const Visit& visit_;
  bool hasty_;
};

template <class Visit>
double search_points(const mesh::EditableMesh& mesh, const Fidelity& fidelity, Index t, double far,
                     const Visit& visit, bool hasty = false) {
  return PointSearch<Visit>(mesh, fidelity, far, visit, hasty).search(t);
}

// Largest distance of the points of triangle t, if beyond `far`; nearest(p, squared) gives the
// squared distance of a point from what is nearest of the mesh, if less than `squared`.
template <class Nearest>
double triangle_distance(const mesh::EditableMesh& mesh, const Fidelity& fidelity, Index t,
                         double far, const Nearest& nearest) {
  double largest = far;
  const TriangleFrame frame = frame_of(corners(mesh, t));
  for (Index s = fidelity.first[t]; s >= 0; s = fidelity.samples[s].next) {
    const Vec3 y = fidelity.samples[s].point;
    const double squared = frame.closest(y).squared_distance;
    if (squared > largest * largest) largest = std::max(largest, std::sqrt(nearest(y, squared)));
  }
  return search_points(mesh, fidelity, t, largest, [&](const Vec3& p, double own, int) {
    const double squared = fidelity.surface_bvh().closest(p, own * own).squared_distance;
    return largest = std::max(largest, std::sqrt(squared));
  });
}

double nearest_of(const mesh::EditableMesh& mesh, const std::vector<Index>& triangles,
                  const Vec3& p, double squared) {
  for (Index t : triangles)
    if (mesh.alive_triangle(t))
      squared = std::min(squared, frame_of(corners(mesh, t)).closest(p).squared_distance);
  return squared;
}

std::vector<Index> all_triangles(const mesh::EditableMesh& mesh) {
  std::vector<Index> triangles;
  for (Index t = 0; t < mesh.triangle_capacity(); ++t)
    if (mesh.alive_triangle(t)) triangles.push_back(t);
  return triangles;
}

}  // namespace

double& weight(Fidelity& f, std::size_t number) {
  if (number < f.samples.size()) return f.samples[number].weight;
  number -= f.samples.size();
  if (number < f.vertex_planes.size()) return f.vertex_planes[number].emphasis;
  number -= f.vertex_planes.size();
  return f.edge_planes[number / 3][number % 3].emphasis;
}

std::vector<FarWeight> far_weights(const mesh::EditableMesh& patch, const Fidelity& fidelity,
                                   double far) {
  std::vector<FarWeight> found;
  const std::vector<Index> triangles = all_triangles(patch);
  const std::size_t vertex_weights = fidelity.samples.size();
  const std::size_t edge_weights = vertex_weights + fidelity.vertex_planes.size();
  for (Index t : triangles) {
    const TriangleFrame frame = frame_of(corners(patch, t));
    for (Index s = fidelity.first[t]; s >= 0; s = fidelity.samples[s].next) {
      const Vec3& y = fidelity.samples[s].point;
      double squared = frame.closest(y).squared_distance;
      if (squared <= far * far) continue;
      squared = nearest_of(patch, triangles, y, squared);
      if (squared > far * far) found.push_back({std::sqrt(squared), static_cast<std::size_t>(s)});
    }
    const auto visit = [&](const Vec3& p, double own, int plane) {
      const double squared = fidelity.surface_bvh().closest(p, own * own).squared_distance;
      const auto k = static_cast<std::size_t>(plane % 3);
      if (squared > far * far)
        found.push_back({std::sqrt(squared),
                         plane < 3
                             ? edge_weights + 3 * static_cast<std::size_t>(t) + k
                             : vertex_weights + static_cast<std::size_t>(patch.triangle(t)[k])});
      return far;
    };
    search_points(patch, fidelity, t, far, visit, true);
  }
  return found;
}

double largest_distance(const mesh::EditableMesh& patch, const Fidelity& fidelity, double far) {
  const std::vector<Index> triangles = all_triangles(patch);
  for (Index t : triangles)
    far = triangle_distance(patch, fidelity, t, far, [&](const Vec3& p, double squared) {
      return nearest_of(patch, triangles, p, squared);
    });
  return far;
}

FarPoints::FarPoints(const mesh::EditableMesh& mesh, const Fidelity& fidelity, double far,
                     const parallel::Workers& workers)
    : mesh_(&mesh),
      fidelity_(&fidelity),
      far_(far),
      triangle_(all_triangles(mesh)),
      is_changed_(mesh.triangle_capacity(), 0) {
  std::vector<Triangle> corners_of;
  for (Index t : triangle_) corners_of.push_back(mesh.triangle(t));
  bvh_ = spatial::TriangleBvh(mesh.positions, corners_of, workers);
  std::vector<double> largest(triangle_.size());
  workers.for_each(triangle_.size(), 256, [&](std::size_t i) {
    largest[i] = triangle_distance(
        mesh, fidelity, triangle_[i], far,
        [&](const Vec3& p, double squared) { return bvh_.closest(p, squared).squared_distance; });
  });
  for (std::size_t i = 0; i < triangle_.size(); ++i)
    if (largest[i] > far) list_.push_back({largest[i], triangle_[i]});
  sort();
}

double FarPoints::squared_distance(const Vec3& p, double limit) const {
  const auto unchanged = [&](Index i) {
    return !is_changed_[triangle_[i]] && mesh_->alive_triangle(triangle_[i]);
  };
  limit = bvh_.closest_if(p, limit, unchanged).squared_distance;
  return nearest_of(*mesh_, changed_, p, limit);
}

void FarPoints::update(const std::vector<Index>& changed, const std::vector<Index>& around,
                       const parallel::Workers& workers) {
  is_changed_.resize(mesh_->triangle_capacity(), 1);
  for (Index t : changed) {
    is_changed_[t] = 1;
    changed_.push_back(t);
  }
  sort_unique(changed_);
  std::erase_if(list_, [&](const FarPoint& p) {
    return !mesh_->alive_triangle(p.triangle) ||
           std::binary_search(around.begin(), around.end(), p.triangle);
  });
  std::vector<double> largest(around.size(), far_);
  workers.for_each(around.size(), 8, [&](std::size_t i) {
    if (mesh_->alive_triangle(around[i]))
      largest[i] = triangle_distance(
          *mesh_, *fidelity_, around[i], far_,
          [&](const Vec3& p, double squared) { return squared_distance(p, squared); });
  });
  for (std::size_t i = 0; i < around.size(); ++i)
    if (largest[i] > far_) list_.push_back({largest[i], around[i]});
  sort();
}

void FarPoints::sort() {
  std::sort(list_.begin(), list_.end(), [](const FarPoint& a, const FarPoint& b) {
    return a.distance != b.distance ? a.distance > b.distance : a.triangle < b.triangle;
  });
}

}  // namespace nonobtuse::refine
