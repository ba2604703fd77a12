// The driver: calls the steps in order, on every connected component.
// Yan & Wonka, Non-obtuse Remeshing with Centroidal Voronoi Tessellation, TVCG 2016, section 4.2;
// the obtuse removal is replaced by refinement on the mesh (docs/pipeline.md).
#include "nonobtuse/remesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

#include "parallel/monitor.h"
#include "parallel/workers.h"
#include "remesh/certification.h"
#include "remesh/cvt_optimization.h"
#include "remesh/dislocation_annealing.h"
#include "remesh/error_bound.h"
#include "remesh/extraction.h"
#include "remesh/featured_part.h"
#include "remesh/first_mesh.h"
#include "remesh/normalization.h"
#include "remesh/paper_method.h"
#include "remesh/parts.h"
#include "remesh/refinement.h"
#include "remesh/request.h"
#include "remesh/size_field.h"
#include "remesh/stage_clock.h"
#include "remesh/valence_optimization.h"

namespace nonobtuse {

namespace {

// The paper's own stages after plain CVT.
std::vector<Vec3> paper_stages(const mesh::Surface& surface, std::vector<Vec3> sites,
                               const RemeshOptions& options, const parallel::Workers& workers,
                               pipeline::StageClock& clock) {
  parallel::Monitor& monitor = clock.monitor();
  const bool feature_sensitive =
      (options.method == Method::CvtFs || options.method == Method::CvtNob) &&
      options.normal_weight > 1;
  const double penalty = options.method == Method::CvtNob ? options.penalty : 0;
  const int iterations = pipeline::paper_iterations(options);
  if (options.method == Method::CvtNob)
    sites = clock.run("obtuse removal", 0.1, 0.25, [&] {
      return pipeline::optimize_paper_nob(
          surface, std::move(sites),
          {.weights = {.short_dual = penalty}, .seed = options.seed, .iterations = iterations},
          workers, monitor);
    });
  if (feature_sensitive)
    sites = clock.run("feature-sensitive", 0.25, 0.4, [&] {
      return pipeline::optimize_feature_sensitive(
          surface, std::move(sites),
          {.normal_weight = options.normal_weight, .short_dual = penalty}, iterations, workers,
          monitor);
    });
  return sites;
}

struct StartingMesh {
  pipeline::MeshOnSurface tessellation;
  bool settled = false;  // in its own shape energy
};

// From a connected surface to its first mesh with n vertices: coarse to fine on meshes; or sites,
// their optimisation, extraction.
StartingMesh starting_mesh(const mesh::Surface& surface, Index n, const RemeshOptions& options,
                           const parallel::Workers& workers, pipeline::StageClock& clock) {
  parallel::Monitor& monitor = clock.monitor();
  pipeline::FirstMesh first;
  std::vector<Vec3> sites = clock.run("cvt", 0, 0.4, [&] {
    pipeline::CvtOptions cvt = pipeline::cvt_options(options, n);
    if (options.method == Method::Default)
      first = pipeline::first_mesh(surface, cvt, workers, monitor);
    if (first.tessellation.mesh.vertex_count() > 0) return std::vector<Vec3>{};
    cvt.start = std::move(first.coarse);
    return pipeline::optimize_cvt(surface, cvt, workers, monitor);
  });
  if (sites.empty()) return {std::move(first.tessellation), true};
  sites = paper_stages(surface, std::move(sites), options, workers, clock);
  pipeline::Extraction extraction = clock.run("extraction", 0.4, 0.5, [&] {
    return pipeline::extract(surface, std::move(sites), workers, monitor);
  });
  return {{std::move(extraction.mesh), std::move(extraction.foot)}, false};
}

// The pipeline on one connected surface, with n vertices. `bvh` becomes the surface's.
mesh::EditableMesh remesh_part(const mesh::Surface& surface, spatial::TriangleBvh& bvh, Index n,
                               const RemeshOptions& options, const parallel::Workers& workers,
                               pipeline::StageClock& clock) {
  parallel::Monitor& monitor = clock.monitor();
  StartingMesh start = starting_mesh(surface, n, options, workers, clock);
  mesh::EditableMesh& mesh = start.tessellation.mesh;
  // Not earlier: the tessellation takes most of the memory.
  bvh = spatial::TriangleBvh(surface.vertices, surface.triangles, workers);
  // After a cancellation what there is goes out at once.
  if (options.method != Method::Default || monitor.cancelled()) return std::move(mesh);
  clock.run("valence", 0.5, 0.55, [&] {
    if (pipeline::is_coarse(surface, start.tessellation))
      pipeline::anneal_dislocations(surface, start.tessellation, options.seed,
                                    [&](double f) { return monitor.tick(0.5 * f); });
    return pipeline::optimize_valence(surface, bvh, mesh, workers, monitor);
  });
  clock.run("refinement", 0.55, 1, [&] {
    pipeline::RefinementOptions refinement = pipeline::refinement_options(options);
    refinement.settled = start.settled;
    return pipeline::refine(surface, bvh, mesh, refinement, workers, monitor);
  });
  return std::move(mesh);
}

// How the vertices of a part go on its creases and boundaries; nothing if it has none.
std::optional<pipeline::FeaturePlan> plan_part(const pipeline::Part& part, Index n,
                                               const RemeshOptions& options, RemeshResult& result) {
  if (part.features.empty()) return {};
  pipeline::FeaturePlan plan = pipeline::plan_features(part, n, options);
  result.creases_given_up += plan.given_up;
  if (plan.graph.curves.empty() && part.points.empty()) return {};
  return plan;
}

// Meshes a part with creases or boundaries; false if n vertices are too few to keep them apart and
// the options leave it to us whether they are kept.
bool remesh_featured(const pipeline::Part& part, const pipeline::FeaturePlan& plan, Index n,
                     const RemeshOptions& options, const parallel::Workers& workers,
                     pipeline::StageClock& clock, RemeshResult& result) {
  const pipeline::GluedMesh mesh =
      pipeline::remesh_features(part, plan, n, options, workers, clock);
  if (!mesh.mesh.triangles.empty()) {
    pipeline::append_part(part, plan.input, mesh, workers, result);
    return true;
  }
  if (options.boundary == Boundary::Freeze || !options.feature_edges.empty())
    throw TooFewVertices(
        fmt::format("{} vertices are too few to keep the features of the surface apart.", n),
        n + n / 4 + 1);
  ++result.parts_without_features;
  return false;
}

// All parts with the vertices they were given; a part that needs more says so in `least`, and the
// result is then incomplete. All are planned before any is meshed, since that is much cheaper.
bool remesh_parts(std::vector<pipeline::Part>& parts, const std::vector<Index>& vertices,
                  const RemeshOptions& options, const parallel::Workers& workers,
                  pipeline::StageClock& clock, RemeshResult& result) {
  bool complete = true;
  const auto ask = [&](std::size_t c, const auto& step) {
    try {
      step();
    } catch (const TooFewVertices& too_few) {
      parts[c].least = std::max(too_few.least(), vertices[c] + 1);
      complete = false;
    }
  };
  std::vector<std::optional<pipeline::FeaturePlan>> plans(parts.size());
  clock.begin_part(0, 0.01);
  const auto featured = [](const pipeline::Part& p) { return !p.features.empty(); };
  if (std::any_of(parts.begin(), parts.end(), featured))
    clock.run("features", 0, 1, [&] {
      for (std::size_t c = 0; c < parts.size(); ++c)
        ask(c, [&] { plans[c] = plan_part(parts[c], vertices[c], options, result); });
    });
  if (!complete) return false;

  const Index n = std::accumulate(vertices.begin(), vertices.end(), Index{0});
  double done = 0.01;
  for (std::size_t c = 0; c < parts.size(); ++c) {
    const double share = 0.96 * vertices[c] / n;
    clock.begin_part(done, done + share);
    done += share;
    ask(c, [&] {
      if (plans[c] &&
          remesh_featured(parts[c], *plans[c], vertices[c], options, workers, clock, result))
        return;
      plans[c].reset();
      pipeline::NormalizedInput input = pipeline::normalize(parts[c].mesh, vertices[c]);
      pipeline::set_sizes(parts[c].length, input);
      spatial::TriangleBvh bvh;
      const mesh::EditableMesh mesh =
          remesh_part(input.surface, bvh, vertices[c], options, workers, clock);
      if (complete) pipeline::append_part(parts[c], input, bvh, mesh, workers, result);
    });
  }
  return complete;
}

// Sets `least` of every part to a number of vertices that was tried and does.
void find_least_vertices(std::vector<pipeline::Part>& parts, const RemeshOptions& options,
                         const parallel::Workers& workers, pipeline::StageClock& clock) {
  for (pipeline::Part& part : parts) {
    for (bool enough = false; !enough;) {
      try {
        RemeshResult unused;
        const auto plan = plan_part(part, part.least, options, unused);
        if (plan && remesh_featured(part, *plan, part.least, options, workers, clock, unused))
          break;
        pipeline::NormalizedInput input = pipeline::normalize(part.mesh, part.least);
        pipeline::set_sizes(part.length, input);
        starting_mesh(input.surface, part.least, options, workers, clock);
        enough = true;
      } catch (const TooFewVertices& too_few) {
        part.least = std::max(too_few.least(), part.least + 1);
      }
    }
  }
}

void require_vertices(const std::vector<pipeline::Part>& parts, Index n) {
  const Index least = pipeline::least_vertices(parts);
  if (least > n)
    throw TooFewVertices(
        fmt::format("{} vertices are too few for the topology of this surface; the "
                    "least found to do is {}: ask for that many or more.",
                    n, least),
        least);
}

// The pipeline on all parts; options and input are fine, and there is no bound on the distance.
RemeshResult remesh_unbounded(const TriangleMesh& input, const RemeshOptions& options,
                              const Context& context) {
  const parallel::Workers workers(context.threads);
  std::vector<IterationRecord> history;
  parallel::Monitor monitor(context, options.history ? &history : nullptr);
  std::vector<StageTime> stages;
  pipeline::StageClock clock(monitor, stages);
  pipeline::SizeField field{{}, pipeline::vertex_budget(input, options)};
  if (options.sizing != Sizing::Uniform)
    field = clock.run("sizing", 0, 0.01, [&] {
      return pipeline::size_field(input, options, field.vertices, workers);
    });

  // Parts that turn out to need more vertices take them from the others, until all have enough or
  // there are no more to take.
  std::vector<pipeline::Part> parts = pipeline::connected_parts(input, field.length);
  pipeline::find_features(input, options, parts);
  RemeshResult result;
  bool searched = false;
  do {
    if (pipeline::least_vertices(parts) > field.vertices) {
      if (!searched) find_least_vertices(parts, options, workers, clock);
      searched = true;
      require_vertices(parts, field.vertices);
    }
    result = {};
  } while (!remesh_parts(parts, pipeline::share_vertices(parts, field.vertices), options, workers,
                         clock, result));

  clock.begin_part(0, 1);
  clock.run("certification", 0.97, 1, [&] { pipeline::certify_result(options, result); });
  result.size_ratio = pipeline::size_ratio(input, field, result);
  result.stages = std::move(stages);
  result.history = std::move(history);
  if (monitor.cancelled()) result.status = Status::Cancelled;
  return result;
}

}  // namespace

RemeshResult remesh(const TriangleMesh& input, const RemeshOptions& options,
                    const Context& context) {
  pipeline::check_options(options);
  pipeline::check_input(input, options.method);
  if (pipeline::error_bound(input, options) <= 0) return remesh_unbounded(input, options, context);
  return pipeline::remesh_within(input, options, context,
                                 [&](const RemeshOptions& with, const Context& within) {
                                   return remesh_unbounded(input, with, within);
                                 });
}

}  // namespace nonobtuse
