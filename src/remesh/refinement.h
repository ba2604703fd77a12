// Refinement on the triangle mesh (no Voronoi diagram): shape, angle bounds and two-sided distance
// together, then local sweeps on the last bad triangles.
#pragma once

#include <vector>

#include "mesh/editable_mesh.h"
#include "mesh/surface.h"
#include "parallel/monitor.h"
#include "parallel/workers.h"

namespace nonobtuse::remesh {

struct RefinementOptions {
  double min_angle = 40;  ///< degrees, bounds to reach
  double max_angle = 80;
  bool on_surface = false;  ///< keep vertices on the surface
};

/// Brings every vertex to valence 5, 6 or 7 by edits that keep the number of vertices and the
/// topology, as far as it can. Returns the number of bad valences left.
Index optimize_valence(const mesh::Surface& surface, mesh::EditableMesh& mesh,
                       const parallel::Workers& workers, parallel::Monitor& monitor);

/// Moves vertices and flips edges until every angle is inside the bounds, or nothing helps any
/// more. Returns the number of triangles left outside.
Index refine(const mesh::Surface& surface, mesh::EditableMesh& mesh,
             const RefinementOptions& options, const parallel::Workers& workers,
             parallel::Monitor& monitor);

}  // namespace nonobtuse::remesh
