#include "energy/angle_hinge_rvd.h"

#include <algorithm>

namespace nonobtuse::energy {

double add_angle_hinge(std::span<const Vec3> sites, std::span<const Triangle> triangles,
                       const HingeThresholds& thresholds, double scale, std::span<Vec3> gradient,
                       std::span<double> diagonal) {
  double value = 0;
  for (const Triangle& t : triangles) {
    const auto& [p0, p1, p2] = std::array{sites[t[0]], sites[t[1]], sites[t[2]]};
    const std::array<double, 3> e = squared_edge_lengths(p0, p1, p2);
    if (!(std::min({e[0], e[1], e[2]}) > 0)) continue;
    const HingeTerm term = angle_hinge_term(e, thresholds);
    if (term.value == 0) continue;
    const std::array<Vec3, 3> g = corner_gradients(term.by_squared_edge, p0, p1, p2);
    const int active = term.active[0] + term.active[1] + term.active[2];
    const double stiffness = 4 * scale * active / std::max({e[0], e[1], e[2]});
    value += term.value;
    for (int k = 0; k < 3; ++k) {
      gradient[t[k]] += scale * g[k];
      diagonal[t[k]] += stiffness;
    }
  }
  return scale * value;
}

}  // namespace nonobtuse::energy
