#include "refine/surface_patches.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>

#include "refine/fidelity.h"

namespace nonobtuse::refine {
namespace {

constexpr double kLeastFlatWidth = 3;  // where an edge is about 1 long
constexpr double kFlatness = 1e-5;     // relative to distance, where an edge is about 1 long

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

std::vector<char> flat_facets(const mesh::Surface& surface) {
  const auto count = static_cast<Index>(surface.triangles.size());
  std::vector<Index> order(count);
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](Index f, Index g) { return surface.areas[f] > surface.areas[g]; });
  std::vector<char> flat(count, 0);
  std::vector<char> seen(count, 0);
  std::vector<Index> region;
  for (const Index base : order) {  // largest facets first: normals of needles mean nothing
    if (seen[base] != 0) continue;
    const Vec3& normal = surface.normals[base];
    const Vec3& origin = surface.vertices[surface.triangles[base][0]];
    const auto in_plane = [&](Index f) {
      for (const Index v : surface.triangles[f]) {
        const Vec3 d = surface.vertices[v] - origin;
        if (std::abs(dot(normal, d)) > kFlatness * (1 + length(d))) return false;
      }
      return dot(surface.normals[f], normal) > 0;
    };
    double area = 0;
    double perimeter = 0;
    bool whole_patch = true;
    region.assign(1, base);
    seen[base] = 1;
    for (std::size_t i = 0; i < region.size(); ++i) {
      const Index f = region[i];
      area += surface.areas[f];
      for (int k = 0; k < 3; ++k) {
        const Index g = surface.adjacent[f][k];
        if (g >= 0 && seen[g] == 0 && in_plane(g)) {
          seen[g] = 1;
          region.push_back(g);
        } else if (g < 0 || !in_plane(g)) {
          const Triangle& t = surface.triangles[f];
          perimeter +=
              distance(surface.vertices[t[mesh::next(k)]], surface.vertices[t[mesh::previous(k)]]);
        }
      }
    }
    if (!whole_patch && area < kLeastFlatWidth / 2 * perimeter) continue;
    for (const Index f : region) flat[f] = 1;
  }
  return flat;
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
