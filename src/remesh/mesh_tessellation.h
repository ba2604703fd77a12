// Centroidal tessellation on the mesh: what the Voronoi cells of a triangulation's vertices cost is
// known from the triangles alone, as long as they are Delaunay, and an evaluation takes a fraction
// of what cutting the surface into cells takes.
#pragma once

#include <functional>
#include <vector>

#include "mesh/editable_mesh.h"
#include "mesh/surface.h"
#include "parallel/workers.h"

namespace nonobtuse::pipeline {

/// A closed triangulation with its vertices on the surface.
struct MeshOnSurface {
  mesh::EditableMesh mesh;  ///< compact
  std::vector<Index> foot;  ///< #V: the facet under each vertex
};

/// How to descend.
struct MeshDescentOptions {
  int steps = 30;
  /// Steps between two rounds of Delaunay flips. Without the circumcentre term no more than two:
  /// the energy of triangles that are not Delaunay has no lower bound.
  int steps_between_flips = 2;
  /// Weight of the squared distance of circumcentre and incentre: with it the connectivity sets.
  double circumcentre = 0;
};

/// Lowers the CVT energy (Eq. 1, on the mesh's own triangles, weighted by what the surface has more
/// area than they) by L-BFGS; vertices slide in their tangent planes and are put back onto the
/// surface. Between steps Delaunay flips, and now and then flips that mend valences. Asks
/// `keep_going` between blocks of steps. Deterministic for any number of threads.
void minimize_on_mesh(const mesh::Surface& surface, MeshOnSurface& tessellation,
                      const MeshDescentOptions& options, const parallel::Workers& workers,
                      const std::function<bool()>& keep_going);

/// How badly the mesh cuts off tips and fingers: over all vertices the largest factor by which the
/// triangles around it would gain area if the middles of their edges lay on the surface; >= 1.
double largest_area_ratio(const mesh::Surface& surface, const MeshOnSurface& tessellation,
                          const parallel::Workers& workers);

/// Spreads out the vertices around triangles that turn against the surface at their corners' feet,
/// a few rounds. Returns how many such triangles are left.
Index unfold(const mesh::Surface& surface, MeshOnSurface& tessellation);

}  // namespace nonobtuse::pipeline
