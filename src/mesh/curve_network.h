// Feature curves and boundary of a surface, and the mesh vertices on them.
#pragma once

#include <vector>

#include "nonobtuse/mesh.h"

namespace nonobtuse::mesh {

/// A crease, boundary or other feature curve between two corners, or closed: a polyline of the
/// input.
struct Curve {
  std::vector<Vec3> points;  ///< #P by 3, working coordinates; closed: the first is not repeated
  std::vector<double> arc;   ///< #P, length from the first point
  double length = 0;
  bool closed = false;
};

/// A point of the network at which the mesh has a vertex.
struct Knot {
  Index curve = -1;  ///< -1: fixed (a corner, a frozen boundary vertex); else it may slide along it
  double arc = 0;
};

struct CurveNetwork {
  std::vector<Curve> curves;
  std::vector<Knot> knots;  ///< #K
};

/// Measures the arcs of a polyline of at least two points.
Curve make_curve(std::vector<Vec3> points, bool closed);

/// The arc that names the same point of the curve: in [0, length) on closed curves, clamped to
/// [0, length] on open ones.
double canonical_arc(const Curve& curve, double arc);
/// The point at a length along the curve (any number; see canonical_arc).
Vec3 point_at(const Curve& curve, double arc);
/// Unit vector in which point_at moves as the arc grows: that of the segment which holds the point,
/// between two segments that of the later.
Vec3 tangent_at(const Curve& curve, double arc);
/// Arc of the point nearest to `p` among those at most `reach` from `arc` along the curve; the
/// result is within [arc - reach, arc + reach] and not made canonical, so that it can be compared
/// with `arc`.
double project(const Curve& curve, const Vec3& p, double arc, double reach);
/// The same on the whole curve; canonical.
double project(const Curve& curve, const Vec3& p);

}  // namespace nonobtuse::mesh
