// Shape energies of one triangle as functions of its squared edge lengths a, b, c (a opposite
// corner 0, and so on), with their derivatives: scale-covariant, no trigonometry, and the same for
// triangles of a mesh and of a restricted Delaunay triangulation.
//
// Circumcentre: |circumcentre - incentre|^2 = Rc^2 - 2 Rc ri (Euler), as in Sieger, Alliez, Botsch,
// Optimizing Voronoi diagrams for polygonal finite element computations, 2010.
// Angle hinge: squared excess of the cosines over two thresholds; zero on good triangles.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "numeric/vec3.h"

namespace nonobtuse::energy {

/// Value and derivatives by the squared edges opposite corners 0, 1, 2.
struct TriangleTerm {
  double value = 0;
  std::array<double, 3> by_squared_edge{};
};

constexpr std::array<double, 3> squared_edge_lengths(const Vec3& p0, const Vec3& p1,
                                                     const Vec3& p2) {
  return {squared_distance(p1, p2), squared_distance(p2, p0), squared_distance(p0, p1)};
}

/// 16 times the squared area, not below 1e-12 (a + b + c)^2: a triangle thinner than about 1e-6
/// counts as that thick, which keeps every energy below finite.
constexpr double sixteen_squared_area(const std::array<double, 3>& e) {
  const double sum = e[0] + e[1] + e[2];
  const double s16 =
      2 * (e[0] * e[1] + e[1] * e[2] + e[2] * e[0]) - (e[0] * e[0] + e[1] * e[1] + e[2] * e[2]);
  return std::max(s16, 1e-12 * sum * sum);
}

/// Rc^2 - 2 Rc ri, in squared length units; 0 exactly for equilateral triangles. No edge may be 0.
inline TriangleTerm circumcentre_term(const std::array<double, 3>& e) {
  const double s16 = sixteen_squared_area(e);
  const double product = e[0] * e[1] * e[2];
  const double root = std::sqrt(product);
  const std::array<double, 3> l{std::sqrt(e[0]), std::sqrt(e[1]), std::sqrt(e[2])};
  const double perimeter = l[0] + l[1] + l[2];
  const double radius2 = product / s16;         // Rc^2
  const double twice_radii = root / perimeter;  // 2 Rc ri
  TriangleTerm term{radius2 - twice_radii, {}};
  for (int k = 0; k < 3; ++k) {
    const double a = e[k];
    const double d_s16 = 2 * (e[(k + 1) % 3] + e[(k + 2) % 3] - a);
    term.by_squared_edge[k] =
        radius2 * (1 / a - d_s16 / s16) - twice_radii * (0.5 / a - 0.5 / (l[k] * perimeter));
  }
  return term;
}

/// Thresholds of the hinge as cosines; corners between the two angles cost nothing.
struct HingeThresholds {
  double cos_large = 0.0697564737441253;  ///< cos 86 degrees: larger angles are penalised
  double cos_small = 0.8191520442889918;  ///< cos 35 degrees: smaller angles are penalised
};

struct HingeTerm : TriangleTerm {
  std::array<bool, 3> active{};  ///< corners beyond a threshold
};

/// Sum over corners of min(0, cos - cos_large)^2 + max(0, cos - cos_small)^2, without unit.
/// No edge may be 0.
inline HingeTerm angle_hinge_term(const std::array<double, 3>& e, const HingeThresholds& limits) {
  HingeTerm term;
  for (int k = 0; k < 3; ++k) {
    const int i = (k + 1) % 3;
    const int j = (k + 2) % 3;
    const double twice_root = 2 * std::sqrt(e[i] * e[j]);
    const double cosine = (e[i] + e[j] - e[k]) / twice_root;
    const double excess =
        std::min(0.0, cosine - limits.cos_large) + std::max(0.0, cosine - limits.cos_small);
    if (excess == 0) continue;
    term.active[k] = true;
    term.value += excess * excess;
    term.by_squared_edge[k] -= 2 * excess / twice_root;
    term.by_squared_edge[i] += 2 * excess * (1 / twice_root - 0.5 * cosine / e[i]);
    term.by_squared_edge[j] += 2 * excess * (1 / twice_root - 0.5 * cosine / e[j]);
  }
  return term;
}

/// Derivatives by the corners' positions, from those by the squared edges.
constexpr std::array<Vec3, 3> corner_gradients(const std::array<double, 3>& by_squared_edge,
                                               const Vec3& p0, const Vec3& p1, const Vec3& p2) {
  const Vec3 g0 = 2 * by_squared_edge[0] * (p1 - p2);
  const Vec3 g1 = 2 * by_squared_edge[1] * (p2 - p0);
  const Vec3 g2 = 2 * by_squared_edge[2] * (p0 - p1);
  return {g2 - g1, g0 - g2, g1 - g0};
}

}  // namespace nonobtuse::energy
