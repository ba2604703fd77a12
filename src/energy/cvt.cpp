#include "energy/cvt.h"

namespace nonobtuse::energy {

void cvt_gradient(std::span<const Vec3> sites, const rvd::CellIntegrals& cells,
                  std::span<Vec3> gradient, const parallel::Workers& workers) {
  workers.for_each(sites.size(), 4096, [&](std::size_t i) {
    gradient[i] = 2 * cells.mass[i] * (sites[i] - cells.centroid[i]);
  });
}

PieceEnergy cvt_piece(const std::array<Vec3, 3>& p, const Vec3& site) {
  return cvt_piece(p, {1, 1, 1}, site);
}

// int b_k b_l b_m over a triangle of area T is T/60 times 6, 2 or 1 for three, two or no equal
// indices: with S the sum of the values, the weights below are what that leaves.
PieceEnergy cvt_piece(const std::array<Vec3, 3>& p, const std::array<double, 3>& rho,
                      const Vec3& site) {
  const double area = 0.5 * length(area_vector(p[0], p[1], p[2]));
  const std::array<Vec3, 3> u{p[0] - site, p[1] - site, p[2] - site};
  const double sum = rho[0] + rho[1] + rho[2];
  PieceEnergy result;
  for (int k = 0; k < 3; ++k) {
    const double a = sum + rho[k];
    for (int l = k; l < 3; ++l) result.energy += (a + rho[l]) * dot(u[k], u[l]);
    result.gradient += a * u[k];
  }
  result.energy *= area / 30;
  result.gradient *= -area / 6;
  return result;
}

}  // namespace nonobtuse::energy
