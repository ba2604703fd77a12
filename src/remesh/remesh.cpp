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

// What a part became with the vertices it was given; kept while other parts ask for more.
struct PartResult {
  Index planned = -1;  // for this many vertices
  std::optional<pipeline::FeaturePlan> plan;
  Index meshed = -1;  // with this many vertices
  RemeshResult result;
};

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

// All parts with the vertices they were given. Small parts come first: one that needs more says so
// in its `least`, and those that give them, the large parts, wait until all others have enough.
class PartsRemesher {
 public:
  PartsRemesher(std::vector<pipeline::Part>& parts, const RemeshOptions& options,
                const parallel::Workers& workers, pipeline::StageClock& clock)
      : parts_(parts),
        options_(options),
        workers_(workers),
        clock_(clock),
        results_(parts.size()) {}

  // False if a part needs more.
  bool run(const std::vector<Index>& vertices) {
    whole_ = std::accumulate(vertices.begin(), vertices.end(), Index{0});
    done_ = 0;
    std::vector<std::size_t> small, large;
    for (std::size_t c = 0; c < parts_.size(); ++c)
      (vertices[c] > kLargePart * whole_ ? large : small).push_back(c);
    return run(small, vertices) && run(large, vertices);
  }

  // Of all parts, in their order.
  RemeshResult take() {
    if (results_.size() == 1) return std::move(results_.front().result);
    RemeshResult whole;
    for (PartResult& part : results_) append_result(std::move(part.result), whole);
    return whole;
  }

 private:
  // All are planned before any is meshed, since that is much cheaper.
  bool run(const std::vector<std::size_t>& some, const std::vector<Index>& vertices) {
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

  void begin(double share) {
    clock_.begin_part(done_, done_ + share);
    done_ += share;
  }

  void plan(std::size_t c, Index n) {
    PartResult& part = results_[c];
    if (part.planned == n) return;
    part = {};
    part.plan = plan_part(parts_[c], n, options_, part.result);
    part.planned = n;
  }

  void mesh(std::size_t c, Index n) {
    PartResult& part = results_[c];
    if (part.meshed == n) return;
    if (!part.plan ||
        !remesh_featured(parts_[c], *part.plan, n, options_, workers_, clock_, part.result)) {
      part.plan.reset();
      pipeline::NormalizedInput input = pipeline::normalize(parts_[c].mesh, n);
      pipeline::set_sizes(parts_[c].length, input);
      spatial::TriangleBvh bvh;
      const mesh::EditableMesh mesh =
          remesh_part(input.surface, bvh, n, options_, workers_, clock_);
      pipeline::append_part(parts_[c], input, bvh, mesh, workers_, part.result);
    }
    part.plan.reset();
    part.meshed = n;
  }

  static constexpr double kLargePart = 0.1;  // of all vertices

  std::vector<pipeline::Part>& parts_;
  const RemeshOptions& options_;
  const parallel::Workers& workers_;
  pipeline::StageClock& clock_;
  std::vector<PartResult> results_;
  Index whole_ = 0;  // vertices
  double done_ = 0;
};

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
  PartsRemesher remesher(parts, options, workers, clock);
  bool searched = false;
  do {
    if (pipeline::least_vertices(parts) > field.vertices) {
      if (!searched) find_least_vertices(parts, options, workers, clock);
      searched = true;
      require_vertices(parts, field.vertices);
    }
  } while (!remesher.run(pipeline::share_vertices(parts, field.vertices)));
  RemeshResult result = remesher.take();

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
