// The last step: back to input coordinates, the exact certificates, and where every vertex lies on
// the input.
#pragma once

#include "mesh/editable_mesh.h"
#include "nonobtuse/options.h"
#include "nonobtuse/result.h"
#include "parallel/workers.h"
#include "remesh/featured_part.h"
#include "remesh/normalization.h"
#include "remesh/parts.h"
#include "spatial/triangle_bvh.h"

namespace nonobtuse::pipeline {

/// Appends the mesh of one part, in input coordinates, with source_triangle and barycentric; `bvh`
/// is that of the input's surface.
void append_part(const Part& part, const NormalizedInput& input, const spatial::TriangleBvh& bvh,
                 const mesh::EditableMesh& mesh, const parallel::Workers& workers,
                 RemeshResult& result);

/// The same for a part with features. Vertices with a source get its very coordinates.
void append_part(const Part& part, const NormalizedInput& input, const GluedMesh& glued,
                 const parallel::Workers& workers, RemeshResult& result);

/// Fills certificates and angles of a finished mesh, and its status (Converged or AnglesRemain).
/// The certificates speak of the coordinates as returned.
void certify_result(const RemeshOptions& options, RemeshResult& result);

}  // namespace nonobtuse::pipeline
