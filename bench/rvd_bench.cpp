// Restricted Voronoi diagram: candidate lists, floating-point cells, exact combinatorics, gradient.
#include <benchmark/benchmark.h>

#include <cstdint>
#include <vector>

#include "bench_input.h"
#include "energy/cvt.h"
#include "numeric/random.h"
#include "numeric/vec3.h"
#include "parallel/workers.h"
#include "rvd/candidate_lists.h"
#include "rvd/cell_integrals.h"
#include "rvd/restricted_voronoi.h"

namespace nonobtuse::bench {
namespace {

void candidate_lists(benchmark::State& state) {
  const BenchInput& input = bench_input();
  const parallel::Workers workers(static_cast<int>(state.range(0)));
  for (auto _ : state)
    benchmark::DoNotOptimize(rvd::facet_candidates(input.surface, input.sites, workers));
}
BENCHMARK(candidate_lists)->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond)->UseRealTime();

// `range(1)`: steps of the sites between evaluations, in thousandths of their distance.
void cell_integrals(benchmark::State& state) {
  const BenchInput& input = bench_input();
  const parallel::Workers workers(static_cast<int>(state.range(0)));
  const double step = 1e-3 * static_cast<double>(state.range(1));
  rvd::CellEvaluator evaluator(input.surface, static_cast<Index>(input.sites.size()), workers);
  rvd::CellIntegrals cells;
  std::vector<Vec3> sites = input.sites;
  std::uint64_t round = 0;
  for (auto _ : state) {
    state.PauseTiming();
    numeric::Random random(++round);
    for (std::size_t i = 0; i < sites.size(); ++i)
      sites[i] = input.sites[i] + step * Vec3{random.uniform(), random.uniform(), random.uniform()};
    state.ResumeTiming();
    evaluator.evaluate(sites, cells);
  }
}
BENCHMARK(cell_integrals)
    ->Args({1, 0})
    ->Args({1, 10})
    ->Args({1, 100})
    ->Args({2, 10})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

void cvt_gradient(benchmark::State& state) {
  const BenchInput& input = bench_input();
  const parallel::Workers workers(1);
  rvd::CellEvaluator evaluator(input.surface, static_cast<Index>(input.sites.size()), workers);
  rvd::CellIntegrals cells;
  evaluator.evaluate(input.sites, cells);
  std::vector<Vec3> gradient(input.sites.size());
  for (auto _ : state) {
    energy::cvt_gradient(input.sites, cells, gradient, workers);
    benchmark::DoNotOptimize(gradient.data());
  }
}
BENCHMARK(cvt_gradient)->Unit(benchmark::kMillisecond);

void restricted_voronoi(benchmark::State& state) {
  const BenchInput& input = bench_input();
  const parallel::Workers workers(static_cast<int>(state.range(0)));
  const rvd::FacetCandidates candidates =
      rvd::facet_candidates(input.surface, input.sites, workers);
  for (auto _ : state)
    benchmark::DoNotOptimize(
        rvd::restricted_voronoi(input.surface, input.sites, candidates, workers));
}
BENCHMARK(restricted_voronoi)->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
}  // namespace nonobtuse::bench
