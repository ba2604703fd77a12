#include "energy/triangle_penalties.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "numeric/vec3.h"

namespace nonobtuse::energy {

namespace {

// 2 weight min(20, 1 + Rc / (2 ri)): the term grows without bound as a triangle flattens, and so
// does its stiffness.
double circumcentre_stiffness(const std::array<double, 3>& e, double value, double weight) {
  const double perimeter = std::sqrt(e[0]) + std::sqrt(e[1]) + std::sqrt(e[2]);
  const double twice_radii = std::sqrt(e[0] * e[1] * e[2]) / perimeter;  // 2 Rc ri
  return 2 * weight * std::min(20.0, 2 + value / twice_radii);           // value = Rc^2 - 2 Rc ri
}

}  // namespace

double add_triangle_penalties(std::span<const Vec3> sites, std::span<const Triangle> triangles,
                              const ShapeWeights& weights, std::span<Vec3> gradient,
                              std::span<double> diagonal) {
  const ShapeWeights centre{0, weights.circumcentre, 0, 0, 1};
  const ShapeWeights hinge{0, 0, weights.hinge, weights.cos_largest, weights.cos_smallest};
  double sum = 0;
  for (const Triangle& t : triangles) {
    const std::array<Vec3, 3> p{sites[t[0]], sites[t[1]], sites[t[2]]};
    const std::array<double, 3> e = squared_edges(p[0], p[1], p[2]);
    double stiffness = 0;
    std::array<Vec3, 3> force{};
    const auto add = [&](const ShapeWeights& part) {
      std::array<Vec3, 3> g{};
      const double value = triangle_shape(p[0], p[1], p[2], part, g);
      if (!std::isfinite(value)) return 0.0;
      sum += value;
      for (int k = 0; k < 3; ++k) force[k] += g[k];
      return value;
    };
    if (weights.circumcentre > 0) {
      const double value = add(centre) / weights.circumcentre;
      stiffness += circumcentre_stiffness(e, value, weights.circumcentre);
    }
    if (weights.hinge > 0 && add(hinge) > 0)
      stiffness += 4 * weights.hinge / std::max({e[0], e[1], e[2]});
    for (int k = 0; k < 3; ++k) {
      gradient[t[k]] += force[k];
      diagonal[t[k]] += stiffness;
    }
  }
  return sum;
}

}  // namespace nonobtuse::energy
