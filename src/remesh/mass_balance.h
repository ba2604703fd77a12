// Sites moved from cells with too little of the surface into cells with too much. A descent brings
// mass from cell to cell only, and takes dozens of evaluations to fill a finger through its neck.
#pragma once

#include <span>
#include <vector>

#include "nonobtuse/mesh.h"
#include "rvd/cell_integrals.h"

namespace nonobtuse::pipeline {

/// Splits cells of more than 3/2 of the mean mass, the heaviest first, at the cost of those of less
/// than the mean, the lightest first; every component keeps its number of sites. `component` (#X)
/// says which is whose. For uniform density. Evaluates once. Returns how many sites (#X by 3) have
/// moved into another cell. Deterministic, ties by index.
Index balance_masses(rvd::CellEvaluator& evaluator, std::span<const Index> component,
                     std::vector<Vec3>& sites);

}  // namespace nonobtuse::pipeline
