// Exact intersection of triangles.
#pragma once

#include <array>

#include "nonobtuse/mesh.h"

namespace nonobtuse::quality {

/// Whether the closed segment (p, q) and the closed triangle (a, b, c) have a point in common.
/// Exact for any finite coordinates; the triangle and the segment may be degenerate.
bool segment_meets_triangle(const Vec3& p, const Vec3& q, const std::array<Vec3, 3>& triangle);

/// Whether two triangles have a point in common beyond the corners and the edge they share.
/// Corners are shared where their coordinates are equal. A triangle without area, if it shares a
/// corner with the other, does not count: it has no inside that could be crossed.
bool triangles_intersect(const std::array<Vec3, 3>& s, const std::array<Vec3, 3>& t);

}  // namespace nonobtuse::quality
