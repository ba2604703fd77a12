// Order along the Hilbert curve in space (Skilling, Programming the Hilbert curve, 2004): elements
// near in the order are near in space, so that fixed chunks of it are compact.
#pragma once

#include <span>
#include <vector>

#include "numeric/vec3.h"

namespace nonobtuse::spatial {

/// The permutation that visits the points (#P by 3, finite) along a Hilbert curve through their
/// bounding cube: order[k] is the k-th point. Ties by index; deterministic. O(#P log #P).
std::vector<Index> hilbert_order(std::span<const Vec3> points);

}  // namespace nonobtuse::spatial
