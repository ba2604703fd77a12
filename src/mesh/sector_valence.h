// How many triangles may share the angle around a vertex. Inside a surface 5 to 7 share 360
// degrees; on a boundary or crease it depends on the angle of the sector between its two sides.
#pragma once

#include "nonobtuse/mesh.h"

namespace nonobtuse::mesh {

/// Numbers of neighbours a vertex should have; `best` is the most regular.
struct ValenceRange {
  int least = 5, best = 6, most = 7;
  [[nodiscard]] bool contains(int valence) const { return valence >= least && valence <= most; }
  /// Distance of a valence from the range.
  [[nodiscard]] int defect(int valence) const {
    return valence < least ? least - valence : valence > most ? valence - most : 0;
  }
};

/// Neighbours (one more than triangles) of a boundary vertex whose sector has the given angle in
/// degrees: k triangles have a mean angle inside [42, 78] degrees, where no k does inside [31, 88];
/// below 31 degrees there is one triangle. `best` triangles are nearest to 60 degrees each. So 180
/// degrees take 3 or 4 triangles, 90 take 2.
ValenceRange sector_valence(double degrees);

/// Angle at `apex` of a triangle, in degrees in [0, 180]. Square roots and a series only: the same
/// bits everywhere. Error below 1e-8; 0 for a triangle that has no angle there.
double corner_degrees(const Vec3& apex, const Vec3& p, const Vec3& q);

}  // namespace nonobtuse::mesh
