// Angle hinge over the triangles of a restricted Delaunay triangulation. A short dual edge shows
// only the sum of two cotangents and misses an obtuse angle beside an acute one; the hinge looks at
// each corner, and is exactly zero on good triangles, so that only bad neighbourhoods move.
#pragma once

#include <span>

#include "energy/triangle_shape.h"
#include "nonobtuse/mesh.h"

namespace nonobtuse::energy {

/// Returns scale * sum over triangles and corners of min(0, cos th - cos_large)^2 +
/// max(0, cos th - cos_small)^2 and adds its gradient and a positive stand-in for the diagonal of
/// its second derivatives, 4 scale / (longest edge)^2 for every corner beyond a threshold, to
/// `gradient` (#X) and `diagonal` (#X). Triangles with a zero edge are left out. For the units of
/// Eq. 1 let scale = weight * 6.23 F_cvt / #X.
double add_angle_hinge(std::span<const Vec3> sites, std::span<const Triangle> triangles,
                       const HingeThresholds& thresholds, double scale, std::span<Vec3> gradient,
                       std::span<double> diagonal);

}  // namespace nonobtuse::energy
