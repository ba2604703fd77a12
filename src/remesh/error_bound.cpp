#include "remesh/error_bound.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "nonobtuse/error.h"
#include "nonobtuse/quality.h"
#include "numeric/vec3.h"
#include "parallel/workers.h"
#include "quality/distance.h"
#include "quality/validity.h"
#include "remesh/normalization.h"
#include "remesh/request.h"
#include "remesh/size_field.h"
#include "sizing/density.h"
#include "sizing/gradation.h"
#include "spatial/triangle_bvh.h"

namespace nonobtuse::pipeline {

namespace {

constexpr int kMostRounds = 16;
constexpr int kPatience = 4;        // rounds without this much progress, though
constexpr double kProgress = 0.95;  // the vertices grew by this factor
constexpr double kNotableGrowth = 1.5;
constexpr double kMostGrowth = 100;
constexpr double kFewVertices = 100'000;  // may always be tried
constexpr double kMargin = 0.75;          // of the bound, to aim at
constexpr double kLeastFactor = 0.5;      // of the target length, in one round
constexpr double kMostGradation = 0.5;    // so that more than a single vertex feels a local change

// The distance, and the largest one seen at each facet of the input, from either side.
struct LocalDistance {
  double largest = 0;
  std::vector<double> at_facet;  // #F
};

LocalDistance local_distance(const TriangleMesh& raw_input, const TriangleMesh& raw_mesh,
                             const parallel::Workers& workers) {
  // As `measure_distance` does it, so that the same figure comes out.
  const double scale = std::min(quality::unit_scale(raw_input), quality::unit_scale(raw_mesh));
  const TriangleMesh input = quality::scaled(raw_input, scale);
  const TriangleMesh mesh = quality::scaled(raw_mesh, scale);
  const spatial::TriangleBvh of_input(input.vertices, input.triangles, workers);
  const spatial::TriangleBvh of_mesh(mesh.vertices, mesh.triangles, workers);
  const std::size_t samples = quality::default_samples(mesh, input);
  std::vector<quality::TriangleDistance> outer;
  std::vector<quality::TriangleDistance> inner;
  const auto from_mesh =
      quality::one_sided_distance(mesh, of_mesh.order(), of_input, samples, workers, &outer);
  const auto from_input =
      quality::one_sided_distance(input, of_input.order(), of_mesh, samples, workers, &inner);
  LocalDistance result{std::max(from_mesh.max, from_input.max) / scale,
                       std::vector<double>(input.triangles.size(), 0)};
  for (std::size_t f = 0; f < inner.size(); ++f) result.at_facet[f] = inner[f].distance / scale;
  for (const quality::TriangleDistance& d : outer)
    if (d.nearest >= 0)
      result.at_facet[d.nearest] = std::max(result.at_facet[d.nearest], d.distance / scale);
  return result;
}

// Shrinks the target length at the corners of facets that are too far from the result, and a
// little where they nearly are: those would be the next.
void shrink(const TriangleMesh& input, const LocalDistance& distance, double bound,
            std::vector<double>& length) {
  std::vector<double> factor(length.size(), 1);
  for (std::size_t f = 0; f < distance.at_facet.size(); ++f) {
    const double d = distance.at_facet[f];
    if (d <= kMargin * bound) continue;
    const double wanted = std::max(std::sqrt(kMargin * bound / d), kLeastFactor);
    for (const Index v : input.triangles[f]) factor[v] = std::min(factor[v], wanted);
  }
  for (std::size_t v = 0; v < length.size(); ++v) length[v] *= factor[v];
}

// The target lengths that a call with these options starts from, input units.
std::vector<double> first_lengths(const TriangleMesh& input, const RemeshOptions& options,
                                  const parallel::Workers& workers) {
  const SizeField field = size_field(input, options, vertex_budget(input, options), workers);
  if (!field.length.empty()) return field.length;
  const double h = std::sqrt(2 / std::sqrt(3.0) * surface_area(input) / field.vertices);
  return std::vector<double>(input.vertices.size(), h);
}

// How many vertices target lengths ask for, and the lengths with the gradation they will have.
double limit_and_count(const TriangleMesh& input, double gradation, std::vector<double>& length) {
  NormalizedInput normal = normalize(input, 1);
  for (double& h : length) h *= normal.map.scale;
  sizing::limit_gradation(normal.surface, gradation, length);
  const double count = sizing::vertices_for(normal.surface, length);
  for (double& h : length) h /= normal.map.scale;
  return count;
}

// Round k's share of the progress: half of what the rounds before left.
Context context_of_round(const Context& context, int round) {
  Context result = context;
  if (!context.progress) return result;
  const double from = 1 - std::ldexp(1.0, -round);
  const double to = 1 - std::ldexp(1.0, -round - 1);
  result.progress = [&context, from, to](Progress progress) {
    progress.fraction = from + (to - from) * progress.fraction;
    return context.progress(progress);
  };
  return result;
}

[[noreturn]] void give_up(double bound, double least, std::size_t vertices) {
  throw ErrorBoundNotReached(
      fmt::format("a distance of {:.6g} was not reached: the least was {:.6g}, with {} vertices.",
                  bound, least, vertices),
      least);
}

}  // namespace

RemeshResult remesh_within(const TriangleMesh& input, const RemeshOptions& options,
                           const Context& context, const Remesh& remesh) {
  const parallel::Workers workers(context.threads);
  const double bound = error_bound(input, options);
  RemeshOptions now = options;
  now.max_error = now.relative_max_error = 0;
  now.gradation = std::min(options.gradation, kMostGradation);
  std::vector<double> length = first_lengths(input, now, workers);
  double asked = limit_and_count(input, now.gradation, length);
  const double most = std::max(kMostGrowth * asked, kFewVertices);
  RemeshResult best;  // the last complete one
  struct Past {
    double least, asked;
  };
  std::vector<Past> past;
  for (int round = 0;; ++round) {
    RemeshResult result = remesh(now, context_of_round(context, round));
    if (result.status == Status::Cancelled) {
      if (best.mesh.triangles.empty()) return result;
      best.status = Status::Cancelled;
      return best;
    }
    const LocalDistance distance = local_distance(input, result.mesh, workers);
    result.max_error = distance.largest;
    result.stages.insert(result.stages.begin(), best.stages.begin(), best.stages.end());
    best = std::move(result);
    if (distance.largest <= bound) return best;
    const double least =
        past.empty() ? distance.largest : std::min(past.back().least, distance.largest);
    past.push_back({least, asked});
    shrink(input, distance, bound, length);
    asked = limit_and_count(input, now.gradation, length);
    const bool stuck = round >= kPatience && least > kProgress * past[round - kPatience].least &&
                       past[round].asked > kNotableGrowth * past[round - kPatience].asked;
    if (stuck || round + 1 >= kMostRounds || asked > most)
      give_up(bound, least, best.mesh.vertices.size());
    now.vertices = 0;
    now.edge_length = now.relative_edge_length = 0;
    now.sizing = Sizing::Given;
    now.target_lengths = length;
  }
}

}  // namespace nonobtuse::pipeline
