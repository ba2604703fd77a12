// Bad valences (see ValenceRule) one by one: flips, flip sequences, and pairs of edits that keep
// the number of vertices (collapse a vertex of low valence here, split an edge there, or the
// reverse).
#pragma once

#include <functional>

#include "refine/trials.h"

namespace nonobtuse::refine {

/// Mends what it can; every accepted edit lowers the total defect and turns no triangle over.
/// `strict`: nor may more triangles leave the promise. `keep_going` is asked for every attempt.
/// Planes of vertices and triangles without a facet are searched as needed. Returns the number of
/// vertices whose valence stays bad.
Index mend_valences(mesh::EditableMesh& mesh, Fidelity& fidelity, const TrialOptions& options,
                    bool strict, const parallel::Workers& workers,
                    const std::function<bool()>& keep_going);

/// Makes up for one vertex removed (net = +1) or added (net = -1) elsewhere, where there is room
/// or crowding; no valence or angle gets worse. Returns whether it found a place.
bool balance_count(mesh::EditableMesh& mesh, Fidelity& fidelity, int net,
                   const TrialOptions& options, const parallel::Workers& workers);

/// Vertices with a bad valence.
std::vector<Index> bad_valences(const mesh::EditableMesh& mesh, const ValenceRule& rule);

/// Searches the planes around `center` that have no facet yet.
void ensure_planes(const mesh::EditableMesh& mesh, Fidelity& fidelity, Index center, int rings);

}  // namespace nonobtuse::refine
