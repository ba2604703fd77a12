// The curves that feature edges form, between the corners in which they end or meet.
#pragma once

#include <vector>

#include "features/feature_edges.h"
#include "mesh/surface.h"

namespace nonobtuse::features {

/// A chain of feature edges from corner to corner, or closed and free of corners.
struct FeatureCurve {
  std::vector<Index> vertices;  ///< of the surface, in order; closed: the first is not repeated
  bool closed = false;
  Index facets = 2;       ///< at each of its edges, all alike: 1 at a boundary, 3 or more where
                          ///< patches meet
  bool boundary = false;  ///< of edges with one facet
};

struct FeatureGraph {
  std::vector<char> corner;  ///< #V: 1 where curves end or meet, turn sharply, or on request
  std::vector<FeatureCurve> curves;

  [[nodiscard]] Index corner_count() const;
};

/// Vertices of any number of feature edges other than two are corners, and so are those marked in
/// `corner` (#V) that lie on a feature edge. Curves in order of their first vertex's index.
FeatureGraph feature_graph(const mesh::Surface& surface, const EdgeFlags& flags,
                           std::vector<char> corner);

/// Marks the vertices at which a curve turns sharply, seen at the scale of the target edge length
/// `h` (working units, times the size of the surface), and one vertex wherever a side of the
/// bounding box touches the surface only along curves. Returns the marks (#V), without corners.
std::vector<char> sharp_turns(const mesh::Surface& surface, const FeatureGraph& graph, double h);

/// Takes the flags off creases that end in the surface and are shorter than `shortest` (times the
/// local size), until there are none. Edges that have not two facets stay. Returns whether any
/// went.
bool prune_creases(const mesh::Surface& surface, double shortest, EdgeFlags& flags);

/// Lengths along a curve: arc (from its first vertex, working units) and the same in the sizing
/// metric, ds / size. #P + 1 entries each; the last is the whole length (of a closed curve with
/// the edge that closes it; for an open one the last is repeated once).
struct CurveLengths {
  std::vector<double> arc;
  std::vector<double> metric;
};
CurveLengths curve_lengths(const mesh::Surface& surface, const FeatureCurve& curve);

}  // namespace nonobtuse::features
