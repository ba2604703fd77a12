#include "optimize/lloyd.h"

namespace nonobtuse::optimize {

double lloyd(rvd::CellEvaluator& evaluator, std::vector<Vec3>& sites, int iterations) {
  rvd::CellIntegrals cells;
  for (int k = 0; k < iterations; ++k) {
    evaluator.evaluate(sites, cells);
    sites = cells.centroid;
  }
  return cells.energy;
}

}  // namespace nonobtuse::optimize
