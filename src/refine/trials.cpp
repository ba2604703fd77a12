#include "refine/trials.h"

#include <algorithm>
#include <cmath>

#include "refine/fold_mending.h"
#include "refine/largest_distance.h"
#include "refine/relaxation.h"

namespace nonobtuse::refine {
namespace {

constexpr std::ptrdiff_t kFinalists = 4;
// Against large distances, in haste.
constexpr std::ptrdiff_t kFewFinalists = 2;
constexpr int kLongRounds = 10;
// Against large distances: points at this part of the largest get more weight, every few passes.
constexpr double kNearLargest = 0.75;
constexpr double kGrowth = 1.6;
constexpr double kHingeGrowth = 3;
constexpr int kPassesPerRound = 2;

}  // namespace

PatchScore score(const Patch& patch, const TrialOptions& options) {
  PatchScore score =
      patch.score(options.shape, AngleTest(options.promise), AngleTest(options.goal));
  if (std::isfinite(options.far))
    score.distance = largest_distance(patch.mesh, patch.fidelity, options.far);
  if (options.folds) score.folded = options.folds->count(patch);
  return score;
}

namespace {

void relax_patch(Patch& patch, const TrialOptions& options, int passes) {
  const RelaxationOptions relaxation{options.shape, passes, options.on_surface,
                                     std::isfinite(options.far)};
  const parallel::Workers serial(1);
  std::vector<Index> triangles;
  for (Index t = 0; t < patch.mesh.triangle_capacity(); ++t)
    if (patch.mesh.alive_triangle(t)) triangles.push_back(t);
  relax(patch.mesh, patch.fidelity, patch.inner_vertices(), relaxation, serial);
  patch.fidelity.rewalk(patch.mesh, triangles);
}

// Against large distances and angles at once: what is violated gets more weight, round by round.
// Ends at the best patch on the way, if it is better than `best_score`, else where it began.
void balance_patch(Patch& patch, TrialOptions& options, PatchScore& best_score, int rounds) {
  Patch best = patch;
  const AngleTest promise(options.promise), goal(options.goal);
  for (int round = 0; round < rounds; ++round) {
    relax_patch(patch, options, kPassesPerRound);
    std::vector<FarWeight> points = far_weights(patch.mesh, patch.fidelity, options.far);
    PatchScore now = patch.score(options.shape, promise, goal);
    now.distance = options.far;
    for (const FarWeight& p : points) now.distance = std::max(now.distance, p.distance);
    if (now < best_score) best = patch, best_score = now;
    if (now.outside_goal == 0 && points.empty()) break;
    if (now.outside_goal > 0) options.shape.hinge *= kHingeGrowth;
    std::erase_if(points,
                  [&](const FarWeight& p) { return p.distance < kNearLargest * now.distance; });
    std::sort(points.begin(), points.end(),
              [](const FarWeight& a, const FarWeight& b) { return a.weight < b.weight; });
    for (std::size_t i = 0; i < points.size(); ++i)
      if (i == 0 || points[i].weight != points[i - 1].weight) *points[i].weight *= kGrowth;
  }
  patch = std::move(best);
}

std::optional<Patch> edited(const Patch& patch, const std::vector<Edit>& edits) {
  Patch trial = patch;
  for (const Edit& edit : edits) {
    if (!trial.possible(edit)) return std::nullopt;
    trial.apply_with_samples(edit);
  }
  return trial;
}

}  // namespace

std::optional<Patch> best_of(const Patch& patch, const std::vector<std::vector<Edit>>& sequences,
                             const TrialOptions& options, const parallel::Workers& workers,
                             PatchScore& best_score) {
  struct Trial {
    std::optional<Patch> patch;
    PatchScore score;
    TrialOptions options;
  };
  std::vector<Trial> trials(sequences.size());
  const bool far = std::isfinite(options.far);
  const auto improve = [&](Trial& trial, int passes) {
    relax_patch(*trial.patch, options, passes);
    trial.score = score(*trial.patch, options);
  };
  // A short relaxation of all, then a long one of the most promising.
  workers.for_each(trials.size(), 1, [&](std::size_t i) {
    trials[i].patch = edited(patch, sequences[i]);
    trials[i].options = options;
    if (!trials[i].patch) return;
    if (!far) return improve(trials[i], 2);
    trials[i].score.folded = std::numeric_limits<Index>::max();
    balance_patch(*trials[i].patch, trials[i].options, trials[i].score, options.thorough ? 2 : 1);
  });
  std::erase_if(trials, [](const Trial& t) { return !t.patch; });
  std::stable_sort(trials.begin(), trials.end(),
                   [](const Trial& a, const Trial& b) { return a.score < b.score; });
  const std::ptrdiff_t finalists =
      std::min(std::ssize(trials), far && !options.thorough ? kFewFinalists : kFinalists);
  trials.erase(trials.begin() + finalists, trials.end());
  workers.for_each(trials.size(), 1, [&](std::size_t i) {
    if (far) {
      balance_patch(*trials[i].patch, trials[i].options, trials[i].score, kLongRounds);
      return;
    }
    improve(trials[i], options.passes);
    improve(trials[i], options.passes);
  });
  if (trials.empty()) return std::nullopt;
  const auto best =
      std::min_element(trials.begin(), trials.end(),
                       [](const Trial& a, const Trial& b) { return a.score < b.score; });
  best_score = best->score;
  return std::move(best->patch);
}

}  // namespace nonobtuse::refine
