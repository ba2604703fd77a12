#include "refine/valence_mending.h"

#include <algorithm>
#include <array>
#include <optional>

#include "refine/flips.h"
#include "refine/valence_edits.h"

namespace nonobtuse::refine {
namespace {

constexpr int kPasses = 6;
// Attempts after the first pass: enough for the few places of a smooth surface; where every vertex
// of a crumpled one resists, more would take minutes and mend nothing.
constexpr Index kDearAttempts = 100;
constexpr Index kVerticesPerAttempt = 20;
constexpr double kFlat = 0.98;         // length of a ring's summed normal over its area
constexpr int kPlaces = 24;            // tried to balance the count
constexpr Index kPerRemembered = 100;  // vertices of the mesh

struct Effort {
  int rings, flips;
};

class Mender {
 public:
  Mender(mesh::EditableMesh& mesh, Fidelity& fidelity, const TrialOptions& options, bool strict,
         const parallel::Workers& workers)
      : mesh_(mesh), fidelity_(fidelity), options_(options), strict_(strict), workers_(workers) {}

  // From now on sharp bends are taken: on a blade's edge neighbours may well look folded.
  void be_bold() { bold_ = true; }

  bool by_flips(Index v, const Effort& effort) {
    const Patch patch = patch_around(v, effort.rings);
    return commit_best(patch, search_valence_edits(patch, patch.local(v), {effort.flips, 12, 0}));
  }

  bool by_pair(Index v, const Effort& effort) {
    const bool low = mesh_.valence(v) < fidelity_.valences.range(v).best;
    // A vertex of low valence disappears; on a boundary, which stays, its neighbourhood grows.
    const bool grow = low && mesh_.on_boundary(v);
    const int net = grow ? 0 : low != mesh_.on_boundary(v) ? -1 : 1;
    const Patch patch = patch_around(v, effort.rings);
    const auto sequences = search_valence_edits(patch, patch.local(v),
                                                {grow ? 4 : effort.flips, 12, net, grow ? 2 : 0});
    return commit_balanced(patch, sequences);
  }

  // A knot more on a curve beside v.
  bool by_curve(Index v, const Effort& effort) {
    const Patch patch = patch_around(v, effort.rings);
    const auto sequences = search_curve_splits(patch, patch.local(v), 6);
    return !sequences.empty() && commit_balanced(patch, sequences);
  }

 private:
  struct Backup {
    mesh::EditableMesh mesh;
    Fidelity fidelity;
  };

  // Vertices once the copies of every knot are one.
  [[nodiscard]] static Index glued_count(const mesh::EditableMesh& mesh, const Knots& knots) {
    Index count = mesh.vertex_count();
    for (const SlidingKnot& knot : knots.all)
      if (!knot.copies.empty()) count -= static_cast<Index>(knot.copies.size()) - 1;
    return count;
  }

  Patch patch_around(Index v, int rings) {
    ensure_planes(mesh_, fidelity_, v, rings + 2);
    const std::array<Index, 1> center{v};
    return Patch(mesh_, fidelity_, center, rings);
  }

  // A change of the number of vertices stays only if it can be made up for elsewhere.
  bool commit_balanced(const Patch& patch, const std::vector<std::vector<Edit>>& sequences) {
    std::optional<Backup> before;
    if (!commit_best(patch, sequences, &before)) return false;
    const Index count = glued_count(before->mesh, before->fidelity.knots);
    for (Index now; (now = glued_count(mesh_, fidelity_.knots)) != count;) {
      if (balance_count(mesh_, fidelity_, now < count ? 1 : -1, options_, workers_)) continue;
      mesh_ = std::move(before->mesh);
      fidelity_ = std::move(before->fidelity);
      return false;
    }
    return true;
  }

  bool commit_best(const Patch& patch, const std::vector<std::vector<Edit>>& sequences,
                   std::optional<Backup>* backup = nullptr) {
    PatchScore after;
    std::optional<Patch> best = best_of(patch, sequences, options_, workers_, after);
    if (!best) return false;
    const PatchScore before = score(patch, options_);
    if ((!bold_ && after.folded > before.folded) || after.bad_valence >= before.bad_valence ||
        !std::isfinite(after.energy) || (strict_ && after.outside_promise > before.outside_promise))
      return false;
    if (backup) backup->emplace(Backup{mesh_, fidelity_});
    best->commit(mesh_, fidelity_);
    return true;
  }

  mesh::EditableMesh& mesh_;
  Fidelity& fidelity_;
  const TrialOptions& options_;
  bool strict_;
  bool bold_ = false;
  const parallel::Workers& workers_;
};

bool is_place(const mesh::EditableMesh& mesh, Index v, int net) {
  if (!mesh.alive_vertex(v) || mesh.on_boundary(v)) return false;
  const int valence = mesh.valence(v);
  return net < 0 ? valence <= 5 : valence >= 6;
}

// Vertices by how crowded (net < 0) or roomy (net > 0) their ring is, the best places first.
std::vector<Index> best_places(const mesh::EditableMesh& mesh, const Fidelity& fidelity, int net,
                               std::size_t most) {
  std::vector<std::pair<double, Index>> ranked;
  for (Index v = 0; v < mesh.vertex_capacity(); ++v) {
    if (!is_place(mesh, v, net)) continue;
    double area = 0;
    Vec3 sum;
    for_ring(mesh, v, [&](Index t, int) {
      const Vec3 a = area_vector(corners(mesh, t));
      area += length(a);
      sum += a;
    });
    if (length(sum) < kFlat * area) continue;  // a tip or ridge: every vertex counts there
    area /= fidelity.size.at(v) * fidelity.size.at(v);
    ranked.emplace_back(net < 0 ? area : -area, v);
  }
  const std::size_t count = std::min(ranked.size(), most);
  std::partial_sort(ranked.begin(), ranked.begin() + static_cast<std::ptrdiff_t>(count),
                    ranked.end());
  std::vector<Index> best;
  for (std::size_t i = 0; i < count; ++i) best.push_back(ranked[i].second);
  return best;
}

// Places to try, the best first. A budget that remembers them looks at the whole mesh only when
// all that were found have been tried, whether these helped or not.
class Places {
 public:
  Places(const mesh::EditableMesh& mesh, const Fidelity& fidelity, int net, TrialBudget* budget)
      : mesh_(mesh), net_(net) {
    const bool remember = budget && budget->places;
    if (remember) queue_ = &(*budget->places)[net < 0 ? 0 : 1];
    if (!queue_->empty()) return;
    const auto more = remember ? static_cast<std::size_t>(mesh.vertex_count() / kPerRemembered) : 0;
    *queue_ = best_places(mesh, fidelity, net, kPlaces + more);
    std::reverse(queue_->begin(), queue_->end());
  }

