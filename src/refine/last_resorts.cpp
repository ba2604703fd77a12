// Operators as in Wang, Yan et al., Isotropic surface remeshing without large and small angles
// (2019): flips, splits and collapses around the bad triangle; here each is tried together with
// the flips that restore the valences, and balanced elsewhere so that the count holds.
#include "refine/last_resorts.h"

#include <algorithm>
#include <optional>
#include <tuple>
#include <utility>

#include "refine/valence_edits.h"
#include "refine/valence_mending.h"

namespace nonobtuse::refine {
namespace {

constexpr int kRings = 2;
constexpr int kSequences = 40;
// For a few places; a surface that resists everywhere is left as it is.
constexpr Index kAttempts = 30;
constexpr Index kTrianglesPerAttempt = 200;

bool better(const PatchScore& a, const PatchScore& b) {
  return std::tie(a.folded, a.bad_valence, a.outside_promise, a.outside_goal) <
         std::tie(b.folded, b.bad_valence, b.outside_promise, b.outside_goal);
}

class TriangleMender {
 public:
  TriangleMender(mesh::EditableMesh& mesh, Fidelity& fidelity, const TrialOptions& options,
                 const parallel::Workers& workers)
      : mesh_(mesh), fidelity_(fidelity), options_(options), workers_(workers) {}

  bool by_flips(Index t) {
    const Patch patch(mesh_, fidelity_, mesh_.triangle(t), kRings);
    std::vector<std::vector<Edit>> sequences =
        search_neutral_flips(patch, local(patch, t), kSequences);
    sequences.insert(sequences.begin(), std::vector<Edit>{});
    return commit_if_better(patch, sequences);
  }

  bool by_pair(Index t, int net) {
    const Patch patch(mesh_, fidelity_, mesh_.triangle(t), kRings);
    std::vector<std::vector<Edit>> sequences;
    for (Index v : local(patch, t))
      for (auto& edits : search_balancing_edits(patch, v, net, 6)) sequences.push_back(edits);
    return commit_balanced(patch, sequences, net);
  }

  // A knot more or less on the curves that the triangle touches.
  bool by_curve(Index t, int net) {
    const Patch patch(mesh_, fidelity_, mesh_.triangle(t), kRings);
    std::vector<std::vector<Edit>> sequences;
    for (Index v : local(patch, t))
      if (patch.boundary(v) && patch.mesh.knot[v] >= 0)
        for (auto& edits : search_curve_edits(patch, v, net, 6)) sequences.push_back(edits);
    return !sequences.empty() && commit_balanced(patch, sequences, net);
  }

 private:
  struct Backup {
    mesh::EditableMesh mesh;
    Fidelity fidelity;
  };

  [[nodiscard]] Triangle local(const Patch& patch, Index t) const {
    const Triangle& v = mesh_.triangle(t);
    return {patch.local(v[0]), patch.local(v[1]), patch.local(v[2])};
  }

  // A change of the number of vertices stays only if it can be made up for elsewhere.
  bool commit_balanced(const Patch& patch, const std::vector<std::vector<Edit>>& sequences,
                       int net) {
    std::optional<Backup> before;
    if (!commit_if_better(patch, sequences, &before)) return false;
    if (balance_count(mesh_, fidelity_, -net, options_, workers_)) return true;
    mesh_ = std::move(before->mesh);
    fidelity_ = std::move(before->fidelity);
    return false;
  }

  bool commit_if_better(const Patch& patch, const std::vector<std::vector<Edit>>& sequences,
                        std::optional<Backup>* backup = nullptr) {
    PatchScore after;
    std::optional<Patch> best = best_of(patch, sequences, options_, workers_, after);
    if (!best || !std::isfinite(after.energy) || !better(after, score(patch, options_)))
      return false;
    if (backup) backup->emplace(Backup{mesh_, fidelity_});
    best->commit(mesh_, fidelity_);
    return true;
  }

  mesh::EditableMesh& mesh_;
  Fidelity& fidelity_;
  const TrialOptions& options_;
  const parallel::Workers& workers_;
};

// Those that break the promise first, and of those that nothing has helped so far no others.
std::vector<Index> most_promising(const mesh::EditableMesh& mesh, std::vector<Index> triangles,
                                  const TrialOptions& options) {
  const std::vector<Triangle>& resisting = options.budget->resisting;
  const AngleTest promise(options.promise);
  std::erase_if(triangles, [&](Index t) {
    return promise.inside(mesh, t) &&
           std::binary_search(resisting.begin(), resisting.end(), mesh.triangle(t));
  });
  std::stable_partition(triangles.begin(), triangles.end(),
                        [&](Index t) { return !promise.inside(mesh, t); });
  return triangles;
}

void remember_resisting(const mesh::EditableMesh& mesh, const std::vector<Index>& triangles,
                        std::vector<Triangle>& resisting) {
  for (const Index t : triangles)
    if (mesh.alive_triangle(t)) resisting.push_back(mesh.triangle(t));
  std::sort(resisting.begin(), resisting.end());
  resisting.erase(std::unique(resisting.begin(), resisting.end()), resisting.end());
}

}  // namespace

Index mend_triangles(mesh::EditableMesh& mesh, Fidelity& fidelity,
                     const std::vector<Index>& triangles, const TrialOptions& options,
                     const parallel::Workers& workers, const std::function<bool()>& keep_going) {
  TriangleMender mender(mesh, fidelity, options, workers);
  const AngleTest goal(options.goal);
  Index changes = 0;
  Index attempts = kAttempts + mesh.triangle_count() / kTrianglesPerAttempt;
  std::vector<Index> failed;
  for (Index t : options.budget ? most_promising(mesh, triangles, options) : triangles) {
    if (!mesh.alive_triangle(t) || goal.inside(mesh, t)) continue;
    if (attempts-- <= 0) break;
    if (!keep_going() || (options.budget && options.budget->exhausted())) break;
    bool changed = mender.by_flips(t);
    for (int net : {-1, 1})
      if (!changed && mesh.alive_triangle(t)) changed = mender.by_pair(t, net);
    if (!fidelity.knots.empty())
      for (int net : {-1, 1})
        if (!changed && mesh.alive_triangle(t)) changed = mender.by_curve(t, net);
    changes += changed;
    if (!changed) failed.push_back(t);
  }
  if (options.budget) remember_resisting(mesh, failed, options.budget->resisting);
  return changes;
}

}  // namespace nonobtuse::refine
