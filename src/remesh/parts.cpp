// Least number of vertices of a closed surface of Euler characteristic x: (7 + sqrt(49 - 24 x)) / 2
// (Heawood 1890; Jungerman, Ringel 1980).
#include "remesh/parts.h"

#include <cmath>
#include <utility>

#include "features/crease_detection.h"
#include "mesh/surface.h"
#include "remesh/initial_sampling.h"
#include "remesh/normalization.h"
#include "sizing/density.h"

namespace nonobtuse::pipeline {

namespace {

Index least_vertices(Index euler, bool open) {
  if (open) return euler == 1 ? 3 : 4;
  return static_cast<Index>(std::ceil((7 + std::sqrt(49.0 - 24.0 * euler)) / 2));
}

}  // namespace

std::vector<Part> connected_parts(const TriangleMesh& mesh, std::span<const double> length) {
  // Areas and Euler characteristics in coordinates that can neither over- nor underflow.
  const NormalizedInput whole = normalize(mesh, 1);
  const Components components = connected_components(whole.surface);
  std::vector<Part> parts(components.count());
  for (Index c = 0; c < components.count(); ++c) {
    parts[c].area = components.area[c];
    parts[c].least = least_vertices(components.euler[c], components.boundary_length[c] > 0);
  }
  for (Index t = 0; t < static_cast<Index>(mesh.triangles.size()); ++t)
    parts[components.of_triangle[t]].facet.push_back(t);
  if (!length.empty())
    for (Part& part : parts) part.area = sizing::vertices_for(whole.surface, length, part.facet);
  if (parts.size() == 1) {
    parts.front().mesh = mesh;
    parts.front().length.assign(length.begin(), length.end());
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
    if (!length.empty()) parts[owner[v]].length.push_back(length[v]);
  }
  for (Part& part : parts) {
    for (const Index t : part.facet) {
      const Triangle& v = mesh.triangles[t];
      part.mesh.triangles.push_back({number[v[0]], number[v[1]], number[v[2]]});
    }
  }
  return parts;
}

void find_features(const TriangleMesh& mesh, const RemeshOptions& options,
                   std::vector<Part>& parts) {
  if (options.method != Method::Default) return;
  features::EdgeFlags given(mesh.triangles.size(), 0);
  if (options.features != Features::None)
    features::flag_edges(mesh.triangles, static_cast<Index>(mesh.vertices.size()),
                         options.feature_edges, given);
  for (Part& part : parts) {
    features::EdgeFlags flags;
    for (const Index f : part.facet) flags.push_back(given[f]);
    features::flag_boundaries(part.mesh.triangles, static_cast<Index>(part.mesh.vertices.size()),
                              flags);
    if (options.features == Features::Auto || options.features == Features::Dihedral) {
      const mesh::Surface surface = normalize(part.mesh, 1).surface;
      if (options.features == Features::Auto)
        features::detect_creases(surface, flags);
      else
        features::flag_dihedral_angles(surface, options.feature_angle, flags);
    }
    if (features::any_feature(flags)) part.features = std::move(flags);
  }
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
