// Corners at which no mesh keeps the promise: face angles below 30 degrees, and vertices of a
// frozen boundary whose edges leave no room for good triangles.
#pragma once

#include <vector>

#include "features/knot_insertion.h"
#include "mesh/curve_network.h"
#include "mesh/editable_mesh.h"
#include "nonobtuse/result.h"

namespace nonobtuse::pipeline {

/// The largest ratio of the lengths of two edges that bound a sector of so many degrees, cut into
/// triangles with all angles inside [30, 90] by a degree; 0 where no number of them fits. Of one
/// triangle with angles a at the corner, b and c: sin b / sin c; of several: the product.
double largest_length_ratio(double degrees);

/// Sectors of the surface at fixed knots with a face angle below 30 degrees. `vertex` is the knot.
std::vector<NarrowCorner> narrow_sectors(const features::CutSurface& cut,
                                         const mesh::CurveNetwork& network);

/// Fixed knots of a mesh that keeps its boundary: where the lengths of the edges on both sides of a
/// sector differ by more than any triangles between them allow; and both ends of edges that face
/// another vertex of the boundary so near that it lies in every triangle with angles above 30
/// degrees beside them. One entry per knot; `vertex` is the knot.
std::vector<NarrowCorner> frozen_corners(const mesh::EditableMesh& mesh,
                                         const mesh::CurveNetwork& network);

}  // namespace nonobtuse::pipeline
