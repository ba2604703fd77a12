// One-sided distance from a surface to another, sampled.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "nonobtuse/mesh.h"
#include "parallel/workers.h"
#include "spatial/triangle_bvh.h"

namespace nonobtuse::quality {

struct OneSidedDistance {
  double max = 0;  ///< over area-uniform samples and all vertices
  double rms = 0;  ///< over the area-uniform samples
};

/// The largest distance seen at one triangle, and the triangle of the target nearest there (-1:
/// no samples).
struct TriangleDistance {
  double distance = 0;
  Index nearest = -1;
};

/// Distance from the surface of `mesh` to the one in `target`. About `samples` points, as many on a
/// triangle as its area deserves, to within one; stratified inside of it, drawn from a stream of
/// its own, so that the result is the same for any number of threads. `order` lists the triangles
/// so that neighbours follow each other (that of a BVH does): it makes the search fast, and the
/// carry of fractions of samples from one triangle to the next local. With `by_triangle` also the
/// largest distance of every triangle (#F), each vertex counting for one of its triangles.
OneSidedDistance one_sided_distance(const TriangleMesh& mesh, std::span<const Index> order,
                                    const spatial::TriangleBvh& target, std::size_t samples,
                                    const parallel::Workers& workers,
                                    std::vector<TriangleDistance>* by_triangle = nullptr);

/// Samples that `measure` takes on each side: 10 for every vertex of the larger mesh, at least
/// 200 000.
std::size_t default_samples(const TriangleMesh& a, const TriangleMesh& b);

/// Number of triangles whose normal is more than 90 degrees off the reference's at the point
/// nearest to their centroid: both its facet's and the interpolated vertex normals', so that a
/// facet of the reference that is itself turned over between its neighbours accuses nobody.
Index count_flipped(const TriangleMesh& mesh, const TriangleMesh& reference,
                    const spatial::TriangleBvh& reference_bvh, const parallel::Workers& workers);

}  // namespace nonobtuse::quality
