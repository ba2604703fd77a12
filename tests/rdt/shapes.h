// Small closed and open surfaces for tests, and the topology of a triangle list.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <numeric>
#include <set>
#include <utility>
#include <vector>

#include "mesh/surface.h"
#include "nonobtuse/mesh.h"
#include "numeric/random.h"
#include "numeric/vec3.h"

namespace nonobtuse::shapes {

/// A rows x columns quad grid cut into triangles, glued around in one or both directions.
/// `place(u, v)` maps [0, 1]^2 to space.
template <class Place>
TriangleMesh grid(int rows, int columns, bool wrap_rows, bool wrap_columns, const Place& place) {
  TriangleMesh m;
  const int r = wrap_rows ? rows : rows + 1;
  const int c = wrap_columns ? columns : columns + 1;
  for (int i = 0; i < r; ++i)
    for (int j = 0; j < c; ++j)
      m.vertices.push_back(place(static_cast<double>(i) / rows, static_cast<double>(j) / columns));
  const auto at = [&](int i, int j) { return (i % r) * c + j % c; };
  for (int i = 0; i < rows; ++i)
    for (int j = 0; j < columns; ++j) {
      m.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      m.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  return m;
}

inline TriangleMesh torus(int rows, int columns, double thickness = 0.4) {
  return grid(rows, columns, true, true, [&](double u, double v) {
    const double a = 2 * M_PI * u;
    const double b = 2 * M_PI * v;
    const double radius = 1 + thickness * std::cos(b);
    return Vec3{radius * std::cos(a), radius * std::sin(a), thickness * std::sin(b)};
  });
}

inline TriangleMesh square(int n) {
  return grid(n, n, false, false, [](double u, double v) { return Vec3{u, v, 0}; });
}

inline TriangleMesh cylinder(int rows, int columns) {
  return grid(rows, columns, false, true, [](double u, double v) {
    return Vec3{std::cos(2 * M_PI * v), std::sin(2 * M_PI * v), 2 * u};
  });
}

/// Surface of a box on an integer grid: all coordinates exact, so full of exact ties.
inline TriangleMesh box(int nx, int ny, int nz) {
  TriangleMesh m;
  std::map<std::array<int, 3>, Index> index;
  const auto vertex = [&](std::array<int, 3> p) {
    const auto [it, added] = index.try_emplace(p, static_cast<Index>(m.vertices.size()));
    if (added)
      m.vertices.push_back(
          {static_cast<double>(p[0]), static_cast<double>(p[1]), static_cast<double>(p[2])});
    return it->second;
  };
  const std::array<int, 3> size{nx, ny, nz};
  for (int axis = 0; axis < 3; ++axis) {
    const int a = (axis + 1) % 3;
    const int b = (axis + 2) % 3;
    for (int side = 0; side < 2; ++side)
      for (int i = 0; i < size[a]; ++i)
        for (int j = 0; j < size[b]; ++j) {
          std::array<Index, 4> q{};
          for (int k = 0; k < 4; ++k) {
            std::array<int, 3> p{};
            p[axis] = side * size[axis];
            p[a] = i + (k == 1 || k == 2 ? 1 : 0);
            p[b] = j + (k >= 2 ? 1 : 0);
            q[k] = vertex(p);
          }
          if (side == 0) std::swap(q[1], q[3]);
          m.triangles.push_back({q[0], q[1], q[2]});
          m.triangles.push_back({q[0], q[2], q[3]});
        }
  }
  return m;
}

/// A unit sphere: a subdivided octahedron, exactly symmetric.
inline TriangleMesh sphere(int levels) {
  TriangleMesh m;
  m.vertices = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  m.triangles = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4},
                 {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
  for (int l = 0; l < levels; ++l) {
    std::map<std::pair<Index, Index>, Index> middle;
    std::vector<Triangle> finer;
    const auto mid = [&](Index a, Index b) {
      const auto [it, added] =
          middle.try_emplace(std::minmax(a, b), static_cast<Index>(m.vertices.size()));
      if (added) m.vertices.push_back(normalized(m.vertices[a] + m.vertices[b]));
      return it->second;
    };
    for (const Triangle& t : m.triangles) {
      const Index a = mid(t[0], t[1]);
      const Index b = mid(t[1], t[2]);
      const Index c = mid(t[2], t[0]);
      finer.insert(finer.end(), {Triangle{t[0], a, c}, Triangle{a, t[1], b}, Triangle{c, b, t[2]},
                                 Triangle{a, b, c}});
    }
    m.triangles = std::move(finer);
  }
  return m;
}

struct Topology {
  bool manifold = true;  ///< edges, orientation and vertex fans
  int euler = 0;
  int components = 0;
  int loops = 0;  ///< boundary loops
  int vertices = 0;
  friend bool operator==(const Topology&, const Topology&) = default;
};

/// From scratch, by sets: an oracle independent of the library's data structures.
inline Topology topology(const std::vector<Triangle>& triangles) {
  Topology result;
  std::map<std::pair<Index, Index>, int> directed;
  std::map<Index, Index> parent;
  const auto root = [&](Index v) {
    while (parent[v] != v) v = parent[v] = parent[parent[v]];
    return v;
  };
  std::map<Index, std::vector<std::pair<Index, Index>>> link;
  for (const Triangle& t : triangles) {
    for (int k = 0; k < 3; ++k) parent.try_emplace(t[k], t[k]);
    for (int k = 0; k < 3; ++k) {
      const Index a = t[k];
      const Index b = t[mesh::next(k)];
      if (++directed[{a, b}] > 1 || a == b) result.manifold = false;
      parent[root(a)] = root(b);
      link[a].push_back({b, t[mesh::previous(k)]});
    }
  }
  std::map<Index, Index> boundary;
  int edges = 0;
  for (const auto& [e, count] : directed) {
    const bool paired = directed.count({e.second, e.first}) > 0;
    if (!paired) {
      if (boundary.count(e.first)) result.manifold = false;
      boundary[e.first] = e.second;
    }
    if (!paired || e.first < e.second) ++edges;
  }
  for (const auto& [v, arcs] : link) {  // one fan around each vertex
    std::map<Index, Index> after(arcs.begin(), arcs.end());
    std::set<Index> targets;
    for (const auto& arc : arcs) targets.insert(arc.second);
    if (after.size() != arcs.size() || targets.size() != arcs.size()) {
      result.manifold = false;
      continue;
    }
    Index start = arcs.front().first;
    for (const auto& [a, b] : after)
      if (!targets.count(a)) start = a;
    std::size_t steps = 0;
    Index at = start;
    do {
      const auto it = after.find(at);
      if (it == after.end()) break;
      at = it->second;
      ++steps;
    } while (at != start && steps <= arcs.size());
    if (steps != arcs.size()) result.manifold = false;
  }
  for (auto& [v, p] : parent)
    if (root(v) == v) ++result.components;
  if (result.manifold) {
    std::set<Index> seen;
    for (const auto& [a, b] : boundary) {
      if (seen.count(a)) continue;
      ++result.loops;
      for (Index v = a; seen.insert(v).second;) v = boundary[v];
    }
  }
  result.vertices = static_cast<int>(parent.size());
  result.euler = result.vertices - edges + static_cast<int>(triangles.size());
  return result;
}

/// A random point of a random facet, area-uniform.
inline Vec3 random_point(const mesh::Surface& s, numeric::Random& random, Index* facet = nullptr) {
  double at = random.uniform() * s.area;
  Index f = 0;
  while (f + 1 < static_cast<Index>(s.triangles.size()) && at > s.areas[f]) at -= s.areas[f++];
  double a = random.uniform();
  double b = random.uniform();
  if (a + b > 1) {
    a = 1 - a;
    b = 1 - b;
  }
  if (facet) *facet = f;
  const Triangle& t = s.triangles[f];
  return (1 - a - b) * s.vertices[t[0]] + a * s.vertices[t[1]] + b * s.vertices[t[2]];
}

/// n random points of the surface; scale as the pipeline has it (area / n = 1).
inline mesh::Surface scaled_surface(TriangleMesh m, Index n) {
  mesh::Surface s = mesh::make_surface(m.vertices, m.triangles);
  const double scale = std::sqrt(n / s.area);
  for (Vec3& p : m.vertices) p *= scale;
  return mesh::make_surface(std::move(m.vertices), std::move(m.triangles));
}

inline std::vector<Vec3> random_sites(const mesh::Surface& s, Index n, std::uint64_t seed) {
  numeric::Random random(seed);
  std::vector<Vec3> sites;
  for (Index i = 0; i < n; ++i) sites.push_back(random_point(s, random));
  return sites;
}

}  // namespace nonobtuse::shapes
