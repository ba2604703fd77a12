// Least number of vertices of a closed surface of Euler characteristic x: (7 + sqrt(49 - 24 x)) / 2
// (Heawood 1890; Jungerman, Ringel 1980).
#include "remesh/parts.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "features/crease_detection.h"
#include "mesh/cut.h"
#include "mesh/surface.h"
#include "mesh/topology.h"
#include "remesh/initial_sampling.h"
#include "remesh/normalization.h"
#include "sizing/density.h"

namespace nonobtuse::pipeline {

namespace {

Index least_vertices(Index euler, bool open) {
  if (open) return euler == 1 ? 3 : 4;
  return static_cast<Index>(std::ceil((7 + std::sqrt(49.0 - 24.0 * euler)) / 2));
}

// The part of each component: those that share a vertex are one, numbered in order.
std::vector<Index> joined(const TriangleMesh& mesh, const Components& components) {
  std::vector<Index> lowest(components.count());  // union-find, roots are the lowest
  std::iota(lowest.begin(), lowest.end(), Index{0});
  const auto root = [&](Index c) {
    while (lowest[c] != c) c = lowest[c] = lowest[lowest[c]];
    return c;
  };
  std::vector<Index> at(mesh.vertices.size(), -1);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (const Index v : mesh.triangles[t]) {
      const Index c = root(components.of_triangle[t]);
      if (at[v] < 0) at[v] = c;
      const Index other = root(at[v]);
      lowest[std::max(c, other)] = std::min(c, other);
    }
  std::vector<Index> part(components.count());
  Index count = 0;
  for (Index c = 0; c < components.count(); ++c) part[c] = root(c) == c ? count++ : part[root(c)];
  return part;
}

// Vertices in which several fans of triangles touch, not only along edges of three or more.
std::vector<Index> touching_points(const TriangleMesh& mesh) {
  const auto count = static_cast<Index>(mesh.vertices.size());
  const auto sides = mesh::edge_sides(mesh.triangles, count);
  const mesh::Cut cut = mesh::cut_to_manifold(mesh.triangles, count, sides);
  if (cut.original.size() == mesh.vertices.size()) return {};
  std::vector<char> crowded(cut.original.size(), 0);  // fans that such an edge bounds
  mesh::for_each_edge(sides, [&](const mesh::EdgeSide* first, const mesh::EdgeSide* last) {
    if (last - first <= 2) return;
    for (const mesh::EdgeSide* s = first; s != last; ++s) {
      const Triangle& t = cut.triangles[s->triangle];
      crowded[t[mesh::next(s->corner)]] = crowded[t[mesh::previous(s->corner)]] = 1;
    }
  });
  std::vector<Index> fans(count, 0);
  std::vector<char> apart(count, 0);
  for (std::size_t v = 0; v < cut.original.size(); ++v) {
    ++fans[cut.original[v]];
    if (crowded[v] == 0) apart[cut.original[v]] = 1;
  }
  std::vector<Index> points;
  for (Index v = 0; v < count; ++v)
    if (fans[v] > 1 && apart[v] != 0) points.push_back(v);
  return points;
}

}  // namespace

std::vector<Part> connected_parts(const TriangleMesh& mesh, std::span<const double> length) {
  // Areas and Euler characteristics in coordinates that can neither over- nor underflow.
  const NormalizedInput whole = normalize(mesh, 1);
  const Components components = connected_components(whole.surface);
  const std::vector<Index> part_of = joined(mesh, components);
  std::vector<Part> parts(1 + *std::max_element(part_of.begin(), part_of.end()));
  for (Part& part : parts) part.least = 0;
  for (Index c = 0; c < components.count(); ++c) {
    Part& part = parts[part_of[c]];
    part.area += components.area[c];
    part.least += least_vertices(components.euler[c], components.boundary_length[c] > 0);
  }
  for (Index t = 0; t < static_cast<Index>(mesh.triangles.size()); ++t)
    parts[part_of[components.of_triangle[t]]].facet.push_back(t);
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
    for (const Index v : mesh.triangles[t]) owner[v] = part_of[components.of_triangle[t]];
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
    part.points = touching_points(part.mesh);
    if (features::any_feature(flags) || !part.points.empty()) part.features = std::move(flags);
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
