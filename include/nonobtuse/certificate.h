// Part of nonobtuse, MIT licence. Exact decision that no angle is obtuse.
#pragma once

#include <vector>

#include "nonobtuse/mesh.h"

namespace nonobtuse {

/// The bounds a mesh is certified against, degrees.
struct CertificateBounds {
  double min_angle = 30;  ///< every angle must be >= this (0 <= min_angle <= 60)
  double max_angle = 90;  ///< every angle must be < this (60 < max_angle <= 90)
};

/// Proof that every angle is inside the bounds, or the list of triangles that break them.
struct Certificate {
  CertificateBounds bounds;
  bool certified = false;        ///< no violation and at least one triangle
  Index triangles = 0;           ///< triangles tested
  std::vector<Index> too_large;  ///< triangles with an angle >= max_angle, worst first
  std::vector<Index> too_small;  ///< triangles with an angle < min_angle, worst first
};

/// Decides in exact arithmetic, on the double coordinates given, whether every angle of `mesh` is
/// in [min_angle, max_angle). At 90 degrees: sign of the dot product; elsewhere cos^2 of the bound
/// is taken as the double on its safe side, so that a certificate is never wrong. A triangle
/// without area is a violation of both bounds.
/// Throws InvalidInput for indices out of range, non-finite coordinates or senseless bounds.
/// Thread-safe; O(#F).
Certificate certify(const TriangleMesh& mesh, const CertificateBounds& bounds = {});

}  // namespace nonobtuse
