// Flips towards the intrinsic Delaunay property on a triangle mesh, under the link check.
#pragma once

#include <vector>

#include "mesh/editable_mesh.h"
#include "mesh/surface.h"

namespace nonobtuse::rdt {

/// Flips every edge whose opposite angles sum to more than 180 degrees, unless a new triangle would
/// turn against the surface at its corners' feet (`foot`: #V facets) or fold the mesh more than
/// before and more than 60 degrees. At most `sweeps` passes over the edges, since the geometric
/// vetoes break the usual argument of termination. Returns the number of flips.
Index delaunay_flips(const mesh::Surface& surface, const std::vector<Index>& foot,
                     mesh::EditableMesh& mesh, int sweeps = 20);

/// Unit normal of the surface for a triangle: mean of the normals at its corners' feet.
Vec3 reference_normal(const mesh::Surface& surface, const std::vector<Index>& foot,
                      const Triangle& t);

}  // namespace nonobtuse::rdt
