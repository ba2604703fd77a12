// Axis-aligned boxes.
#pragma once

#include <limits>

#include "numeric/vec3.h"

namespace nonobtuse::spatial {

/// Empty as long as nothing was added.
struct Box {
  Vec3 low{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity(),
           std::numeric_limits<double>::infinity()};
  Vec3 high = -low;

  constexpr void add(const Vec3& p) {
    low = min(low, p);
    high = max(high, p);
  }
  constexpr void add(const Box& b) {
    low = min(low, b.low);
    high = max(high, b.high);
  }
  [[nodiscard]] constexpr bool overlaps(const Box& b) const {
    return low.x <= b.high.x && b.low.x <= high.x && low.y <= b.high.y && b.low.y <= high.y &&
           low.z <= b.high.z && b.low.z <= high.z;
  }
  /// Squared distance of p; 0 inside.
  [[nodiscard]] constexpr double squared_distance(const Vec3& p) const {
    return squared_length(max(max(low - p, p - high), Vec3{}));
  }
  /// Half of the surface area, the measure of the surface area heuristic.
  [[nodiscard]] constexpr double half_area() const {
    const Vec3 e = high - low;
    return e.x * e.y + e.y * e.z + e.z * e.x;
  }
};

}  // namespace nonobtuse::spatial
