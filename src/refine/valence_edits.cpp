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
    const double d = patch.valence(v) - (patch.boundary(v) ? 4 : 6);
    sum += d * d;
  }
  return sum;
}

// Flips that raise the valence of v (edges opposite v) or lower it (edges at v).
std::vector<Edit> flips_for(const Patch& patch, Index v) {
  std::vector<Edit> edits;
  const bool raise = patch.valence(v) < (patch.boundary(v) ? 3 : 5);
  for_ring(patch.mesh, v, [&](Index t, int k) {
    const Triangle& c = patch.mesh.triangle(t);
    const Index a = c[mesh::next(k)], b = c[mesh::previous(k)];
    edits.push_back(raise ? Edit{Edit::Kind::Flip, a, b} : Edit{Edit::Kind::Flip, v, a});
  });
  return edits;
}

class Search {
 public:
  Search(int target, int solutions) : target_(target), limit_(solutions) {}

  // Tries all sequences of at most `flips` flips; keeps those that bring the defect to the target.
  void descend(const Patch& patch, int flips) {
    const int defect = patch.total_defect();
    if (defect <= target_) {
      found_.push_back(
          {irregularity(patch) + 0.1 * static_cast<double>(patch.edits.size()), patch.edits});
      return;
    }
    // Every flip mends at most four units.
    if (flips == 0 || defect > target_ + 4 * flips || visited_++ > 4000) return;
    for (Index v = 0; v < patch.mesh.vertex_capacity(); ++v) {
      if (!patch.mesh.alive_vertex(v) || patch.defect(v) == 0 || !patch.inner(v)) continue;
      for (const Edit& edit : flips_for(patch, v)) {
        if (!patch.possible(edit)) continue;
        Patch next = patch;
        next.apply(edit);
        if (next.total_defect() <= defect + 1) descend(next, flips - 1);
      }
      return;  // one defect at a time: the others have their turn deeper down
    }
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
  int target_, limit_;
  int visited_ = 0;
  std::vector<Solution> found_;
};

// First edits that change the number of vertices at v.
std::vector<Edit> count_edits(const Patch& patch, Index v, int net) {
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
  if (search.net == 0) {
    for (int flips = 1; flips <= search.flips && found.empty(); ++flips)
      found.descend(patch, flips);
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
