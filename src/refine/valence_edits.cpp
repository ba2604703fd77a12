// The sum of 6 - valence is a constant of the topology, so a single defect cannot be undone, only
// moved on, split up, or cancelled against an opposite one: a flip moves one unit from two
// vertices to two others. Depth-first search over the flips that help the worst vertex.
#include "refine/valence_edits.h"

#include <algorithm>

namespace nonobtuse::refine {
namespace {

struct Solution {
  double irregularity = 0;
  std::vector<Edit> edits;
};

double irregularity(const Patch& patch) {
  double sum = 0;
  for (Index v = 0; v < patch.mesh.vertex_capacity(); ++v) {
    if (!patch.mesh.alive_vertex(v)) continue;
    const double d = patch.valence(v) - patch.fidelity.valences.range(v).best;
    sum += d * d;
  }
  return sum;
}

// Flips that raise the valence of v (edges opposite v) or lower it (edges at v).
std::vector<Edit> flips_for(const Patch& patch, Index v) {
  std::vector<Edit> edits;
  const bool raise = patch.valence(v) < patch.fidelity.valences.range(v).least;
  for_ring(patch.mesh, v, [&](Index t, int k) {
    const Triangle& c = patch.mesh.triangle(t);
    const Index a = c[mesh::next(k)], b = c[mesh::previous(k)];
    edits.push_back(raise ? Edit{Edit::Kind::Flip, a, b} : Edit{Edit::Kind::Flip, v, a});
  });
  return edits;
}

// Splits of the edges opposite a boundary vertex that has too few neighbours: along a crease flips
// alone only pass the defect on to the next vertex.
std::vector<Edit> splits_for(const Patch& patch, Index v) {
  std::vector<Edit> edits;
  if (!patch.boundary(v) || patch.valence(v) >= patch.fidelity.valences.range(v).least)
    return edits;
  for_ring(patch.mesh, v, [&](Index t, int k) {
    const Triangle& c = patch.mesh.triangle(t);
    edits.push_back({Edit::Kind::Split, c[mesh::next(k)], c[mesh::previous(k)]});
  });
  return edits;
}

class Search {
 public:
  Search(int target, int solutions) : target_(target), limit_(solutions) {}

  /// Leaves the patch's other defects alone while there are new ones or that of v.
  void focus_on(const Patch& patch, Index v) {
    for (Index u = 0; u < patch.mesh.vertex_capacity(); ++u)
      known_.push_back(u == v || !patch.mesh.alive_vertex(u) ? 0 : patch.defect(u));
  }

  // Tries all sequences of at most `flips` flips and `splits` splits; keeps those that bring the
  // defect to the target.
  void descend(const Patch& patch, int flips, int splits = 0) {
    const int defect = patch.total_defect();
    if (defect <= target_) {
      found_.push_back(
          {irregularity(patch) + 0.1 * static_cast<double>(patch.edits.size()), patch.edits});
      return;
    }
    // Every flip mends at most four units, a split one.
    if (flips + splits == 0 || defect > target_ + 4 * flips + splits || visited_++ > 4000) return;
    // One defect at a time: the others have their turn deeper down.
    Index v = known_.empty() ? -1 : first_defect(patch, true);
    if (v < 0) v = first_defect(patch, false);
    if (v < 0) return;
    const auto attempt = [&](const Edit& edit, int flips_left, int splits_left) {
      if (!patch.possible(edit)) return;
      Patch next = patch;
      next.apply(edit);
      if (next.total_defect() <= defect + 1) descend(next, flips_left, splits_left);
    };
    if (flips > 0)
      for (const Edit& edit : flips_for(patch, v)) attempt(edit, flips - 1, splits);
    if (splits > 0)
      for (const Edit& edit : splits_for(patch, v)) attempt(edit, flips, splits - 1);
  }

  std::vector<std::vector<Edit>> best() {
    std::stable_sort(found_.begin(), found_.end(), [](const Solution& a, const Solution& b) {
      return a.irregularity < b.irregularity;
    });
    std::vector<std::vector<Edit>> edits;
    for (Solution& s : found_) {
      if (static_cast<int>(edits.size()) == limit_) break;
      edits.push_back(std::move(s.edits));
    }
    return edits;
  }

  [[nodiscard]] bool empty() const { return found_.empty(); }

 private:
  // The first vertex with a defect (with `only_new` one beyond the known), -1 if there is none.
  [[nodiscard]] Index first_defect(const Patch& patch, bool only_new) const {
    for (Index v = 0; v < patch.mesh.vertex_capacity(); ++v) {
      if (!patch.mesh.alive_vertex(v) || !patch.inner(v)) continue;
      const int known = only_new && v < static_cast<Index>(known_.size()) ? known_[v] : 0;
      if (patch.defect(v) > known) return v;
    }
    return -1;
  }

