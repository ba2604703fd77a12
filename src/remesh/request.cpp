#include "remesh/request.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "mesh/cleaning.h"
#include "nonobtuse/error.h"
#include "nonobtuse/io.h"
#include "numeric/vec3.h"
#include "remesh/normalization.h"

namespace nonobtuse::pipeline {

namespace {

constexpr int kPaperIterations = 40;
constexpr Index kMostVertices = 100'000'000;  // so that no 32-bit index overflows
constexpr double kVeryFewVertices = 3000, kFewVertices = 5500, kManyVertices = 10000;
constexpr double kToleranceOfBalanced = 1e-3;

double bounding_box_diagonal(const TriangleMesh& mesh) {
  Vec3 low = mesh.vertices.front();
  Vec3 high = low;
  for (const Vec3& v : mesh.vertices) {
    low = min(low, v);
    high = max(high, v);
  }
  return distance(low, high);
}

}  // namespace

void check_options(const RemeshOptions& options) {
  const int given =
      (options.vertices != 0) + (options.edge_length != 0) + (options.relative_edge_length != 0);
  if (given > 1)
    throw InvalidInput("give either a number of vertices or one edge length, not both.");
  if (options.vertices < 0)
    throw InvalidInput(
        fmt::format("the number of vertices must be positive, not {}.", options.vertices));
  if (options.vertices > kMostVertices)
    throw InvalidInput(
        fmt::format("{} vertices are more than the most, {}.", options.vertices, kMostVertices));
  if (options.on_surface && options.method != Method::Default)
    throw InvalidInput("vertices are kept on the surface by the default method only.");
  for (const double length : {options.edge_length, options.relative_edge_length})
    if (!(length >= 0) || !std::isfinite(length))
      throw InvalidInput(
          fmt::format("the edge length must be positive and finite, not {}.", length));
  if (!(options.min_angle >= 0 && options.min_angle < 60))
    throw InvalidInput(
        fmt::format("the smallest angle must be in [0, 60) degrees, not {}.", options.min_angle));
  if (!(options.max_angle > 60 && options.max_angle <= 90))
    throw InvalidInput(
        fmt::format("the largest angle must be in (60, 90] degrees, not {}.", options.max_angle));
  if (!(options.feature_angle > 0 && options.feature_angle <= 180))
    throw InvalidInput(fmt::format("the feature angle must be in (0, 180] degrees, not {}.",
                                   options.feature_angle));
  if (options.features == Features::None && !options.feature_edges.empty())
    throw InvalidInput("feature edges are given, but no features are asked for.");
  if (!(options.gradation > 0))
    throw InvalidInput(fmt::format("the gradation must be positive, not {}.", options.gradation));
  if (options.sizing != Sizing::Given && !options.target_lengths.empty())
    throw InvalidInput("target edge lengths are given, but the sizing is another one.");
  if (!(options.penalty >= 0) || !std::isfinite(options.penalty))
    throw InvalidInput(
        fmt::format("the penalty must be non-negative and finite, not {}.", options.penalty));
  for (const double bound : {options.max_error, options.relative_max_error})
    if (!(bound >= 0) || !std::isfinite(bound))
      throw InvalidInput(
          fmt::format("the largest distance must be positive and finite, not {}.", bound));
  if (options.max_error > 0 && options.relative_max_error > 0)
    throw InvalidInput("give one bound on the distance, not two.");
  if (!(options.normal_weight >= 1) || !std::isfinite(options.normal_weight))
    throw InvalidInput(fmt::format(
        "the weight of the normal must be at least 1 and finite, not {}.", options.normal_weight));
  if (options.iterations < 0)
    throw InvalidInput(
        fmt::format("the number of iterations must be positive, not {}.", options.iterations));
  if (options.iterations > 0 && options.method == Method::Default)
    throw InvalidInput("iterations are counted by the paper's methods only.");
}

void check_input(const TriangleMesh& input, Method method) {
  if (mesh::needs_no_repair(input)) return;
  const CleanResult cleaned = clean(input);
  if (!cleaned.kept.empty() && method != Method::Default) {
    const Repair& first = cleaned.kept.front();
    throw InvalidInput(
        fmt::format("the paper's methods need a manifold ({}: {}, the first at index {}); the "
                    "default method does not.",
                    first.what, first.count, first.first),
        first.first);
  }
  if (cleaned.repairs.empty()) return;
  const Repair& first = cleaned.repairs.front();
  throw InvalidInput(
      fmt::format(
          "the mesh needs repair ({}: {}, the first at index {}): pass it through clean() first.",
          first.what, first.count, first.first),
      first.first);
}

double error_bound(const TriangleMesh& input, const RemeshOptions& options) {
  if (options.max_error > 0) return options.max_error;
  return options.relative_max_error > 0 ? options.relative_max_error * bounding_box_diagonal(input)
                                        : 0;
}

Index vertex_budget(const TriangleMesh& input, const RemeshOptions& options) {
  if (options.vertices > 0) {
    if (options.vertices < 4)
      throw TooFewVertices(
          fmt::format("{} vertices cannot close a surface: ask for at least 4.", options.vertices),
          4);
    return options.vertices;
  }
  double h = options.edge_length;
  if (options.relative_edge_length > 0)
    h = options.relative_edge_length * bounding_box_diagonal(input);
  if (h <= 0 && options.sizing == Sizing::Given) return 0;
  if (h <= 0) return static_cast<Index>(std::max<std::size_t>(4, input.vertices.size()));
  const double n = std::round(surface_area(input) / (0.5 * std::sqrt(3.0) * h * h));
  if (!(n <= kMostVertices))
    throw InvalidInput(fmt::format("an edge length of {} asks for {:.3g} vertices; the most is {}.",
                                   h, n, kMostVertices));
  return std::max(static_cast<Index>(n), Index{4});
}

int paper_iterations(const RemeshOptions& options) {
  return options.iterations > 0 ? options.iterations : kPaperIterations;
}

CvtOptions cvt_options(const RemeshOptions& options, Index n) {
  CvtOptions result{.sites = n, .seed = options.seed};
  if (options.method == Method::Default) {
    // On small meshes longer descents cost little, and limbs of few vertices need them. Of others
    // refinement does the rest at less cost, but for large ones: those are asked for on surfaces
    // that leave no shape to spare.
    const double small = std::clamp((kFewVertices - n) / (kFewVertices - kVeryFewVertices), 0., 1.);
    result.tolerance *= 1 - 0.75 * small;
    result.coarse_tolerance *= 1 - 0.8 * small;
    result.iterations += static_cast<int>(220 * small);
    result.coarse_iterations += static_cast<int>(120 * small);
    result.balanced = n > kFewVertices && n < kManyVertices;
    if (result.balanced) result.tolerance = kToleranceOfBalanced;
    return result;
  }
  result.iterations = paper_iterations(options) + 1;  // evaluations: the start is one
  result.tolerance = 0;
  result.coarse_levels = 0;
  return result;
}

RefinementOptions refinement_options(const RemeshOptions& options) {
  return {.min_angle = options.min_angle,
          .max_angle = options.max_angle,
          .on_surface = options.on_surface};
}

}  // namespace nonobtuse::pipeline
