// The steps after the optimisation, and measuring: extraction, valence, refinement, certificate,
// distance.
#include <benchmark/benchmark.h>

#include "bench_input.h"
#include "nonobtuse/certificate.h"
#include "nonobtuse/context.h"
#include "nonobtuse/quality.h"
#include "parallel/monitor.h"
#include "parallel/workers.h"
#include "remesh/extraction.h"
#include "remesh/refinement.h"
#include "remesh/valence_optimization.h"

namespace nonobtuse::bench {
namespace {

// The mesh that extraction gives, and after valence optimisation, made once.
mesh::EditableMesh extracted(const parallel::Workers& workers, parallel::Monitor& monitor) {
  const BenchInput& input = bench_input();
  return pipeline::extract(input.surface, input.sites, workers, monitor).mesh;
}

void extraction(benchmark::State& state) {
  const parallel::Workers workers(static_cast<int>(state.range(0)));
  const Context context;
  parallel::Monitor monitor(context);
  for (auto _ : state) benchmark::DoNotOptimize(extracted(workers, monitor));
}
BENCHMARK(extraction)->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond)->UseRealTime();

void valence_optimization(benchmark::State& state) {
  const parallel::Workers workers(static_cast<int>(state.range(0)));
  const Context context;
  parallel::Monitor monitor(context);
  const mesh::EditableMesh start = extracted(workers, monitor);
  for (auto _ : state) {
    mesh::EditableMesh mesh = start;
    pipeline::optimize_valence(bench_input().surface, bench_input().bvh, mesh, workers, monitor);
  }
}
BENCHMARK(valence_optimization)->Arg(1)->Unit(benchmark::kMillisecond)->UseRealTime();

void refinement(benchmark::State& state) {
  const parallel::Workers workers(static_cast<int>(state.range(0)));
  const Context context;
  parallel::Monitor monitor(context);
  mesh::EditableMesh start = extracted(workers, monitor);
  pipeline::optimize_valence(bench_input().surface, bench_input().bvh, start, workers, monitor);
  for (auto _ : state) {
    mesh::EditableMesh mesh = start;
    pipeline::refine(bench_input().surface, bench_input().bvh, mesh, {}, workers, monitor);
  }
}
BENCHMARK(refinement)->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond)->UseRealTime();

void certificate(benchmark::State& state) {
  const TriangleMesh& mesh = bench_input().mesh;
  for (auto _ : state) benchmark::DoNotOptimize(certify(mesh));
}
BENCHMARK(certificate)->Unit(benchmark::kMillisecond);

void distance(benchmark::State& state) {
  const parallel::Workers workers(1);
  Context context;
  parallel::Monitor monitor(context);
  const mesh::EditableMesh mesh = extracted(workers, monitor);
  const BenchInput& input = bench_input();
  const TriangleMesh reference{input.surface.vertices, input.surface.triangles};
  const TriangleMesh result = mesh.to_mesh();
  context.threads = static_cast<int>(state.range(0));
  for (auto _ : state) benchmark::DoNotOptimize(measure_distance(result, reference, context));
}
BENCHMARK(distance)->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
}  // namespace nonobtuse::bench
