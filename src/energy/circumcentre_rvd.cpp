#include "energy/circumcentre_rvd.h"

#include <algorithm>
#include <cmath>

#include "energy/triangle_shape.h"

namespace nonobtuse::energy {

double add_circumcentre_term(std::span<const Vec3> sites, std::span<const Triangle> triangles,
                             double scale, std::span<Vec3> gradient, std::span<double> diagonal) {
  double value = 0;
  for (const Triangle& t : triangles) {
    const auto& [p0, p1, p2] = std::array{sites[t[0]], sites[t[1]], sites[t[2]]};
    const std::array<double, 3> e = squared_edge_lengths(p0, p1, p2);
    if (!(std::min({e[0], e[1], e[2]}) > 0)) continue;
    const TriangleTerm term = circumcentre_term(e);
    const std::array<Vec3, 3> g = corner_gradients(term.by_squared_edge, p0, p1, p2);
    // Rc / (2 ri) = Rc^2 / (2 Rc ri), and both are at hand: value = Rc^2 - 2 Rc ri.
    const double radius2 = e[0] * e[1] * e[2] / sixteen_squared_area(e);
    const double stiffness = 2 * scale * std::min(20.0, 1 + radius2 / (radius2 - term.value));
    value += term.value;
    for (int k = 0; k < 3; ++k) {
      gradient[t[k]] += scale * g[k];
      diagonal[t[k]] += stiffness;
    }
  }
  return scale * value;
}

}  // namespace nonobtuse::energy
