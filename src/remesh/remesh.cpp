// The driver: calls the steps in order, on every connected component.
// Yan & Wonka, Non-obtuse Remeshing with Centroidal Voronoi Tessellation, TVCG 2016, section 4.2;
// docs/pipeline.md leads from the paper to the files.
#include "nonobtuse/remesh.h"

#include <fmt/format.h>

#include <utility>
#include <vector>

#include "parallel/monitor.h"
#include "parallel/workers.h"
#include "remesh/certification.h"
#include "remesh/error_bound.h"
#include "remesh/parts.h"
#include "remesh/parts_remeshing.h"
#include "remesh/request.h"
#include "remesh/size_field.h"
#include "remesh/stage_clock.h"

namespace nonobtuse {
namespace {

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
  pipeline::PartsRemesher remesher(parts, options, workers, clock);
  bool searched = false;
  do {
    if (pipeline::least_vertices(parts) > field.vertices) {
      if (!searched) pipeline::find_least_vertices(parts, options, workers, clock);
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
