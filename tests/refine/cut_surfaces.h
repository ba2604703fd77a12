// Surfaces cut along feature curves, with meshes cut the same way and knots on the curves.
#pragma once

#include <array>
#include <vector>

#include "mesh/curve_network.h"
#include "refine/test_surfaces.h"

namespace nonobtuse::test {

struct CutCase {
  Case made;
  mesh::CurveNetwork curves;
};

namespace detail {

/// The four corners of every face of the unit cube, counter-clockwise from outside, by corner
/// number (bits x, y, z).
inline constexpr std::array<std::array<int, 4>, 6> kCubeFaces{
    {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}};

inline Vec3 cube_corner(int c) {
  return {static_cast<double>(c & 1), static_cast<double>(c >> 1 & 1), static_cast<double>(c >> 2)};
}

}  // namespace detail

/// A cube of edge `parts` whose six faces are patches of their own: triangulated squares, with the
/// corners as fixed knots and parts - 1 knots on every edge that may slide, these and the inner
/// vertices moved by `noise` (parts of an edge length). All copies of a knot coincide. `shape` maps
/// the cube's points (curves and all).
inline CutCase cut_cube(int parts, double noise, std::uint64_t seed = 1, int surface_parts = 20,
                        const std::function<Vec3(Vec3)>& shape = {}) {
  const auto place = [&](const Vec3& p) { return shape ? shape(p) : p; };
  CutCase c;
  numeric::Random random(seed);
  const auto moved = [&] { return noise * (random.uniform() - 0.5); };
  // Curves and knots by pair of corners.
  std::array<std::array<Index, 8>, 8> first_knot{}, curve{};
  for (int i = 0; i < 8; ++i) c.curves.knots.push_back({-1, 0});
  std::vector<Vec3> knot_position;
  for (int i = 0; i < 8; ++i) knot_position.push_back(place(detail::cube_corner(i)));
  for (int i = 0; i < 8; ++i)
    for (int axis = 1; axis < 8; axis *= 2) {
      const int j = i | axis;
      if (j == i) continue;
      std::vector<Vec3> points;
      const Vec3 from = detail::cube_corner(i), to = detail::cube_corner(j);
      for (int k = 0; k <= surface_parts; ++k)
        points.push_back(place(from + static_cast<double>(k) / surface_parts * (to - from)));
      curve[i][j] = static_cast<Index>(c.curves.curves.size());
      first_knot[i][j] = static_cast<Index>(c.curves.knots.size());
      c.curves.curves.push_back(mesh::make_curve(points, false));
      const mesh::Curve& made = c.curves.curves.back();
      for (int k = 1; k < parts; ++k) {
        const double arc = made.length * (k + moved()) / parts;
        c.curves.knots.push_back({curve[i][j], arc});
        knot_position.push_back(mesh::point_at(made, arc));
      }
    }
  Soup surface, start;
  std::vector<Index> knot;
  for (const std::array<int, 4>& face : detail::kCubeFaces) {
    const Vec3 origin = detail::cube_corner(face[0]);
    const Vec3 u = detail::cube_corner(face[1]) - origin, v = detail::cube_corner(face[3]) - origin;
    const auto grid = [&](int n, Soup& soup, const auto& at) {
      const Index base = static_cast<Index>(soup.vertices.size());
      for (int i = 0; i <= n; ++i)
        for (int j = 0; j <= n; ++j) soup.vertices.push_back(at(i, j));
      for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
          const Index a = base + i * (n + 1) + j, b = a + n + 1;
          soup.triangles.push_back({a, b, b + 1});
          soup.triangles.push_back({a, b + 1, a + 1});
        }
    };
    grid(surface_parts, surface, [&](int i, int j) {
      return place(origin + static_cast<double>(i) / surface_parts * u +
                   static_cast<double>(j) / surface_parts * v);
    });
    grid(parts, start, [&](int i, int j) {
      const bool iu = i == 0 || i == parts, jv = j == 0 || j == parts;
      if (!iu && !jv) {
        knot.push_back(-1);
        return place(origin + (i + moved()) / parts * u + (j + moved()) / parts * v);
      }
      if (iu && jv) {
        knot.push_back(face[i == 0 ? (j == 0 ? 0 : 3) : (j == 0 ? 1 : 2)]);
      } else {
        int a = jv ? (j == 0 ? face[0] : face[3]) : (i == 0 ? face[0] : face[1]);
        int b = jv ? (j == 0 ? face[1] : face[2]) : (i == 0 ? face[3] : face[2]);
        int k = jv ? i : j;
        if (a > b) std::swap(a, b), k = parts - k;
        knot.push_back(first_knot[a][b] + k - 1);
      }
      return knot_position[knot.back()];
    });
  }
  // One unit of area per vertex, as the pipeline has it.
  double area = 0;
  for (const Triangle& t : surface.triangles)
    area += 0.5 * length(area_vector(surface.vertices[t[0]], surface.vertices[t[1]],
                                     surface.vertices[t[2]]));
  const double unique = 8 + 12 * (parts - 1) + 6 * (parts - 1) * (parts - 1);
  const double scale = std::sqrt(unique / area);
  for (std::vector<Vec3>* list : {&surface.vertices, &start.vertices})
    for (Vec3& p : *list) p = scale * p;
  for (mesh::Curve& one : c.curves.curves) {
    for (Vec3& p : one.points) p = scale * p;
    for (double& s : one.arc) s *= scale;
    one.length *= scale;
  }
  for (mesh::Knot& k : c.curves.knots) k.arc *= scale;
  c.made = {mesh::make_surface(std::move(surface.vertices), std::move(surface.triangles)),
            mesh::EditableMesh(std::move(start.vertices), std::move(start.triangles))};
  c.made.mesh.knot = std::move(knot);
  // Exactly where the scaled curves have them.
  for (Index i = 0; i < c.made.mesh.vertex_capacity(); ++i) {
    const Index k = c.made.mesh.knot[i];
    if (k >= 8)
      c.made.mesh.positions[i] =
          mesh::point_at(c.curves.curves[c.curves.knots[k].curve], c.curves.knots[k].arc);
    else if (k >= 0)
      c.made.mesh.positions[i] = scale * knot_position[k];
  }
  return c;
}

}  // namespace nonobtuse::test
