#include "bench_input.h"

#include <cstdlib>
#include <string>

#include "nonobtuse/context.h"
#include "nonobtuse/io.h"
#include "nonobtuse/sample.h"
#include "parallel/monitor.h"
#include "parallel/workers.h"
#include "remesh/cvt_optimization.h"
#include "remesh/normalization.h"

namespace nonobtuse::bench {

const BenchInput& bench_input() {
  static const BenchInput input = [] {
    const char* model = std::getenv("NONOBTUSE_BENCH_MODEL");
    const char* vertices = std::getenv("NONOBTUSE_BENCH_VERTICES");
    const Index n = vertices != nullptr ? std::atoi(vertices) : 8000;
    BenchInput made;
    made.mesh = model != nullptr ? clean(read_mesh(model).mesh).mesh : sample_surface(64);
    made.surface = pipeline::normalize(made.mesh, n).surface;
    const Context context;
    parallel::Monitor monitor(context);
    const parallel::Workers workers(1);
    made.bvh = spatial::TriangleBvh(made.surface.vertices, made.surface.triangles, workers);
    made.sites = pipeline::optimize_cvt(made.surface, {.sites = n}, workers, monitor);
    return made;
  }();
  return input;
}

}  // namespace nonobtuse::bench
