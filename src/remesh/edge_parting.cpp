#include "remesh/edge_parting.h"

#include <algorithm>
#include <map>
#include <tuple>
#include <utility>
#include <vector>

#include "mesh/topology.h"

namespace nonobtuse::pipeline {

namespace {

// A vertex of the glued mesh: a knot, or a free vertex, counted from the other end.
using Pair = std::pair<Index, Index>;

// How many edges of the cut mesh are to be one edge.
struct Uses {
  Index interior = 0;
  Index boundary = 0;
};

class EdgeParting {
 public:
  explicit EdgeParting(mesh::EditableMesh& mesh) : mesh_(mesh) {
    for (Index t = 0; t < mesh_.triangle_capacity(); ++t) {
      if (!mesh_.alive_triangle(t)) continue;
      for (int k = 0; k < 3; ++k) {
        const mesh::Edge e{t, k};
        const Index a = mesh_.tail(e), b = mesh_.head(e);
        if (mesh_.adjacent(t, k) < 0) {
          ++uses_[glued(a, b)].boundary;
        } else if (mesh_.adjacent(t, k) > t && (mesh_.knot[a] >= 0 || mesh_.knot[b] >= 0)) {
          ++uses_[glued(a, b)].interior;
          interior_.emplace_back(glued(a, b), a, b);
        }
      }
    }
    std::sort(interior_.begin(), interior_.end());
  }

  Index run(bool manifold) {
    Index left = 0;
    for (const auto& [pair, a, b] : interior_) {
      const Uses& uses = uses_[pair];
      if (uses.interior == 1 && uses.boundary == 0 && pair.first != pair.second) continue;
      if (uses.interior > 0 && !flip(pair, a, b)) ++left;
    }
    if (manifold)
      for (const auto& use : uses_) left += use.second.boundary > 2 ? 1 : 0;
    return left;
  }

 private:
  [[nodiscard]] Pair glued(Index a, Index b) const {
    const auto id = [&](Index v) { return mesh_.knot[v] >= 0 ? mesh_.knot[v] : -1 - v; };
    return std::minmax({id(a), id(b)});
  }

  bool flip(const Pair& pair, Index a, Index b) {
    const mesh::Edge e = mesh_.find_edge(a, b);
    if (!e.valid() || !mesh_.can_flip(e)) return false;
    const Pair then = glued(mesh_.opposite_vertex(e), mesh_.opposite_vertex(mesh_.twin(e)));
    if (then.first == then.second) return false;
    const auto used = uses_.find(then);
    if (used != uses_.end() && used->second.interior + used->second.boundary > 0) return false;
    mesh_.flip(e);
    --uses_[pair].interior;
    ++uses_[then].interior;
    return true;
  }

  mesh::EditableMesh& mesh_;
  std::map<Pair, Uses> uses_;
  std::vector<std::tuple<Pair, Index, Index>> interior_;  // of knots, with the vertices
};

}  // namespace

Index part_edges(bool manifold, mesh::EditableMesh& mesh) {
  return EdgeParting(mesh).run(manifold);
}

}  // namespace nonobtuse::pipeline
