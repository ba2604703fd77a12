// The last step: back to input coordinates, the exact certificates, and where every vertex lies on
// the input.
#pragma once

#include "mesh/editable_mesh.h"
#include "nonobtuse/options.h"
#include "nonobtuse/result.h"
#include "parallel/workers.h"
#include "remesh/normalization.h"

namespace nonobtuse::pipeline {

/// Fills mesh, certificates, angles, source_triangle and barycentric of a result, and its status
/// (Converged or AnglesRemain). The certificates speak of the input coordinates as returned.
void certify_result(const NormalizedInput& input, const mesh::EditableMesh& mesh,
                    const RemeshOptions& options, const parallel::Workers& workers,
                    RemeshResult& result);

}  // namespace nonobtuse::pipeline
