// The feature-sensitive CVT energy: Yan & Wonka, Non-obtuse Remeshing with Centroidal Voronoi
// Tessellation, TVCG 2016, Eq. 2, after Levy & Liu, Lp centroidal Voronoi tessellation and its
// applications, 2010:
//
//   F = sum over cells i and facets f of the integral of rho (x - x_i)^T A^T A (x - x_i),
//   A^T A = I + (s^2 - 1) N N^T,  N the unit normal of the facet.
//
// On facet f the normal part is constant, h_i = N . (x - x_i), so that F is the CVT energy plus
// (s^2 - 1) h_i^2 m_if over all pieces of mass m_if. Off-plane parts of a cell thus cost s^2 times
// as much, which draws sites to sharp features.
//
// The cells stay Euclidean (Eq. 2 is not minimal on their borders), so the integrand jumps from
// cell to cell and moving borders count. For a border of cells i and j on facet f, x along it, P
// the projection to the facet's plane, moving x_i moves the border along its outward normal by (x -
// x_i) . dx_i / |P (x_j - x_i)|, hence
//
//   dF/dx_i = sum_f [ 2 m_if (x_i - c_if) - 2 (s^2 - 1) h_i m_if N ]
//           + sum over borders of (s^2 - 1) (h_i^2 - h_j^2) / |P (x_j - x_i)| * integral of
//             rho (x - x_i) along the border.
//
// The last sum is dropped in the literature; at a crease with s = 5 the gradient without it is
// almost orthogonal to the true one.
#pragma once

#include <span>

#include "mesh/surface.h"
#include "numeric/symmetric_matrix.h"
#include "rvd/restricted_voronoi.h"

namespace nonobtuse::energy {

/// Returns F of Eq. 2 for the cells of `diagram` and adds its complete gradient to `gradient` (#X)
/// and, for every cell, 2 sum_f m_if A^T A to `hessian` (#X), the second derivatives for fixed
/// cells. `normal_weight` is s >= 1; 1 gives Eq. 1. The density is taken linear on every facet,
/// size^-4 at its corners (uniform: 1); for that density value and gradient are exact.
/// O(#pieces); serial.
double add_feature_sensitive(const mesh::Surface& surface, std::span<const Vec3> sites,
                             const rvd::RestrictedVoronoi& diagram, double normal_weight,
                             std::span<Vec3> gradient, std::span<numeric::SymmetricMatrix> hessian);

}  // namespace nonobtuse::energy
