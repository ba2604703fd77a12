#include "sizing/density.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "sizing/gradation.h"

namespace nonobtuse::sizing {
namespace {

constexpr int kDeepest = 6;
constexpr double kNearlyConstant = 1.2;  // ratio of the corners' lengths

// Mean of h^-2 over a triangle with h linear: a rule exact for quadratics where h hardly varies,
// quarters elsewhere.
double mean_inverse_square(const std::array<double, 3>& h, int depth) {
  const auto [least, most] = std::minmax({h[0], h[1], h[2]});
  const std::array<double, 3> m{(h[1] + h[2]) / 2, (h[2] + h[0]) / 2, (h[0] + h[1]) / 2};
  if (most <= kNearlyConstant * least || depth == 0)
    return (1 / (m[0] * m[0]) + 1 / (m[1] * m[1]) + 1 / (m[2] * m[2])) / 3;
  return (mean_inverse_square({h[0], m[2], m[1]}, depth - 1) +
          mean_inverse_square({m[2], h[1], m[0]}, depth - 1) +
          mean_inverse_square({m[1], m[0], h[2]}, depth - 1) + mean_inverse_square(m, depth - 1)) /
         4;
}

double facet_vertices(const mesh::Surface& surface, std::span<const double> length, Index f) {
  const Triangle& t = surface.triangles[f];
  return surface.areas[f] * 2 / std::sqrt(3.0) *
         mean_inverse_square({length[t[0]], length[t[1]], length[t[2]]}, kDeepest);
}

}  // namespace

double vertices_for(const mesh::Surface& surface, std::span<const double> length) {
  double sum = 0;
  for (std::size_t f = 0; f < surface.triangles.size(); ++f)
    sum += facet_vertices(surface, length, static_cast<Index>(f));
  return sum;
}

double vertices_for(const mesh::Surface& surface, std::span<const double> length,
                    std::span<const Index> facets) {
  double sum = 0;
  for (const Index f : facets) sum += facet_vertices(surface, length, f);
  return sum;
}

// The limited field grows with the scale of the unlimited one, and its vertices fall like the
// inverse square or slower: a fixed-point iteration that approaches from one side.
void scale_to_vertices(const mesh::Surface& surface, double vertices, double gradation,
                       std::vector<double>& length) {
  const std::vector<double> shape = length;
  double scale = 1;
  double last = 0;
  for (int step = 0; step < 30; ++step) {
    for (std::size_t v = 0; v < length.size(); ++v) length[v] = scale * shape[v];
    limit_gradation(surface, gradation, length);
    last = std::sqrt(vertices_for(surface, length) / vertices);
    if (std::abs(last - 1) < 1e-3) break;
    scale *= last;
  }
  for (double& h : length) h *= last;
}

}  // namespace nonobtuse::sizing
