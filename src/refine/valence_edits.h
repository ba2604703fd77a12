// Search for sequences of edits that remove a bad valence: flips that chase the defect, alone or
// after collapsing the vertex (valence too low) or splitting an edge at it (too high).
#pragma once

#include <vector>

#include "refine/patch.h"

namespace nonobtuse::refine {

struct ValenceSearch {
  int flips = 3;       ///< longest sequence of flips tried
  int solutions = 12;  ///< sequences kept at most
  int net = 0;         ///< change of the number of vertices: 0, -1 (collapse) or +1 (split)
  int splits = 0;  ///< with net = 0: edges opposite a boundary vertex of low valence that may be
                   ///< split, each a vertex more
};

/// Sequences of edits on `patch` that lower its total defect, the most regular first.
std::vector<std::vector<Edit>> search_valence_edits(const Patch& patch, Index bad_vertex,
                                                    const ValenceSearch& search);

/// Edits that change the number of vertices by `net` = +1 or -1 around `place` without raising
/// the total defect.
std::vector<std::vector<Edit>> search_balancing_edits(const Patch& patch, Index place, int net,
                                                      int solutions);

/// A knot less (net = -1) or more (+1) on the curve at v, with flips that restore the valences.
std::vector<std::vector<Edit>> search_curve_edits(const Patch& patch, Index v, int net,
                                                  int solutions);

/// The same to lower the total defect: a knot more on the edge of a curve opposite v, which has
/// too few neighbours.
std::vector<std::vector<Edit>> search_curve_splits(const Patch& patch, Index v, int solutions);

/// Flips around a triangle (of local vertices), with up to one more to restore the valences, that
/// do not raise the total defect.
std::vector<std::vector<Edit>> search_neutral_flips(const Patch& patch, const Triangle& around,
                                                    int solutions);

}  // namespace nonobtuse::refine
