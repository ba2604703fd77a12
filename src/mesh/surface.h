// The input surface as every step of the pipeline sees it: centred, scaled so that
// area / #sites = 1, with adjacency, areas and normals. Read-only once made.
#pragma once

#include <array>
#include <vector>

#include "nonobtuse/mesh.h"
#include "numeric/vec3.h"

namespace nonobtuse::mesh {

/// Edge k of a triangle is the one opposite corner k: from corner k+1 to corner k+2 (mod 3).
constexpr int next(int k) { return k == 2 ? 0 : k + 1; }
constexpr int previous(int k) { return k == 0 ? 2 : k - 1; }

/// adjacent[t][k]: triangle across edge k of t, or -1 at the boundary, at edges of three or more
/// triangles and where the two triangles of an edge run along it the same way. O(#F log #F),
/// deterministic.
std::vector<std::array<Index, 3>> triangle_adjacency(const std::vector<Triangle>& triangles,
                                                     Index vertex_count);

struct Surface {
  std::vector<Vec3> vertices;                  ///< #V by 3, working coordinates
  std::vector<Triangle> triangles;             ///< #F by 3
  std::vector<std::array<Index, 3>> adjacent;  ///< #F by 3, see triangle_adjacency
  std::vector<double> areas;                   ///< #F
  std::vector<Vec3> normals;                   ///< #F by 3, unit; zero for a facet without area
  double area = 0;                             ///< sum of areas, added in order
  /// #V: target edge length relative to that of a uniform mesh, linear on facets, scaled so that
  /// the integral of 1/size^2 is the area; empty for a uniform mesh. The density is size^-4.
  std::vector<double> size;

  /// The relative size at a point of a facet; 1 if uniform.
  [[nodiscard]] double size_at(Index facet, const Vec3& barycentric) const {
    if (size.empty()) return 1;
    const Triangle& t = triangles[facet];
    return barycentric.x * size[t[0]] + barycentric.y * size[t[1]] + barycentric.z * size[t[2]];
  }
};

/// Input coordinates = origin + working coordinates / scale.
struct Normalization {
  Vec3 origin;
  double scale = 1;

  [[nodiscard]] Vec3 to_working(const Vec3& p) const { return scale * (p - origin); }
  [[nodiscard]] Vec3 to_input(const Vec3& p) const { return origin + p / scale; }
};

/// Fills adjacency, areas and normals of a mesh that is already in working coordinates.
Surface make_surface(std::vector<Vec3> vertices, std::vector<Triangle> triangles);

}  // namespace nonobtuse::mesh
