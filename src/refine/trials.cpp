#include "refine/trials.h"

#include <algorithm>

#include "refine/relaxation.h"

namespace nonobtuse::refine {
namespace {

constexpr std::ptrdiff_t kFinalists = 4;

}  // namespace

PatchScore score(const Patch& patch, const TrialOptions& options) {
  return patch.score(options.shape, AngleTest(options.promise), AngleTest(options.goal));
}

namespace {

void relax_patch(Patch& patch, const TrialOptions& options, int passes) {
  const RelaxationOptions relaxation{options.shape, passes, options.on_surface};
  const parallel::Workers serial(1);
  std::vector<Index> triangles;
  for (Index t = 0; t < patch.mesh.triangle_capacity(); ++t)
    if (patch.mesh.alive_triangle(t)) triangles.push_back(t);
  relax(patch.mesh, patch.fidelity, patch.inner_vertices(), relaxation, serial);
  patch.fidelity.rewalk(patch.mesh, triangles);
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
  };
  std::vector<Trial> trials(sequences.size());
  const auto improve = [&](Trial& trial, int passes) {
    relax_patch(*trial.patch, options, passes);
    trial.score = score(*trial.patch, options);
  };
  // A short relaxation of all, then a long one of the most promising.
  workers.for_each(trials.size(), 1, [&](std::size_t i) {
    trials[i].patch = edited(patch, sequences[i]);
    if (trials[i].patch) improve(trials[i], 2);
  });
  std::erase_if(trials, [](const Trial& t) { return !t.patch; });
  std::stable_sort(trials.begin(), trials.end(),
                   [](const Trial& a, const Trial& b) { return a.score < b.score; });
  if (std::ssize(trials) > kFinalists) trials.erase(trials.begin() + kFinalists, trials.end());
  workers.for_each(trials.size(), 1, [&](std::size_t i) {
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
