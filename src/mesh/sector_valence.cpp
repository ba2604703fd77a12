#include "mesh/sector_valence.h"

#include <algorithm>
#include <cmath>

#include "numeric/vec3.h"

namespace nonobtuse::mesh {

namespace {

constexpr double kSmallestMean = 42;  // degrees, where possible
constexpr double kLargestMean = 78;
constexpr double kSmallest = 31;  // the promise, with a degree to spare
constexpr double kLargest = 88;

ValenceRange triangles_between(double degrees, double smallest, double largest) {
  return {static_cast<int>(std::ceil(degrees / largest)), 0,
          static_cast<int>(std::floor(degrees / smallest))};
}

}  // namespace

ValenceRange sector_valence(double degrees) {
  ValenceRange k = triangles_between(degrees, kSmallestMean, kLargestMean);
  if (k.least > k.most) k = triangles_between(degrees, kSmallest, kLargest);
  k.least = std::max(k.least, 1);
  k.most = std::max(k.most, k.least);
  k.best = std::clamp(static_cast<int>(std::round(degrees / 60)), k.least, k.most);
  return {k.least + 1, k.best + 1, k.most + 1};
}

double corner_degrees(const Vec3& apex, const Vec3& p, const Vec3& q) {
  const Vec3 a = p - apex, b = q - apex;
  double cosine = dot(a, b), sine = length(cross(a, b));
  const double norm = std::sqrt(cosine * cosine + sine * sine);
  if (!(norm > 0)) return 0;
  cosine /= norm, sine /= norm;
  // Halved three times: at most 22.5 degrees are left.
  for (int i = 0; i < 3; ++i) {
    const double half_cosine = std::sqrt(std::max(0.0, 0.5 * (1 + cosine)));
    // The half's sine from the tangent where that is well conditioned.
    sine = half_cosine > 0.5 ? 0.5 * sine / half_cosine : std::sqrt(0.5 * (1 - cosine));
    cosine = half_cosine;
  }
  const double t = sine / cosine, t2 = t * t;
  double series = 0;
  for (int k = 21; k >= 1; k -= 2) series = (k % 4 == 1 ? 1.0 : -1.0) / k + t2 * series;
  return 8 * t * series * (180 / 3.14159265358979323846);
}

}  // namespace nonobtuse::mesh
