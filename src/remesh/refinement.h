// Refinement on the triangle mesh (no Voronoi diagram): shape, angle bounds and two-sided distance
// together, then local sweeps on the last bad triangles.
#pragma once

#include "mesh/curve_network.h"
#include "mesh/editable_mesh.h"
#include "mesh/surface.h"
#include "parallel/monitor.h"
#include "parallel/workers.h"
#include "spatial/triangle_bvh.h"

namespace nonobtuse::pipeline {

struct RefinementOptions {
  double min_angle = 40;  ///< degrees, bounds to reach; [46, 74] is possible on smooth surfaces
  double max_angle = 80;
  bool on_surface = false;  ///< keep vertices on the surface
  bool settled = false;     ///< the mesh rests in its own shape energy already: fewer first steps
};

/// Moves vertices, flips edges and, where nothing else helps, collapses one edge and splits
/// another, until every angle is inside the bounds or nothing helps any more. Keeps the number of
/// vertices and the topology; boundary vertices stay where they are. With `curves` those that have
/// a knot (surface and mesh are cut along the curves, see EditableMesh::knot) slide along their
/// curve if they may, all copies of a knot together; their arcs are updated there. Working
/// coordinates (area / #V = 1); `bvh` is that of the surface. Returns the number of triangles left
/// outside. After a cancellation the mesh is valid, only not finished.
Index refine(const mesh::Surface& surface, const spatial::TriangleBvh& bvh,
             mesh::EditableMesh& mesh, const RefinementOptions& options,
             const parallel::Workers& workers, parallel::Monitor& monitor,
             mesh::CurveNetwork* curves = nullptr);

}  // namespace nonobtuse::pipeline
