// Small meshes for the tests of this folder.
#pragma once

#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include "nonobtuse/mesh.h"
#include "numeric/random.h"
#include "numeric/vec3.h"

namespace nonobtuse::quality {

/// The icosahedron with every triangle cut in four `levels` times, vertices on the unit sphere.
inline TriangleMesh icosphere(int levels) {
  const double g = std::numbers::phi;
  TriangleMesh mesh;
  mesh.vertices = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                   {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
  mesh.triangles = {{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                    {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                    {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                    {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}};
  for (int level = 0; level < levels; ++level) {
    std::map<std::pair<Index, Index>, Index> middles;
    const auto middle = [&](Index a, Index b) {
      const auto key = std::minmax(a, b);
      const auto [at, inserted] =
          middles.try_emplace({key.first, key.second}, static_cast<Index>(mesh.vertices.size()));
      if (inserted) mesh.vertices.push_back(0.5 * (mesh.vertices[a] + mesh.vertices[b]));
      return at->second;
    };
    std::vector<Triangle> finer;
    for (const auto& [a, b, c] : mesh.triangles) {
      const Index ab = middle(a, b);
      const Index bc = middle(b, c);
      const Index ca = middle(c, a);
      finer.insert(finer.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
    }
    mesh.triangles = std::move(finer);
  }
  for (Vec3& v : mesh.vertices) v = normalized(v);
  return mesh;
}

/// nx by ny squares of side 1 in the plane z = height, two triangles each.
inline TriangleMesh plane(int nx, int ny, double height) {
  TriangleMesh mesh;
  for (int y = 0; y <= ny; ++y)
    for (int x = 0; x <= nx; ++x)
      mesh.vertices.push_back({static_cast<double>(x), static_cast<double>(y), height});
  for (int y = 0; y < ny; ++y)
    for (int x = 0; x < nx; ++x) {
      const Index v = y * (nx + 1) + x;
      mesh.triangles.push_back({v, v + 1, v + nx + 2});
      mesh.triangles.push_back({v, v + nx + 2, v + nx + 1});
    }
  return mesh;
}

inline TriangleMesh transformed(TriangleMesh mesh, double scale, const Vec3& shift = {}) {
  for (Vec3& v : mesh.vertices) v = scale * v + shift;
  return mesh;
}

/// Both meshes in one; vertices are not merged.
inline TriangleMesh together(TriangleMesh a, const TriangleMesh& b) {
  const Index shift = static_cast<Index>(a.vertices.size());
  a.vertices.insert(a.vertices.end(), b.vertices.begin(), b.vertices.end());
  for (const auto& [i, j, k] : b.triangles)
    a.triangles.push_back({i + shift, j + shift, k + shift});
  return a;
}

/// The same mesh with vertices, triangles and first corners in another order.
inline TriangleMesh permuted(const TriangleMesh& mesh, std::uint64_t seed) {
  numeric::Random random(seed);
  const auto shuffle = [&](auto& list) {
    for (std::size_t i = list.size(); i > 1; --i) std::swap(list[i - 1], list[random.below(i)]);
  };
  std::vector<Index> order(mesh.vertices.size());
  for (std::size_t v = 0; v < order.size(); ++v) order[v] = static_cast<Index>(v);
  shuffle(order);
  TriangleMesh result = mesh;
  for (std::size_t v = 0; v < order.size(); ++v) result.vertices[order[v]] = mesh.vertices[v];
  for (Triangle& t : result.triangles) {
    const std::size_t first = random.below(3);
    t = {order[t[first]], order[t[(first + 1) % 3]], order[t[(first + 2) % 3]]};
  }
  shuffle(result.triangles);
  return result;
}

}  // namespace nonobtuse::quality
