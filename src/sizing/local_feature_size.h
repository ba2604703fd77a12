// Local feature size: the distance of a point of the surface to the medial axis (Amenta, Bern,
// Surface reconstruction by Voronoi filtering, 1999), where the mesh must be fine to keep the
// shape.
#pragma once

#include <vector>

#include "mesh/surface.h"
#include "parallel/workers.h"

namespace nonobtuse::sizing {

/// Points of the medial axis, inside and outside, found from about `samples` points spread evenly
/// over the surface. Deterministic.
std::vector<Vec3> medial_points(const mesh::Surface& surface, Index samples,
                                const parallel::Workers& workers);

/// #V: distance of each vertex to the nearest medial point; infinite where there is no medial axis
/// (a plane). Working coordinates in, working lengths out. Needs no closed surface.
std::vector<double> local_feature_size(const mesh::Surface& surface, Index samples,
                                       const parallel::Workers& workers);

}  // namespace nonobtuse::sizing
