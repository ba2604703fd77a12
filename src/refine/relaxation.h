// Coloured Gauss-Seidel: vertices of one colour have no common triangle and move at once, each to
// the minimum of its ring's energy by Newton steps. For the few places where the global descent
// does not finish the job.
#pragma once

#include <vector>

#include "energy/mesh_shape.h"
#include "mesh/editable_mesh.h"
#include "parallel/workers.h"
#include "refine/fidelity.h"

namespace nonobtuse::refine {

struct RelaxationOptions {
  energy::ShapeWeights shape;
  int passes = 1;           ///< over all vertices given
  bool on_surface = false;  ///< move in the tangent plane and put vertices back onto the surface
};

/// Energy of everything that depends on vertex v, if it lay at p; adds to `gradient`.
double ring_energy(const mesh::EditableMesh& mesh, const Fidelity& fidelity,
                   const energy::ShapeWeights& shape, Index v, const Vec3& p, Vec3* gradient);

/// Relaxes the given vertices (fixed where on the boundary); of a knot that slides all copies, if
/// one is given, along its curve. The energy never rises. Same bytes for any number of threads.
/// Feet of the vertices are updated, samples are not.
void relax(mesh::EditableMesh& mesh, Fidelity& fidelity, const std::vector<Index>& vertices,
           const RelaxationOptions& options, const parallel::Workers& workers);

}  // namespace nonobtuse::refine
