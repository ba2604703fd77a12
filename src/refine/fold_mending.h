// Triangles that are turned over against the surface or cross others: a pleat that came with the
// connectivity, or a limb thinner than an edge. Moving vertices does not undo these; other
// connectivity does.
#pragma once

#include <functional>
#include <vector>

#include "refine/patch.h"
#include "refine/trials.h"

namespace nonobtuse::refine {

/// Tells folds, as the quality report does.
class FoldTest {
 public:
  explicit FoldTest(const mesh::Surface& surface);
  /// Whether t's normal is more than 90 degrees off the surface's at the point nearest to t's
  /// centroid, both its facet's and the interpolated vertex normals'.
  [[nodiscard]] bool turned_over(const mesh::EditableMesh& mesh, const Fidelity& fidelity,
                                 Index t) const;
  /// Triangles of a patch that are turned over, and pairs of it that cross.
  [[nodiscard]] Index count(const Patch& patch) const;

 private:
  std::vector<Vec3> vertex_normals_;  // of the surface, weighted by area
};

/// By flips, or a vertex more or less there and one less or more in a flat place. Keeps what gets
/// rid of folds without spoiling valences or angles. Without `crossings` nothing crosses at the
/// beginning. Returns the number of changes.
Index mend_folds(mesh::EditableMesh& mesh, Fidelity& fidelity, const TrialOptions& options,
                 const parallel::Workers& workers, const std::function<bool()>& keep_going,
                 bool crossings = true);

}  // namespace nonobtuse::refine
