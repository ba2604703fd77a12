// Small surfaces with known shape, as input surfaces and as perturbed meshes of them.
#pragma once

#include <cmath>
#include <functional>
#include <utility>
#include <vector>

#include "mesh/editable_mesh.h"
#include "mesh/surface.h"
#include "numeric/random.h"
#include "numeric/vec3.h"

namespace nonobtuse::test {

struct Soup {
  std::vector<Vec3> vertices;
  std::vector<Triangle> triangles;
};

/// Torus of radii 2 and 0.8 as a grid of m by k quadrilaterals; `skew` shears the grid and
/// `noise` moves the parameters by parts of a cell.
inline Soup torus(Index m, Index k, double noise = 0, std::uint64_t seed = 1) {
  Soup s;
  const double turn = 6.283185307179586;
  for (Index i = 0; i < m; ++i)
    for (Index j = 0; j < k; ++j) {
      numeric::Random random(seed, i * k + j);
      const double u = turn * (i + noise * (random.uniform() - 0.5) + 0.5 * (j % 2)) / m;
      const double v = turn * (j + noise * (random.uniform() - 0.5)) / k;
      const double r = 2 + 0.8 * std::cos(v);
      s.vertices.push_back({r * std::cos(u), r * std::sin(u), 0.8 * std::sin(v)});
    }
  const auto at = [&](Index i, Index j) { return (i + m) % m * k + (j + k) % k; };
  for (Index i = 0; i < m; ++i)
    for (Index j = 0; j < k; ++j) {
      // Rows alternate by half a cell, so that the triangles come out nearly regular.
      const Index a = at(i, j), b = at(i + 1, j);
      const Index c = j % 2 == 0 ? at(i, j + 1) : at(i + 1, j + 1);
      const Index other = j % 2 == 0 ? at(i + 1, j + 1) : at(i, j + 1);
      if (j % 2 == 0) {
        s.triangles.push_back({a, b, c});
        s.triangles.push_back({b, other, c});
      } else {
        s.triangles.push_back({a, b, c});
        s.triangles.push_back({a, c, other});
      }
    }
  return s;
}

/// Unit sphere: an octahedron with every edge cut in `parts`, vertices pushed out.
inline Soup sphere(int parts, double noise = 0, std::uint64_t seed = 1) {
  Soup s{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {-1, 0, 0}, {0, -1, 0}, {0, 0, -1}},
         {{0, 1, 2}, {1, 3, 2}, {3, 4, 2}, {4, 0, 2}, {1, 0, 5}, {3, 1, 5}, {4, 3, 5}, {0, 4, 5}}};
  for (int level = 1; level < parts; level *= 2) {
    std::vector<std::pair<std::pair<Index, Index>, Index>> middles;
    const auto middle = [&](Index a, Index b) {
      const std::pair<Index, Index> key{std::min(a, b), std::max(a, b)};
      for (auto& [edge, v] : middles)
        if (edge == key) return v;
      s.vertices.push_back(normalized(s.vertices[a] + s.vertices[b]));
      middles.push_back({key, static_cast<Index>(s.vertices.size()) - 1});
      return middles.back().second;
    };
    std::vector<Triangle> finer;
    for (const Triangle& t : s.triangles) {
      const Index a = middle(t[1], t[2]), b = middle(t[2], t[0]), c = middle(t[0], t[1]);
      finer.insert(finer.end(), {{t[0], c, b}, {t[1], a, c}, {t[2], b, a}, {a, b, c}});
    }
    s.triangles = finer;
  }
  for (std::size_t i = 0; i < s.vertices.size(); ++i) {
    numeric::Random random(seed, i);
    const double h = 1.6 / parts;
    s.vertices[i] = normalized(
        s.vertices[i] +
        noise * h * Vec3{random.uniform() - 0.5, random.uniform() - 0.5, random.uniform() - 0.5});
  }
  return s;
}

/// Surface and mesh scaled together so that area / #V(mesh) = 1.
struct Case {
  mesh::Surface surface;
  mesh::EditableMesh mesh;
};

inline Case make_case(Soup surface, Soup start, const std::function<Vec3(Vec3)>& map = {}) {
  double area = 0;
  for (const Triangle& t : surface.triangles)
    area += 0.5 * length(area_vector(surface.vertices[t[0]], surface.vertices[t[1]],
                                     surface.vertices[t[2]]));
  const double scale = std::sqrt(static_cast<double>(start.vertices.size()) / area);
  for (std::vector<Vec3>* list : {&surface.vertices, &start.vertices})
    for (Vec3& p : *list) p = scale * (map ? map(p) : p);
  return {mesh::make_surface(std::move(surface.vertices), std::move(surface.triangles)),
          mesh::EditableMesh(std::move(start.vertices), std::move(start.triangles))};
}

inline Index euler_characteristic(const mesh::EditableMesh& mesh) {
  Index edges = 0;
  for (Index t = 0; t < mesh.triangle_capacity(); ++t)
    if (mesh.alive_triangle(t))
      for (int k = 0; k < 3; ++k) edges += mesh.adjacent(t, k) < t;
  return mesh.vertex_count() - edges + mesh.triangle_count();
}

/// Smallest and largest angle of a mesh, in degrees.
inline std::pair<double, double> angle_range(const mesh::EditableMesh& mesh) {
  double least = 180, most = 0;
  for (Index t = 0; t < mesh.triangle_capacity(); ++t) {
    if (!mesh.alive_triangle(t)) continue;
    for (int k = 0; k < 3; ++k) {
      const Vec3 p = mesh.positions[mesh.triangle(t)[k]];
      const Vec3 u = mesh.positions[mesh.triangle(t)[mesh::next(k)]] - p;
      const Vec3 v = mesh.positions[mesh.triangle(t)[mesh::previous(k)]] - p;
      const double angle = std::atan2(length(cross(u, v)), dot(u, v)) * 57.29577951308232;
      least = std::min(least, angle);
      most = std::max(most, angle);
    }
  }
  return {least, most};
}

inline Index bad_valence_count(const mesh::EditableMesh& mesh) {
  Index bad = 0;
  for (Index v = 0; v < mesh.vertex_capacity(); ++v)
    bad += mesh.alive_vertex(v) && !mesh.on_boundary(v) &&
           (mesh.valence(v) < 5 || mesh.valence(v) > 7);
  return bad;
}

}  // namespace nonobtuse::test
