#include "refine/surface_patches.h"

#include <limits>
#include <map>

#include "refine/fidelity.h"

namespace nonobtuse::refine {
namespace {

// Labels 0, 1, ... of the components of `count` triangles, by lowest index; -1 where not alive.
template <class Alive, class Adjacent>
std::vector<Index> components(Index count, const Alive& alive, const Adjacent& adjacent) {
  std::vector<Index> label(count, -1), stack;
  Index next_label = 0;
  for (Index first = 0; first < count; ++first) {
    if (label[first] >= 0 || !alive(first)) continue;
    label[first] = next_label;
    stack.push_back(first);
    while (!stack.empty()) {
      const Index t = stack.back();
      stack.pop_back();
      for (int k = 0; k < 3; ++k) {
        const Index u = adjacent(t, k);
        if (u < 0 || label[u] >= 0) continue;
        label[u] = next_label;
        stack.push_back(u);
      }
    }
    ++next_label;
  }
  return label;
}

}  // namespace

std::vector<Index> surface_patches(const mesh::Surface& surface) {
  return components(
      static_cast<Index>(surface.triangles.size()), [](Index) { return true; },
      [&](Index f, int k) { return surface.adjacent[f][k]; });
}

std::vector<Index> mesh_patches(const mesh::EditableMesh& mesh, const mesh::Surface& surface,
                                const spatial::TriangleBvh& surface_bvh,
                                const std::vector<Index>& of_facet,
                                const parallel::Workers& workers) {
  const std::vector<Index> part = components(
      mesh.triangle_capacity(), [&](Index t) { return mesh.alive_triangle(t); },
      [&](Index t, int k) { return mesh.adjacent(t, k); });
  // Centroids vote with the area of their triangles.
  std::vector<Index> nearest(part.size(), -1);
  workers.for_each(part.size(), 512, [&](std::size_t i) {
    const Index t = static_cast<Index>(i);
    if (part[t] < 0) return;
    const std::array<Vec3, 3> p = corners(mesh, t);
    const Vec3 normal = area_vector(p);
    const auto agrees = [&](Index f) { return dot(surface.normals[f], normal) > 0; };
    const auto hit = surface_bvh.closest_if((p[0] + p[1] + p[2]) / 3.0,
                                            std::numeric_limits<double>::infinity(), agrees);
    if (hit.triangle >= 0) nearest[t] = of_facet[hit.triangle];
  });
  std::vector<std::map<Index, double>> votes;
  for (Index t = 0; t < static_cast<Index>(part.size()); ++t) {
    if (part[t] < 0) continue;
    if (part[t] >= static_cast<Index>(votes.size())) votes.resize(part[t] + 1);
    if (nearest[t] >= 0) votes[part[t]][nearest[t]] += length(area_vector(corners(mesh, t)));
  }
  std::vector<Index> of_vertex(mesh.vertex_capacity(), -1);
  std::vector<Index> winner(votes.size(), -1);
  for (std::size_t c = 0; c < votes.size(); ++c) {
    double most = -1;
    for (const auto& [patch, area] : votes[c])
      if (area > most) most = area, winner[c] = patch;
  }
  for (Index t = 0; t < static_cast<Index>(part.size()); ++t)
    if (part[t] >= 0)
      for (const Index v : mesh.triangle(t)) of_vertex[v] = winner[part[t]];
  return of_vertex;
}

}  // namespace nonobtuse::refine
