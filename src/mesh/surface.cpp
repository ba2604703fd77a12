#include "mesh/surface.h"

#include <algorithm>
#include <cstddef>
#include <utility>

namespace nonobtuse::mesh {

std::vector<std::array<Index, 3>> triangle_adjacency(const std::vector<Triangle>& triangles,
                                                     Index vertex_count) {
  // Half-edges bucketed by their smaller vertex: independent of hashing.
  const Index count = vertex_count;
  std::vector<std::size_t> start(count + 1, 0);
  const auto lower = [](const Triangle& t, int k) { return std::min(t[next(k)], t[previous(k)]); };
  for (const Triangle& t : triangles)
    for (int k = 0; k < 3; ++k) ++start[lower(t, k) + 1];
  for (Index v = 0; v < count; ++v) start[v + 1] += start[v];
  std::vector<std::pair<Index, int>> half_edges(start[count]);
  std::vector<std::size_t> fill(start.begin(), start.end() - 1);
  for (std::size_t t = 0; t < triangles.size(); ++t)
    for (int k = 0; k < 3; ++k)
      half_edges[fill[lower(triangles[t], k)]++] = {static_cast<Index>(t), k};

  std::vector<std::array<Index, 3>> adjacent(triangles.size(), {-1, -1, -1});
  const auto upper = [&](const std::pair<Index, int>& half_edge) {
    const Triangle& t = triangles[half_edge.first];
    return std::max(t[next(half_edge.second)], t[previous(half_edge.second)]);
  };
  const auto join = [&](const std::pair<Index, int>& one, const std::pair<Index, int>& other) {
    const auto [t, k] = one;
    const auto [u, l] = other;
    if (triangles[t][next(k)] != triangles[u][previous(l)]) return;  // the same way round
    adjacent[t][k] = u;
    adjacent[u][l] = t;
  };
  // Half-edges are joined where exactly two of a bucket have the same upper vertex.
  constexpr std::size_t kFew = 16;
  for (Index v = 0; v < count; ++v) {
    const std::size_t begin = start[v];
    const std::size_t size = start[v + 1] - begin;
    if (size <= kFew) {
      std::array<Index, kFew> to{};
      for (std::size_t i = 0; i < size; ++i) to[i] = upper(half_edges[begin + i]);
      for (std::size_t i = 0; i < size; ++i) {
        std::size_t same = 0, other = i;
        for (std::size_t j = 0; j < size; ++j)
          if (to[j] == to[i] && j != i) ++same, other = j;
        if (same == 1 && other > i) join(half_edges[begin + i], half_edges[begin + other]);
      }
      continue;
    }
    // Half-edges of one edge side by side, so that a vertex of any valence costs n log n.
    std::sort(half_edges.begin() + static_cast<std::ptrdiff_t>(begin),
              half_edges.begin() + static_cast<std::ptrdiff_t>(begin + size),
              [&](const auto& a, const auto& b) {
                return std::pair(upper(a), a) < std::pair(upper(b), b);
              });
    std::size_t end = begin;
    for (std::size_t i = begin; i < begin + size; i = end) {
      while (end < begin + size && upper(half_edges[end]) == upper(half_edges[i])) ++end;
      if (end - i == 2) join(half_edges[i], half_edges[i + 1]);
    }
  }
  return adjacent;
}

Surface make_surface(std::vector<Vec3> vertices, std::vector<Triangle> triangles) {
  Surface s;
  s.vertices = std::move(vertices);
  s.triangles = std::move(triangles);
  s.adjacent = triangle_adjacency(s.triangles, static_cast<Index>(s.vertices.size()));
  s.areas.reserve(s.triangles.size());
  s.normals.reserve(s.triangles.size());
  for (const Triangle& t : s.triangles) {
    const Vec3 a = area_vector(s.vertices[t[0]], s.vertices[t[1]], s.vertices[t[2]]);
    const double twice = length(a);
    s.areas.push_back(0.5 * twice);
    s.normals.push_back(twice > 0 ? a / twice : Vec3{});
    s.area += 0.5 * twice;
  }
  return s;
}

}  // namespace nonobtuse::mesh
