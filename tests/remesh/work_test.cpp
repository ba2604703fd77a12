// A guard of the speed that cannot flake: it counts work, which is the same on every machine, and
// no seconds. A bound is about a fifth above what was counted; who makes a change that is worth
// more work writes the new count here, who saves work lowers it.
#include <gtest/gtest.h>

#include "nonobtuse/remesh.h"
#include "nonobtuse/sample.h"
#include "remesh/cvt_optimization.h"
#include "remesh/first_mesh.h"
#include "remesh/initial_sampling.h"
#include "remesh/normalization.h"
#include "rvd/cell_integrals.h"

namespace nonobtuse::pipeline {
namespace {

constexpr Index kSites = 2000;

TEST(Work, EvaluationsOfTheCvtEnergyAreFew) {
  const mesh::Surface surface = normalize(sample_surface(32), kSites).surface;
  int ticks = 0;  // one for each evaluation after the first of each of the two levels
  Context context;
  context.progress = [&](const Progress&) {
    ++ticks;
    return true;
  };
  parallel::Monitor monitor(context);
  optimize_cvt(surface, {.sites = kSites}, parallel::Workers(1), monitor);
  EXPECT_LE(ticks, 54) << "counted when the bound was set: 45";
}

// On a surface that a quarter of the vertices resolves, no evaluation takes place with all sites.
TEST(Work, TheFirstMeshTakesFewSteps) {
  const mesh::Surface surface = normalize(sample_surface(32), kSites).surface;
  int ticks = 0;  // evaluations of the coarse cells, blocks of steps on the meshes
  Context context;
  context.progress = [&](const Progress&) {
    ++ticks;
    return true;
  };
  parallel::Monitor monitor(context);
  const FirstMesh first = first_mesh(surface, {.sites = kSites}, parallel::Workers(1), monitor);
  EXPECT_EQ(first.tessellation.mesh.vertex_count(), kSites);
  EXPECT_LE(ticks, 56) << "counted when the bound was set: 47";
}

TEST(Work, CandidateListsAreReused) {
  const mesh::Surface surface = normalize(sample_surface(32), kSites).surface;
  const parallel::Workers workers(1);
  const Components components = connected_components(surface);
  std::vector<Vec3> sites = sample_strata(surface, components, {kSites}, 1).points;
  rvd::CellEvaluator evaluator(surface, kSites, workers);
  minimize_cvt(evaluator, sites, 30, 0, workers, {});
  const rvd::CellEvaluator::Statistics work = evaluator.statistics();
  EXPECT_EQ(work.evaluations, 30);
  // Pieces of facets, and how many of them had their list of candidates renewed.
  EXPECT_LE(work.pieces / work.evaluations,
            static_cast<long long>(1.3 * static_cast<double>(surface.triangles.size())));
  EXPECT_LE(static_cast<double>(work.relisted), 0.61 * static_cast<double>(work.pieces))
      << "counted when the bound was set: 0.51";
}

}  // namespace
}  // namespace nonobtuse::pipeline
