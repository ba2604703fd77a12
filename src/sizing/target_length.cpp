#include "sizing/target_length.h"

#include <algorithm>
#include <cmath>

#include "sizing/curvature.h"
#include "sizing/density.h"
#include "sizing/gradation.h"
#include "sizing/local_feature_size.h"
#include "spatial/box.h"

namespace nonobtuse::sizing {
namespace {

constexpr Index kSamplesPerVertex = 4;  // of the result
constexpr Index kFewestSamples = 10'000;
constexpr Index kMostSamples = 40'000;
constexpr double kLeastFeature = 0.1;  // in mean edges

}  // namespace

std::vector<double> target_lengths(const mesh::Surface& surface, Sizing sizing,
                                   std::span<const double> given, Index vertices, double gradation,
                                   const parallel::Workers& workers) {
  std::vector<double> length(given.begin(), given.end());
  if (sizing == Sizing::Given && vertices <= 0) {
    limit_gradation(surface, gradation, length);
    return length;
  }
  if (sizing != Sizing::Given) {
    const double mean_edge = std::sqrt(2 / std::sqrt(3.0) * surface.area / vertices);
    spatial::Box box;
    for (const Vec3& v : surface.vertices) box.add(v);
    const double diagonal = distance(box.low, box.high);
    if (sizing == Sizing::LocalFeatureSize) {
      const Index wanted = std::min(vertices, kMostSamples) * kSamplesPerVertex;
      length =
          local_feature_size(surface, std::clamp(wanted, kFewestSamples, kMostSamples), workers);
    } else {
      length = largest_curvature(surface, mean_edge, workers);
      for (double& l : length) l = l > 0 ? 1 / l : diagonal;
    }
    for (double& l : length) l = std::sqrt(std::clamp(l, kLeastFeature * mean_edge, diagonal));
  }
  scale_to_vertices(surface, vertices, gradation, length);
  return length;
}

}  // namespace nonobtuse::sizing