  // -1: none is left.
  Index next() {
    while (!queue_->empty()) {
      const Index v = queue_->back();
      queue_->pop_back();
      if (is_place(mesh_, v, net_)) return v;
    }
    return -1;
  }

 private:
  const mesh::EditableMesh& mesh_;
  int net_;
  std::vector<Index> own_;
  std::vector<Index>* queue_ = &own_;
};

}  // namespace

std::vector<Index> bad_valences(const mesh::EditableMesh& mesh, const ValenceRule& rule) {
  std::vector<Index> bad;
  for (Index v = 0; v < mesh.vertex_capacity(); ++v)
    if (mesh.alive_vertex(v) && !rule.good(v, mesh.valence(v))) bad.push_back(v);
  return bad;
}

void ensure_planes(const mesh::EditableMesh& mesh, Fidelity& fidelity, Index center, int rings) {
  std::vector<Index> reached{center};
  fidelity.knots.add_copies(mesh, reached);
  for (int ring = 0; ring <= rings; ++ring) {
    std::vector<Index> more;
    for (Index v : reached) {
      if (fidelity.vertex_planes[v].facet < 0) fidelity.update_vertex(mesh, v);
      for_ring(mesh, v, [&](Index t, int) {
        if (fidelity.edge_planes[t][0].facet < 0) fidelity.update_triangle(mesh, t);
        for (Index u : mesh.triangle(t)) more.push_back(u);
      });
    }
    std::sort(more.begin(), more.end());
    more.erase(std::unique(more.begin(), more.end()), more.end());
    fidelity.knots.add_copies(mesh, more);
    reached.swap(more);
  }
  for (Index v : reached)
    if (fidelity.vertex_planes[v].facet < 0) fidelity.update_vertex(mesh, v);
}

bool balance_count(mesh::EditableMesh& mesh, Fidelity& fidelity, int net,
                   const TrialOptions& options, const parallel::Workers& workers,
                   std::vector<Index>* touched) {
  Places places(mesh, fidelity, net, options.budget);
  for (int attempt = 0; attempt < kPlaces; ++attempt) {
    const Index v = places.next();
    if (v < 0) break;
    ensure_planes(mesh, fidelity, v, 4);
    const std::array<Index, 1> center{v};
    const Patch patch(mesh, fidelity, center, 3);
    const auto sequences = search_balancing_edits(patch, patch.local(v), net, 6);
    PatchScore after;
    std::optional<Patch> best = best_of(patch, sequences, options, workers, after);
    if (!best) continue;
    const PatchScore before = score(patch, options);
    if (after.folded > before.folded || after.bad_valence > before.bad_valence ||
        after.outside_promise > before.outside_promise || after.distance > before.distance ||
        !std::isfinite(after.energy))
      continue;
    const std::vector<Index> triangles = best->commit(mesh, fidelity);
    if (touched) *touched = triangles;
    return true;
  }
  return false;
}

Index mend_valences(mesh::EditableMesh& mesh, Fidelity& fidelity, const TrialOptions& options,
                    bool strict, const parallel::Workers& workers,
                    const std::function<bool()>& keep_going) {
  Mender mender(mesh, fidelity, options, strict, workers);
  // Cheap attempts first, on all of them; dearer ones only where these failed.
  const std::array<Effort, 3> efforts{Effort{3, 2}, Effort{3, 4}, Effort{4, 5}};
  Index dear = kDearAttempts + mesh.vertex_count() / kVerticesPerAttempt;
  for (int pass = 0; pass < kPasses; ++pass) {
    const std::vector<Index> bad = bad_valences(mesh, fidelity.valences);
    if (bad.empty()) return 0;
    const Effort effort = efforts[std::min(pass, 2)];
    if (pass >= kPasses - 2) mender.be_bold();
    for (Index v : bad) {
      if (options.budget && options.budget->exhausted())
        return static_cast<Index>(bad_valences(mesh, fidelity.valences).size());
      if (!keep_going()) return static_cast<Index>(bad_valences(mesh, fidelity.valences).size());
      if (!mesh.alive_vertex(v) || fidelity.valences.good(v, mesh.valence(v))) continue;
      if (pass >= 1 && dear-- <= 0)
        return static_cast<Index>(bad_valences(mesh, fidelity.valences).size());
      if (mender.by_flips(v, effort)) continue;
      if (pass < 2 || mender.by_pair(v, {4, 2})) continue;
      if (!fidelity.knots.empty()) mender.by_curve(v, {3, 4});
    }
  }
  return static_cast<Index>(bad_valences(mesh, fidelity.valences).size());
}

}  // namespace nonobtuse::refine
