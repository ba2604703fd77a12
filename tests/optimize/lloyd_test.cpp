#include "optimize/lloyd.h"

#include <gtest/gtest.h>

#include "rvd/test_surfaces.h"

namespace nonobtuse::optimize {
namespace {

TEST(Lloyd, EnergyNeverRises) {
  const mesh::Surface sphere = rvd::test::octasphere(3);
  const parallel::Workers workers(1);
  std::vector<Vec3> sites = rvd::test::random_sites(sphere, 100, 1);
  rvd::CellEvaluator evaluator(sphere, 100, workers);
  double last = lloyd(evaluator, sites, 1);
  for (int k = 0; k < 20; ++k) {
    const double energy = lloyd(evaluator, sites, 1);
    EXPECT_LE(energy, last * (1 + 1e-13));
    last = energy;
  }
}

}  // namespace
}  // namespace nonobtuse::optimize
