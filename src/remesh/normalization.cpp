#include "remesh/normalization.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "nonobtuse/error.h"
#include "numeric/vec3.h"

namespace nonobtuse::pipeline {

namespace {

// Below, coordinates lose bits to underflow.
constexpr double kLeastExtent = 1e-304;

// Centre of the bounding box and the power of two that brings its extent into [1/2, 1).
mesh::Normalization unit_box(const std::vector<Vec3>& vertices) {
  Vec3 low = vertices.front();
  Vec3 high = vertices.front();
  for (const Vec3& v : vertices) {
    low = min(low, v);
    high = max(high, v);
  }
  mesh::Normalization map;
  map.origin = 0.5 * low + 0.5 * high;  // not (low + high) / 2, which may overflow
  const double half_extent = std::max(
      {0.5 * high.x - 0.5 * low.x, 0.5 * high.y - 0.5 * low.y, 0.5 * high.z - 0.5 * low.z});
  if (!(half_extent > 0)) throw InvalidInput("the mesh has no extent: all its vertices coincide.");
  if (half_extent < kLeastExtent)
    throw InvalidInput(
        "the mesh is too small for double precision (extent below 1e-304): scale it up first.");
  int exponent = 0;
  std::frexp(half_extent, &exponent);
  map.scale = std::ldexp(1.0, -std::clamp(exponent + 1, -1000, 1000));
  return map;
}

double area_of(const std::vector<Vec3>& vertices, const std::vector<Triangle>& triangles) {
  double twice = 0;
  for (const Triangle& t : triangles)
    twice += length(area_vector(vertices[t[0]], vertices[t[1]], vertices[t[2]]));
  return 0.5 * twice;
}

std::vector<Vec3> mapped(const std::vector<Vec3>& vertices, const mesh::Normalization& map) {
  std::vector<Vec3> result;
  result.reserve(vertices.size());
  for (const Vec3& v : vertices) result.push_back(map.to_working(v));
  return result;
}

}  // namespace

double surface_area(const TriangleMesh& input) {
  if (input.vertices.empty()) return 0;
  const mesh::Normalization box = unit_box(input.vertices);
  return area_of(mapped(input.vertices, box), input.triangles) / box.scale / box.scale;
}

NormalizedInput normalize(const TriangleMesh& input, Index sites) {
  mesh::Normalization map = unit_box(input.vertices);
  const double area = area_of(mapped(input.vertices, map), input.triangles);
  if (!(area > 0)) throw InvalidInput("the surface has no area: all its triangles are degenerate.");
  map.scale *= std::sqrt(static_cast<double>(sites) / area);
  return {mesh::make_surface(mapped(input.vertices, map), input.triangles), map};
}

}  // namespace nonobtuse::pipeline
