// Circumcentre term and angle hinge over the triangles of a restricted Delaunay triangulation, to
// be added to the CVT energy of its cells (the formulas of one triangle: mesh_shape.h).
//
// The circumcentre term (Sieger, Alliez, Botsch, Optimizing Voronoi diagrams for polygonal finite
// element computations, 2010) draws every circumcentre into its triangle, so that dual edges stay
// long. The hinge looks at single corners: a short dual edge shows only the sum of two cotangents
// and misses an obtuse angle beside an acute one. It is exactly zero on good triangles, so that
// only bad neighbourhoods move.
#pragma once

#include <span>

#include "energy/mesh_shape.h"
#include "nonobtuse/mesh.h"

namespace nonobtuse::energy {

/// Returns the sum of triangle_shape(.., weights) over the triangles and adds its gradient to
/// `gradient` (#X) and a positive stand-in for the diagonal of its Hessian to `diagonal` (#X): at
/// each corner 2 circumcentre min(20, 1 + Rc / (2 ri)) and, in triangles with an angle beyond a
/// threshold, 4 hinge / (longest edge)^2. Triangles without area are left out. `weights.cvt` must
/// be 0. In the units of Eq. 1 let weights.circumcentre = w area / #X and weights.hinge =
/// w 6.23 F_cvt / #X with w about 1.
double add_triangle_penalties(std::span<const Vec3> sites, std::span<const Triangle> triangles,
                              const ShapeWeights& weights, std::span<Vec3> gradient,
                              std::span<double> diagonal);

}  // namespace nonobtuse::energy
