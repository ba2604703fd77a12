// One connected surface without creases, boundaries or with the paper's methods: CVT, extraction,
// valence, refinement.
#pragma once

#include "mesh/editable_mesh.h"
#include "mesh/surface.h"
#include "nonobtuse/options.h"
#include "parallel/workers.h"
#include "remesh/mesh_tessellation.h"
#include "remesh/stage_clock.h"
#include "spatial/triangle_bvh.h"

namespace nonobtuse::pipeline {

struct StartingMesh {
  MeshOnSurface tessellation;
  bool settled = false;  ///< in its own shape energy
};

/// From a connected surface to its first mesh with n vertices: coarse to fine on meshes; or sites,
/// their optimisation, extraction. Throws TooFewVertices. Working coordinates.
StartingMesh starting_mesh(const mesh::Surface& surface, Index n, const RemeshOptions& options,
                           const parallel::Workers& workers, StageClock& clock);

/// The whole pipeline on a connected surface, with n vertices. `bvh` becomes the surface's. Throws
/// TooFewVertices. Working coordinates. After a cancellation the mesh as far as it came.
mesh::EditableMesh remesh_smooth(const mesh::Surface& surface, spatial::TriangleBvh& bvh, Index n,
                                 const RemeshOptions& options, const parallel::Workers& workers,
                                 StageClock& clock);

}  // namespace nonobtuse::pipeline
