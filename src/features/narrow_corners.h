// Corners at which two feature curves leave less than 30 degrees between them: no mesh has larger
// angles there. One triangle fills such a corner best, with two equal long sides on the curves; the
// sizes beside it then grow from its short side, instead of shrinking down to the corner.
#pragma once

#include <vector>

#include "features/feature_edges.h"
#include "features/feature_graph.h"
#include "mesh/surface.h"

namespace nonobtuse::features {

/// The edge along a feature curve from a narrow corner: of one segment in every mesh.
struct FirstEdge {
  Index corner = 0, end = 0;  ///< vertices of the surface, both corners of the graph
};

/// On every curve that bounds a narrow sector of the surface puts a vertex, if there is none, and
/// marks it as a corner in `graph` (whose curves are then no longer complete: build it anew). The
/// first edges of one corner are equally long: `reach` (working units, times the local size), or
/// less where curves are short. Sectors at curves with `held` vertices (#curves, or empty) stay as
/// they are. New vertices come after those of the surface. In order of corners.
std::vector<FirstEdge> settle_narrow_corners(mesh::Surface& surface, EdgeFlags& flags,
                                             FeatureGraph& graph, double reach,
                                             const std::vector<char>& held);

/// #V: 1 for vertices of the curves that go on from first edges, up to `reach` (working units) from
/// the corner; 2 on first edges, without their outer ends.
std::vector<char> narrow_corner_marks(const mesh::Surface& surface, const FeatureGraph& graph,
                                      const std::vector<FirstEdge>& edges, double reach);

}  // namespace nonobtuse::features
