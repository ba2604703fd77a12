// Short-dual penalty: Yan & Wonka, Non-obtuse Remeshing with Centroidal Voronoi Tessellation, TVCG
// 2016, Eq. 3-4. In the plane |dual| / |edge| = (cot a + cot b) / 2 with the two angles facing the
// edge: a short dual edge shows an obtuse angle, so short dual edges are pushed away.
//
//   R = sum_i |r_i|^2,  r_i = sum_j w_ij (x_i - x_j),  w_ij = |x_i - x_j| / (|dual_ij| + epsilon).
//
// The paper calls R quadratic: while a gradient is taken, w and the triangulation are held. As a
// function of the sites R is then not what a line search expects: w changes with every step, and at
// a flip (a dual edge shrinks to nothing and another appears) R jumps. Compute w anew at every
// evaluation, never hold it over a step, and do not trust a small rise of the energy.
#pragma once

#include <span>
#include <vector>

#include "nonobtuse/mesh.h"
#include "rvd/restricted_voronoi.h"

namespace nonobtuse::energy {

/// w_ij of every edge, without unit, with epsilon = relative_epsilon |x_i - x_j| > 0: so w stays
/// below 1 / relative_epsilon. In a regular triangulation w is sqrt(3) (for epsilon = 0).
std::vector<double> short_dual_weights(std::span<const Vec3> sites,
                                       std::span<const rvd::DualEdge> edges,
                                       double relative_epsilon);

/// Returns sum_i scale_i |r_i|^2 for given weights, and adds its gradient (exact for frozen
/// weights) and the diagonal of its second derivatives, 2 (scale_i (sum_j w)^2 + sum_j scale_j
/// w^2), to `gradient` (#X) and `diagonal` (#X). `scale` (#X) is lambda times the mean area of a
/// cell; with a density times the mean density of the cell, since |r_i|^2 grows with the square of
/// the local size while the CVT energy of a cell is everywhere the same.
///
/// r_i has a normal part, of the size of the mean curvature: sites free to leave the surface are
/// drawn inwards by it, sites held on the surface are drawn to where the curvature changes. With
/// unit `normals` (#X by 3, frozen) only the tangential part of each r_i counts; with none (empty)
/// R is Eq. 4 to the letter.
double add_short_dual_penalty(std::span<const Vec3> sites, std::span<const rvd::DualEdge> edges,
                              std::span<const double> weights, std::span<const Vec3> normals,
                              std::span<const double> scale, std::span<Vec3> gradient,
                              std::span<double> diagonal);

}  // namespace nonobtuse::energy
