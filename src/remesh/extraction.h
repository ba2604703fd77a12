// From sites to a manifold mesh: the restricted Delaunay triangulation where its cells are discs,
// closed-ball repair for a few rounds, label-guided collapse as the guarantee.
#pragma once

#include <vector>

#include "mesh/editable_mesh.h"
#include "mesh/surface.h"
#include "parallel/monitor.h"
#include "parallel/workers.h"

namespace nonobtuse::pipeline {

enum class ExtractionRoute { Dual, Repaired, Collapsed };

struct Extraction {
  /// Exactly as many vertices as sites were given; components, Euler characteristic and boundary
  /// loops of the surface. With route Dual, vertex i is site i.
  mesh::EditableMesh mesh;
  std::vector<Index> foot;  ///< #V: facet of the surface under each vertex, on its own sheet
  ExtractionRoute route = ExtractionRoute::Dual;
};

/// Working coordinates. Throws TooFewVertices if the topology needs more vertices.
Extraction extract(const mesh::Surface& surface, std::vector<Vec3> sites,
                   const parallel::Workers& workers, parallel::Monitor& monitor);

/// Gives sites without a foot (-1: an empty cell) the facet nearest to them.
void complete_feet(const mesh::Surface& surface, const std::vector<Vec3>& sites,
                   std::vector<Index>& feet);

}  // namespace nonobtuse::pipeline
