#include "remesh/size_field.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "nonobtuse/error.h"
#include "numeric/vec3.h"
#include "sizing/density.h"
#include "sizing/target_length.h"

namespace nonobtuse::pipeline {

namespace {

void check_given(const TriangleMesh& input, const std::vector<double>& given) {
  if (given.size() != input.vertices.size())
    throw InvalidInput(
        fmt::format("{} target edge lengths were given for a mesh of {} vertices: one for each "
                    "vertex is needed.",
                    given.size(), input.vertices.size()));
  for (std::size_t v = 0; v < given.size(); ++v)
    if (!(given[v] > 0) || !std::isfinite(given[v]))
      throw InvalidInput(fmt::format("the target edge length of vertex {} must be positive and "
                                     "finite, not {}.",
                                     v, given[v]),
                         static_cast<Index>(v));
}

double percentile(const std::vector<double>& sorted, double fraction) {
  return sorted[static_cast<std::size_t>(fraction * static_cast<double>(sorted.size() - 1))];
}

}  // namespace

SizeField size_field(const TriangleMesh& input, const RemeshOptions& options, Index vertices,
                     const parallel::Workers& workers) {
  if (options.sizing == Sizing::Given) check_given(input, options.target_lengths);
  SizeField field{{}, vertices};
  if (options.sizing == Sizing::Uniform) return field;
  const NormalizedInput normal = normalize(input, vertices > 0 ? vertices : 1);
  std::vector<double> given = options.target_lengths;
  for (double& h : given) h *= normal.map.scale;
  field.length = sizing::target_lengths(normal.surface, options.sizing, given, vertices,
                                        options.gradation, workers);
  if (vertices == 0) {
    const double n = std::round(sizing::vertices_for(normal.surface, field.length));
    if (!(n < 1e9))
      throw InvalidInput(
          fmt::format("the target edge lengths ask for {:.3g} vertices; the most is 1e9.", n));
    field.vertices = std::max(static_cast<Index>(n), Index{4});
  }
  for (double& h : field.length) h /= normal.map.scale;
  return field;
}

void set_sizes(const std::vector<double>& length, NormalizedInput& input) {
  mesh::Surface& surface = input.surface;
  surface.size = length;
  if (length.empty()) return;
  // The integral of size^-2 becomes the area, as it is for a uniform mesh.
  const double scale =
      std::sqrt(0.5 * std::sqrt(3.0) * sizing::vertices_for(surface, length) / surface.area);
  for (double& s : surface.size) s *= scale;
}

SizeRatio size_ratio(const TriangleMesh& input, const SizeField& field,
                     const RemeshResult& result) {
  const std::vector<Vec3>& x = result.mesh.vertices;
  const double uniform =
      std::sqrt(2 / std::sqrt(3.0) * surface_area(input) / static_cast<double>(x.size()));
  const auto target = [&](Index v) {
    if (field.length.empty()) return uniform;
    const Triangle& t = input.triangles[result.source_triangle[v]];
    const Vec3& w = result.barycentric[v];
    return w.x * field.length[t[0]] + w.y * field.length[t[1]] + w.z * field.length[t[2]];
  };
  std::vector<double> ratios;  // interior edges twice: no matter for percentiles
  for (const Triangle& t : result.mesh.triangles)
    for (int k = 0; k < 3; ++k) {
      const Index a = t[k];
      const Index b = t[mesh::next(k)];
      ratios.push_back(2 * distance(x[a], x[b]) / (target(a) + target(b)));
    }
  if (ratios.empty()) return {};
  std::sort(ratios.begin(), ratios.end());
  return {percentile(ratios, 0.5), percentile(ratios, 0.05), percentile(ratios, 0.95)};
}

}  // namespace nonobtuse::pipeline
