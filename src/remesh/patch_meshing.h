// The first mesh of one patch: a surface bounded by feature curves on which the boundary vertices
// (knots) are settled. Centroidal Voronoi tessellation of the interior with the knots held still,
// then label-guided collapse with the boundary prescribed.
#pragma once

#include <cstdint>
#include <vector>

#include "mesh/editable_mesh.h"
#include "mesh/surface.h"
#include "parallel/monitor.h"
#include "parallel/workers.h"

namespace nonobtuse::pipeline {

struct Patch {
  mesh::Surface surface;     ///< cut open: a vertex on features once per sector
  std::vector<Index> facet;  ///< #F: facet of the whole cut surface
  std::vector<Index> knot;   ///< #V: which knot a vertex is, -1 for none
  Index euler = 1;
  Index interior = 0;  ///< vertices it is to have besides the knots
};

struct PatchMesh {
  /// Its boundary runs through all copies of the knots, in order and in place; `mesh.knot` names
  /// them. May have more interior vertices than asked for where the topology needs them.
  mesh::EditableMesh mesh;
  std::vector<Index> foot;  ///< #V: facet of the patch under each vertex
};

/// `coarse` (#knots of all patches): 1 for those that already take part in the coarse tessellation,
/// about every second one. Working coordinates. Same bits for any number of threads.
PatchMesh mesh_patch(const Patch& patch, const std::vector<char>& coarse, std::uint64_t seed,
                     const parallel::Workers& workers, parallel::Monitor& monitor);

}  // namespace nonobtuse::pipeline
