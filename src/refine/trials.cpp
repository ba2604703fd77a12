#include "refine/trials.h"

#include <algorithm>
#include <cmath>

#include "refine/fold_mending.h"
#include "refine/largest_distance.h"
#include "refine/minimax_relaxation.h"
#include "refine/relaxation.h"

namespace nonobtuse::refine {
namespace {

constexpr int kShortPasses = 2;
constexpr std::ptrdiff_t kFinalists = 4;
// Of a finalist's relaxation against large distances; after some rounds without a lower distance
// than before the edits it is given up.
constexpr int kRounds = 10, kSomeRounds = 4;

}  // namespace

PatchScore score(const Patch& patch, const TrialOptions& options) {
  PatchScore score =
      patch.score(options.shape, AngleTest(options.promise), AngleTest(options.goal));
  if (std::isfinite(options.far))
    score.distance = largest_distance(patch.mesh, patch.fidelity, options.far);
  if (options.folds) score.folded = options.folds->count(patch);
  return score;
}

void relax_patch(Patch& patch, const TrialOptions& options, int passes, bool gauss_newton) {
  const RelaxationOptions relaxation{options.shape, passes, options.on_surface, gauss_newton};
  const parallel::Workers serial(1);
  std::vector<Index> triangles;
  for (Index t = 0; t < patch.mesh.triangle_capacity(); ++t)
    if (patch.mesh.alive_triangle(t)) triangles.push_back(t);
  relax(patch.mesh, patch.fidelity, patch.inner_vertices(), relaxation, serial);
  patch.fidelity.rewalk(patch.mesh, triangles);
}

namespace {

std::optional<Patch> edited(const Patch& patch, const std::vector<Edit>& edits) {
  Patch trial = patch;
  for (const Edit& edit : edits) {
    if (!trial.possible(edit)) return std::nullopt;
    trial.apply_with_samples(edit);
  }
  return trial;
}

// best_of against large distances.
std::optional<Patch> best_of_far(const Patch& patch,
                                 const std::vector<std::vector<Edit>>& sequences,
                                 const TrialOptions& options, const parallel::Workers& workers,
                                 PatchScore& best_score) {
  const PatchScore before = score(patch, options);
  std::vector<std::optional<MinimaxRelaxation>> trials(sequences.size());
  workers.for_each(trials.size(), 1, [&](std::size_t i) {
    std::optional<Patch> trial = edited(patch, sequences[i]);
    if (!trial) return;
    trials[i].emplace(std::move(*trial), options, before);
    trials[i]->run(1);
  });
  std::erase_if(trials, [](const auto& t) { return !t; });
  if (trials.empty()) return std::nullopt;
  std::stable_sort(trials.begin(), trials.end(),
                   [](const auto& a, const auto& b) { return a->more_promising(*b); });
  const std::ptrdiff_t finalists = std::min(std::ssize(trials), kFinalists);
  workers.for_each(static_cast<std::size_t>(finalists), 1, [&](std::size_t i) {
    trials[i]->run(kSomeRounds);
    if (trials[i]->least_distance() < before.distance) trials[i]->run(kRounds - kSomeRounds);
  });
  if (options.budget)
    for (const auto& t : trials) options.budget->spend(t->effort());
  const auto best =
      std::min_element(trials.begin(), trials.begin() + finalists,
                       [](const auto& a, const auto& b) { return a->best_score < b->best_score; });
  best_score = (*best)->best_score;
  return std::move((*best)->best);
}

}  // namespace

std::optional<Patch> best_of(const Patch& patch, const std::vector<std::vector<Edit>>& sequences,
                             const TrialOptions& options, const parallel::Workers& workers,
                             PatchScore& best_score) {
  if (options.budget && options.budget->exhausted()) return std::nullopt;
  if (std::isfinite(options.far))
    return best_of_far(patch, sequences, options, workers, best_score);
  struct Trial {
    std::optional<Patch> patch;
    PatchScore score;
  };
  const std::int64_t vertices = std::ssize(patch.inner_vertices());
  std::vector<Trial> trials(sequences.size());
  const bool beside_curves = patch.fidelity.knots.network() != nullptr;
  const auto improve = [&](Trial& trial, int passes) {
    relax_patch(*trial.patch, options, passes, beside_curves);
    trial.score = score(*trial.patch, options);
  };
  // A short relaxation of all, then a long one of the most promising.
  workers.for_each(trials.size(), 1, [&](std::size_t i) {
    trials[i].patch = edited(patch, sequences[i]);
    if (trials[i].patch) improve(trials[i], kShortPasses);
  });
  std::erase_if(trials, [](const Trial& t) { return !t.patch; });
  if (trials.empty()) return std::nullopt;
  if (options.budget)
    options.budget->spend(vertices *
                          (kShortPasses * std::ssize(trials) +
                           2 * options.passes * std::min(kFinalists, std::ssize(trials))));
  std::stable_sort(trials.begin(), trials.end(),
                   [](const Trial& a, const Trial& b) { return a.score < b.score; });
  trials.erase(trials.begin() + std::min(std::ssize(trials), kFinalists), trials.end());
  workers.for_each(trials.size(), 1, [&](std::size_t i) {
    improve(trials[i], options.passes);
    improve(trials[i], options.passes);
  });
  const auto best =
      std::min_element(trials.begin(), trials.end(),
                       [](const Trial& a, const Trial& b) { return a.score < b.score; });
  best_score = best->score;
  return std::move(best->patch);
}

}  // namespace nonobtuse::refine
