// Circumcentre term over the triangles of a restricted Delaunay triangulation: Sieger, Alliez,
// Botsch, Optimizing Voronoi diagrams for polygonal finite element computations, 2010. Pulls every
// circumcentre into its triangle, so that dual edges stay long on both sides of every edge.
#pragma once

#include <span>

#include "nonobtuse/mesh.h"

namespace nonobtuse::energy {

/// Returns scale * sum over triangles of |circumcentre - incentre|^2 and adds its gradient and a
/// positive stand-in for the diagonal of its second derivatives, 2 scale min(20, 1 + Rc / (2 ri)) a
/// corner, to `gradient` (#X) and `diagonal` (#X). Triangles with a zero edge are left out. For the
/// units of Eq. 1 let scale = weight * area / #X; weight 1 gives angles of about [41, 80].
double add_circumcentre_term(std::span<const Vec3> sites, std::span<const Triangle> triangles,
                             double scale, std::span<Vec3> gradient, std::span<double> diagonal);

}  // namespace nonobtuse::energy
