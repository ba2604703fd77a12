#include "remesh/parts_remeshing.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <utility>

#include "nonobtuse/error.h"
#include "remesh/certification.h"
#include "remesh/featured_part.h"
#include "remesh/normalization.h"
#include "remesh/size_field.h"
#include "remesh/smooth_part.h"

namespace nonobtuse::pipeline {
namespace {

constexpr double kLargePart = 0.1;  // of all vertices

// How the vertices of a part go on its creases and boundaries; nothing if it has none.
std::optional<FeaturePlan> plan_part(const Part& part, Index n, const RemeshOptions& options,
                                     RemeshResult& result) {
  if (part.features.empty()) return {};
  FeaturePlan plan = plan_features(part, n, options);
  result.creases_given_up += plan.given_up;
  if (plan.graph.curves.empty() && part.points.empty()) return {};
  return plan;
}

// Meshes a part with creases or boundaries; false if n vertices are too few to keep them apart and
// the options leave it to us whether they are kept.
bool remesh_featured(const Part& part, const FeaturePlan& plan, Index n,
                     const RemeshOptions& options, const parallel::Workers& workers,
                     StageClock& clock, RemeshResult& result) {
  const GluedMesh mesh = remesh_features(part, plan, n, options, workers, clock);
  if (!mesh.mesh.triangles.empty()) {
    append_part(part, plan.input, mesh, workers, result);
    return true;
  }
  if (options.boundary == Boundary::Freeze || !options.feature_edges.empty())
    throw TooFewVertices(
        fmt::format("{} vertices are too few to keep the features of the surface apart.", n),
        n + n / 4 + 1);
  ++result.parts_without_features;
  return false;
}

void append_result(RemeshResult part, RemeshResult& whole) {
  const auto shift = static_cast<Index>(whole.mesh.vertices.size());
  const auto append = [](const auto& from, auto& to) {
    to.insert(to.end(), from.begin(), from.end());
  };
  append(part.mesh.vertices, whole.mesh.vertices);
  append(part.source_triangle, whole.source_triangle);
  append(part.barycentric, whole.barycentric);
  for (const Triangle& t : part.mesh.triangles)
    whole.mesh.triangles.push_back({t[0] + shift, t[1] + shift, t[2] + shift});
  for (const std::array<Index, 2>& e : part.feature_edges)
    whole.feature_edges.push_back({e[0] + shift, e[1] + shift});
  for (NarrowCorner corner : part.narrow_corners) {
    corner.vertex += shift;
    whole.narrow_corners.push_back(corner);
  }
  whole.parts_without_features += part.parts_without_features;
  whole.creases_given_up += part.creases_given_up;
}

}  // namespace

PartsRemesher::PartsRemesher(std::vector<Part>& parts, const RemeshOptions& options,
                             const parallel::Workers& workers, StageClock& clock)
    : parts_(parts), options_(options), workers_(workers), clock_(clock), results_(parts.size()) {}

bool PartsRemesher::run(const std::vector<Index>& vertices) {
  whole_ = std::accumulate(vertices.begin(), vertices.end(), Index{0});
  done_ = 0;
  std::vector<std::size_t> small, large;
  for (std::size_t c = 0; c < parts_.size(); ++c)
    (vertices[c] > kLargePart * whole_ ? large : small).push_back(c);
  return run(small, vertices) && run(large, vertices);
}

RemeshResult PartsRemesher::take() {
  if (results_.size() == 1) return std::move(results_.front().result);
  RemeshResult whole;
  for (PartResult& part : results_) append_result(std::move(part.result), whole);
  return whole;
}

// All are planned before any is meshed, since that is much cheaper.
bool PartsRemesher::run(const std::vector<std::size_t>& some, const std::vector<Index>& vertices) {
  const auto featured = [&](std::size_t c) { return !parts_[c].features.empty(); };
  bool enough = true;
  const auto ask = [&](std::size_t c, const auto& step) {
    try {
      step(c, vertices[c]);
    } catch (const TooFewVertices& too_few) {
      parts_[c].least = std::max(too_few.least(), vertices[c] + 1);
      enough = false;
    }
  };
  begin(0.01);
  if (std::any_of(some.begin(), some.end(), featured))
    clock_.run("features", 0, 1, [&] {
      for (const std::size_t c : some) ask(c, [&](std::size_t p, Index n) { plan(p, n); });
    });
  if (!enough) return false;
  for (const std::size_t c : some) {
    begin(0.95 * vertices[c] / whole_);
    ask(c, [&](std::size_t p, Index n) { mesh(p, n); });
  }
  return enough;
}

void PartsRemesher::begin(double share) {
  clock_.begin_part(done_, done_ + share);
  done_ += share;
}

void PartsRemesher::plan(std::size_t c, Index n) {
  PartResult& part = results_[c];
  if (part.planned == n) return;
  part = {};
  part.plan = plan_part(parts_[c], n, options_, part.result);
  part.planned = n;
}

void PartsRemesher::mesh(std::size_t c, Index n) {
  PartResult& part = results_[c];
  if (part.meshed == n) return;
  if (!part.plan ||
      !remesh_featured(parts_[c], *part.plan, n, options_, workers_, clock_, part.result)) {
    part.plan.reset();
    NormalizedInput input = normalize(parts_[c].mesh, n);
    set_sizes(parts_[c].length, input);
    spatial::TriangleBvh bvh;
    const mesh::EditableMesh mesh =
        remesh_smooth(input.surface, bvh, n, options_, workers_, clock_);
    append_part(parts_[c], input, bvh, mesh, workers_, part.result);
  }
  part.plan.reset();
  part.meshed = n;
}

void find_least_vertices(std::vector<Part>& parts, const RemeshOptions& options,
                         const parallel::Workers& workers, StageClock& clock) {
  for (Part& part : parts) {
    for (bool enough = false; !enough;) {
      try {
        RemeshResult unused;
        const auto plan = plan_part(part, part.least, options, unused);
        if (plan && remesh_featured(part, *plan, part.least, options, workers, clock, unused))
          break;
        NormalizedInput input = normalize(part.mesh, part.least);
        set_sizes(part.length, input);
        starting_mesh(input.surface, part.least, options, workers, clock);
        enough = true;
      } catch (const TooFewVertices& too_few) {
        part.least = std::max(too_few.least(), part.least + 1);
      }
    }
  }
}

}  // namespace nonobtuse::pipeline
