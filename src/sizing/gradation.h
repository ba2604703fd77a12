// The bound on how fast the target edge length may grow along the surface (Persson, Mesh size
// functions for implicit geometries and PDE-based gradient limiting, 2006): triangles with edges
// in a ratio of 1 : (1 + r) / 2 : r are obtuse from r = 5/3 on, so steeper fields cannot be meshed
// without obtuse angles.
#pragma once

#include <vector>

#include "mesh/surface.h"

namespace nonobtuse::sizing {

/// Lowers `length` (#V, positive or infinite) to the largest field below it with
/// h(v) <= h(u) + gradation |u - v| over every edge. `gradation` >= 0 or infinite (no limit).
/// O(#V log #V), deterministic.
void limit_gradation(const mesh::Surface& surface, double gradation, std::vector<double>& length);

}  // namespace nonobtuse::sizing
