// Lloyd's relaxation (Lloyd, Least squares quantization in PCM, 1982; Du, Faber, Gunzburger 1999).
#pragma once

#include <vector>

#include "rvd/cell_integrals.h"

namespace nonobtuse::optimize {

/// Moves every site to the centroid of its cell, `iterations` times; the energy never rises.
/// Returns the energy at the last evaluation, that is before the last move.
double lloyd(rvd::CellEvaluator& evaluator, std::vector<Vec3>& sites, int iterations);

}  // namespace nonobtuse::optimize
