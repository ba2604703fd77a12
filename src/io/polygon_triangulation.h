// Polygons into triangles: the better diagonal of a quad, ear clipping for more corners
// (Meisters, Polygons have ears, 1975).
#pragma once

#include <cstddef>
#include <vector>

#include "nonobtuse/mesh.h"

namespace nonobtuse::io {

/// Ear clipping is quadratic in the corners; more than this is refused by the caller.
constexpr std::size_t max_polygon_corners = 20000;

/// Appends count - 2 triangles with the polygon's orientation. Concave and slightly bent polygons
/// are fine; one that crosses itself gives triangles all the same. Deterministic.
void triangulate_polygon(const std::vector<Vec3>& vertices, const Index* corners, std::size_t count,
                         std::vector<Triangle>& out);

}  // namespace nonobtuse::io
