// Where feature curves come near each other, or bend within an edge length, edges must be shorter:
// a side of a smooth curve needs two interior neighbours, so that a strip between two curves needs
// at least one row of interior vertices.
#pragma once

#include <vector>

#include "features/feature_edges.h"
#include "features/feature_graph.h"
#include "mesh/surface.h"

namespace nonobtuse::features {

/// #V: the longest target edge length (working units) that the features allow at a vertex, infinite
/// where they do not matter at edge lengths of `h`. 0.7 w on both sides of a patch that is w wide
/// there; if `frugal`, w between two closed curves, where a strip can do without inner vertices (of
/// pairs of points, along straight lines into the patch; not of two curves that part from each
/// other in a corner), and what gives short curves one segment, closed ones six. Only vertices on
/// features get a bound; they should be less than h / 2 apart. `marks` (#V, or empty) as
/// narrow_corner_marks gives them: between vertices marked 1 the bound is w, too, and those marked
/// 2 are bounded by no width.
std::vector<double> narrow_places(const mesh::Surface& surface, const EdgeFlags& flags,
                                  const FeatureGraph& graph, double h, bool frugal = false,
                                  const std::vector<char>& marks = {});

/// Makes one of features nearer to each other than `width` (working units): takes the flags off
/// parts of curves that face others across a narrower strip, and off the whole curve if they are
/// most of it; of two curves that with the lower integral of 1 - cos(turn of the normal) yields.
/// Not off boundaries and curves where patches meet. Returns whether any went.
bool merge_close_curves(const mesh::Surface& surface, const FeatureGraph& graph, double width,
                        EdgeFlags& flags);

}  // namespace nonobtuse::features
