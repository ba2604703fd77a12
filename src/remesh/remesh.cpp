// The driver: calls the steps in order, nothing else.
// Yan & Wonka, Non-obtuse Remeshing with Centroidal Voronoi Tessellation, TVCG 2016, section 4.2;
// the obtuse removal is replaced by refinement on the mesh (docs/pipeline.md).
#include "nonobtuse/remesh.h"

#include <chrono>
#include <string>
#include <utility>
#include <vector>

#include "nonobtuse/io.h"
#include "parallel/monitor.h"
#include "parallel/workers.h"
#include "remesh/certification.h"
#include "remesh/cvt_optimization.h"
#include "remesh/extraction.h"
#include "remesh/normalization.h"
#include "remesh/paper_method.h"
#include "remesh/refinement.h"
#include "remesh/request.h"
#include "remesh/valence_optimization.h"

namespace nonobtuse {

namespace {

// Runs one step, with its share of the progress, and notes its time.
template <class Step>
auto run_stage(const char* name, double from, double to, parallel::Monitor& monitor,
               RemeshResult& result, const Step& step) {
  struct Timer {
    const char* name;
    RemeshResult& result;
    std::chrono::steady_clock::time_point start = std::chrono::steady_clock::now();
    ~Timer() {
      const std::chrono::duration<double> d = std::chrono::steady_clock::now() - start;
      result.stages.push_back({name, d.count()});
    }
  };
  monitor.begin_stage(name, from, to);
  const Timer timer{name, result};
  return step();
}

}  // namespace

RemeshResult remesh(const TriangleMesh& input, const RemeshOptions& options,
                    const Context& context) {
  pipeline::check_options(options);
  pipeline::check_input(input);
  const Index n = pipeline::vertex_budget(input, options);
  const parallel::Workers workers(context.threads);
  parallel::Monitor monitor(context);
  RemeshResult result;

  const pipeline::NormalizedInput normalized = pipeline::normalize(input, n);
  const mesh::Surface& surface = normalized.surface;
  std::vector<Vec3> sites = run_stage("cvt", 0, 0.4, monitor, result, [&] {
    return pipeline::optimize_cvt(surface, {.sites = n, .seed = options.seed}, workers, monitor);
  });
  if (options.method == Method::CvtNob)
    sites = run_stage("obtuse removal", 0.1, 0.9, monitor, result, [&] {
      return pipeline::optimize_paper_nob(surface, std::move(sites),
                                          {.short_dual = options.penalty, .seed = options.seed},
                                          workers, monitor);
    });
  pipeline::Extraction extraction = run_stage("extraction", 0.4, 0.5, monitor, result, [&] {
    return pipeline::extract(surface, std::move(sites), workers, monitor);
  });
  mesh::EditableMesh& mesh = extraction.mesh;
  if (options.method == Method::Default) {
    run_stage("valence", 0.5, 0.55, monitor, result,
              [&] { return pipeline::optimize_valence(surface, mesh, workers, monitor); });
    run_stage("refinement", 0.55, 0.95, monitor, result, [&] {
      return pipeline::refine(surface, mesh, pipeline::refinement_options(options), workers,
                              monitor);
    });
  }
  run_stage("certification", 0.95, 1, monitor, result, [&] {
    pipeline::certify_result(normalized, mesh, options, workers, result);
    return 0;
  });
  if (monitor.cancelled()) result.status = Status::Cancelled;
  return result;
}

}  // namespace nonobtuse
