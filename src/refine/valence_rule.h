// Which valences are good, vertex by vertex.
#pragma once

#include <cstdlib>
#include <vector>

#include "mesh/editable_mesh.h"
#include "mesh/sector_valence.h"

namespace nonobtuse::refine {

/// Interior vertices: 5 to 7 neighbours. Boundary vertices: by the angle of their sector as it was
/// when measured (mesh::sector_valence).
class ValenceRule {
 public:
  /// Takes the sectors' angles from the mesh as it is.
  void measure(const mesh::EditableMesh& mesh);
  /// The same for one vertex, also a new one.
  void measure(const mesh::EditableMesh& mesh, Index v);
  void set(Index v, const mesh::ValenceRange& range);

  [[nodiscard]] const mesh::ValenceRange& range(Index v) const {
    static constexpr mesh::ValenceRange kInterior;
    return v < static_cast<Index>(ranges_.size()) ? ranges_[v] : kInterior;
  }
  [[nodiscard]] bool good(Index v, int valence) const { return range(v).contains(valence); }
  [[nodiscard]] int defect(Index v, int valence) const { return range(v).defect(valence); }
  /// Whether a change of valence is allowed: it ends good, or comes nearer to the best.
  [[nodiscard]] bool change_allowed(Index v, int from, int to) const {
    const mesh::ValenceRange& r = range(v);
    return r.contains(to) || std::abs(to - r.best) < std::abs(from - r.best);
  }

 private:
  std::vector<mesh::ValenceRange> ranges_;  // empty: no boundary
};

}  // namespace nonobtuse::refine
