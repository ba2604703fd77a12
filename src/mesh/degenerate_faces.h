// Faces without area, found exactly and taken out without tearing the surface.
#pragma once

#include <vector>

#include "nonobtuse/mesh.h"

namespace nonobtuse::mesh {

/// Whether the three points lie on one line (or coincide). Exact: expansions after scaling by a
/// power of two, so neither huge nor tiny coordinates look degenerate. (Out of reach are only
/// differences that are all below 2^-984 of the largest coordinate.)
bool collinear(const Vec3& a, const Vec3& b, const Vec3& c);

struct DegenerateRemoval {
  Index collapsed = 0;  ///< pairs of coincident neighbours merged, or needles contracted
  Index flipped = 0;    ///< needles whose longest edge was flipped
  Index dropped = 0;    ///< needles that ended at the boundary, or that no edit could remove
  Index opened = 0;     ///< of those dropped, the latter: they leave a slit of no area
};

/// Removes every face without area from a manifold, consistently oriented mesh; vertices keep
/// their numbers (some may become unused).
DegenerateRemoval remove_degenerate_faces(TriangleMesh& mesh);

}  // namespace nonobtuse::mesh
