// Least number of vertices of a closed surface of Euler characteristic x: (7 + sqrt(49 - 24 x)) / 2
// (Heawood 1890; Jungerman, Ringel 1980).
#include "remesh/parts.h"

#include <cmath>

#include "mesh/surface.h"
#include "remesh/initial_sampling.h"
#include "remesh/normalization.h"

namespace nonobtuse::pipeline {

namespace {

Index least_vertices(Index euler, bool open) {
  if (open) return euler == 1 ? 3 : 4;
  return static_cast<Index>(std::ceil((7 + std::sqrt(49.0 - 24.0 * euler)) / 2));
}

// Areas and Euler characteristics in coordinates that can neither over- nor underflow.
Components components_of(const TriangleMesh& mesh) {
  return connected_components(normalize(mesh, 1).surface);
}

}  // namespace

std::vector<Part> connected_parts(const TriangleMesh& mesh) {
  const Components components = components_of(mesh);
  std::vector<Part> parts(components.count());
  for (Index c = 0; c < components.count(); ++c) {
    parts[c].area = components.area[c];
    parts[c].least = least_vertices(components.euler[c], components.boundary_length[c] > 0);
  }
  for (Index t = 0; t < static_cast<Index>(mesh.triangles.size()); ++t)
    parts[components.of_triangle[t]].facet.push_back(t);
  if (parts.size() == 1) {
    parts.front().mesh = mesh;
    return parts;
  }
  std::vector<Index> owner(mesh.vertices.size(), -1);
  std::vector<Index> number(mesh.vertices.size(), -1);
  for (Index t = 0; t < static_cast<Index>(mesh.triangles.size()); ++t)
    for (const Index v : mesh.triangles[t]) owner[v] = components.of_triangle[t];
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    std::vector<Vec3>& vertices = parts[owner[v]].mesh.vertices;
    number[v] = static_cast<Index>(vertices.size());
    vertices.push_back(mesh.vertices[v]);
  }
  for (Part& part : parts) {
    for (const Index t : part.facet) {
      const Triangle& v = mesh.triangles[t];
      part.mesh.triangles.push_back({number[v[0]], number[v[1]], number[v[2]]});
    }
  }
  return parts;
}

Index least_vertices(const std::vector<Part>& parts) {
  Index sum = 0;
  for (const Part& part : parts) sum += part.least;
  return sum;
}

std::vector<Index> share_vertices(const std::vector<Part>& parts, Index n) {
  Components components;
  std::vector<Index> least;
  for (const Part& part : parts) {
    components.area.push_back(part.area);
    least.push_back(part.least);
  }
  return share_sites(components, n, least);
}

}  // namespace nonobtuse::pipeline
