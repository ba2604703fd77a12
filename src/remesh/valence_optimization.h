// Valence optimisation: no vertex with fewer than 5 or more than 7 neighbours, by edits that keep
// the number of vertices (Yan & Wonka 2016, section 4.2, with flips in place of resampling).
#pragma once

#include "mesh/curve_network.h"
#include "mesh/editable_mesh.h"
#include "mesh/surface.h"
#include "parallel/monitor.h"
#include "parallel/workers.h"
#include "spatial/triangle_bvh.h"

namespace nonobtuse::pipeline {

/// Brings every interior vertex to valence 5, 6 or 7, and boundary vertices to what the angle of
/// their sector asks for, by edits that keep the number of vertices and the topology, as far as it
/// can. With `curves` knots slide as in `refine`. Working coordinates (area / #V = 1); `bvh` is
/// that of the surface. Returns the number of bad valences left. After a cancellation the mesh is
/// valid, only not finished.
Index optimize_valence(const mesh::Surface& surface, const spatial::TriangleBvh& bvh,
                       mesh::EditableMesh& mesh, const parallel::Workers& workers,
                       parallel::Monitor& monitor, mesh::CurveNetwork* curves = nullptr);

}  // namespace nonobtuse::pipeline
