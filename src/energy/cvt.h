// The CVT energy (Yan & Wonka 2016, Eq. 1; Du, Faber, Gunzburger, Centroidal Voronoi tessellations,
// 1999): F = sum over cells of the integral of rho |x - x_i|^2.
#pragma once

#include <array>
#include <span>

#include "numeric/vec3.h"
#include "rvd/cell_integrals.h"

namespace nonobtuse::energy {

/// dF/dx_i = 2 m_i (x_i - c_i) at the sites that `cells` was evaluated for. Exact, since the
/// integrand is continuous across cell boundaries. Sizes #X.
void cvt_gradient(std::span<const Vec3> sites, const rvd::CellIntegrals& cells,
                  std::span<Vec3> gradient, const parallel::Workers& workers);

/// Energy of one triangle for one site and its derivative with respect to the site.
struct PieceEnergy {
  double energy = 0;
  Vec3 gradient;
};

/// Uniform density 1 on triangle `p`.
PieceEnergy cvt_piece(const std::array<Vec3, 3>& p, const Vec3& site);

/// Density linear on triangle `p` with values `rho` >= 0 at its corners.
PieceEnergy cvt_piece(const std::array<Vec3, 3>& p, const std::array<double, 3>& rho,
                      const Vec3& site);

}  // namespace nonobtuse::energy