  int target_, limit_;
  int visited_ = 0;
  std::vector<int> known_;  // defects by vertex
  std::vector<Solution> found_;
};

// First edits that change the number of vertices around a boundary vertex v: a neighbour less, or
// one more between it and the edge opposite.
std::vector<Edit> boundary_count_edits(const Patch& patch, Index v, int net) {
  std::vector<Edit> edits;
  for_ring(patch.mesh, v, [&](Index t, int k) {
    const Triangle& c = patch.mesh.triangle(t);
    const Index a = c[mesh::next(k)], b = c[mesh::previous(k)];
    if (net > 0) {
      edits.push_back({Edit::Kind::Split, a, b});
    } else {
      edits.push_back({Edit::Kind::Collapse, a, b});
      edits.push_back({Edit::Kind::Collapse, b, a});
      edits.push_back({Edit::Kind::Collapse, a, v});
    }
  });
  return edits;
}

// First edits that change the number of vertices at v.
std::vector<Edit> count_edits(const Patch& patch, Index v, int net) {
  if (patch.boundary(v)) return boundary_count_edits(patch, v, net);
  std::vector<Index> neighbors;
  patch.mesh.neighbors(v, neighbors);
  std::vector<Edit> edits;
  for (Index u : neighbors)
    edits.push_back(net < 0 ? Edit{Edit::Kind::Collapse, v, u} : Edit{Edit::Kind::Split, v, u});
  return edits;
}

}  // namespace

std::vector<std::vector<Edit>> search_valence_edits(const Patch& patch, Index bad_vertex,
                                                    const ValenceSearch& search) {
  const int defect = patch.total_defect();
  Search found(defect - 1, search.solutions);
  if (search.splits > 0) found.focus_on(patch, bad_vertex);
  if (search.net == 0) {
    for (int flips = 1; flips <= search.flips && found.empty(); ++flips)
      found.descend(patch, flips, std::min(flips, search.splits));
    return found.best();
  }
  for (const Edit& edit : count_edits(patch, bad_vertex, search.net)) {
    if (!patch.possible(edit)) continue;
    Patch next = patch;
    next.apply(edit);
    found.descend(next, search.flips);
  }
  return found.best();
}

std::vector<std::vector<Edit>> search_balancing_edits(const Patch& patch, Index place, int net,
                                                      int solutions) {
  Search found(patch.total_defect(), solutions);
  for (const Edit& edit : count_edits(patch, place, net)) {
    if (!patch.possible(edit)) continue;
    Patch next = patch;
    next.apply(edit);
    found.descend(next, 2);
  }
  return found.best();
}

std::vector<std::vector<Edit>> search_curve_edits(const Patch& patch, Index v, int net,
                                                  int solutions) {
  Search found(patch.total_defect(), solutions);
  std::vector<Index> ring;
  patch.mesh.neighbors(v, ring);
  for (const Index u : {ring.front(), ring.back()}) {  // along the boundary
    const Edit edit{net < 0 ? Edit::Kind::CollapseCurve : Edit::Kind::SplitCurve, v, u};
    if (!patch.possible(edit)) continue;
    Patch next = patch;
    next.apply(edit);
    found.descend(next, 3);
  }
  return found.best();
}

std::vector<std::vector<Edit>> search_curve_splits(const Patch& patch, Index v, int solutions) {
  Search found(patch.total_defect() - 1, solutions);
  found.focus_on(patch, v);
  if (patch.valence(v) >= patch.fidelity.valences.range(v).least) return {};
  for_ring(patch.mesh, v, [&](Index t, int k) {
    if (patch.mesh.adjacent(t, k) >= 0) return;
    const Triangle& c = patch.mesh.triangle(t);
    const Edit edit{Edit::Kind::SplitCurve, c[mesh::next(k)], c[mesh::previous(k)]};
    if (!patch.possible(edit)) return;
    Patch next = patch;
    next.apply(edit);
    found.descend(next, 4);
  });
  return found.best();
}

std::vector<std::vector<Edit>> search_neutral_flips(const Patch& patch, const Triangle& around,
                                                    int solutions) {
  Search found(patch.total_defect(), solutions);
  std::vector<Edit> edits;
  for (Index v : around)
    for_ring(patch.mesh, v, [&](Index t, int k) {
      const Triangle& c = patch.mesh.triangle(t);
      edits.push_back({Edit::Kind::Flip, v, c[mesh::next(k)]});
      edits.push_back({Edit::Kind::Flip, c[mesh::next(k)], c[mesh::previous(k)]});
    });
  for (Edit& e : edits)
    if (e.a > e.b) std::swap(e.a, e.b);
  const auto key = [](const Edit& e) { return std::pair(e.a, e.b); };
  std::sort(edits.begin(), edits.end(), [&](auto& a, auto& b) { return key(a) < key(b); });
  edits.erase(
      std::unique(edits.begin(), edits.end(), [&](auto& a, auto& b) { return key(a) == key(b); }),
      edits.end());
  for (const Edit& edit : edits) {
    if (!patch.possible(edit)) continue;
    Patch next = patch;
    next.apply(edit);
    found.descend(next, 1);
  }
  return found.best();
}

}  // namespace nonobtuse::refine
