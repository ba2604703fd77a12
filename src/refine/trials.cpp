#include "refine/trials.h"

#include <numeric>

#include "refine/relaxation.h"

namespace nonobtuse::refine {

PatchScore score(const Patch& patch, const TrialOptions& options) {
  return patch.score(options.shape, AngleTest(options.promise), AngleTest(options.goal));
}

std::optional<Patch> try_edits(const Patch& patch, const std::vector<Edit>& edits,
                               const TrialOptions& options) {
  Patch trial = patch;
  for (const Edit& edit : edits) {
    if (!trial.possible(edit)) return std::nullopt;
    trial.apply_with_samples(edit);
  }
  const RelaxationOptions relaxation{options.shape, options.passes, options.on_surface};
  const parallel::Workers serial(1);
  const std::vector<Index> free = trial.inner_vertices();
  std::vector<Index> triangles;
  for (Index t = 0; t < trial.mesh.triangle_capacity(); ++t)
    if (trial.mesh.alive_triangle(t)) triangles.push_back(t);
  for (int round = 0; round < 2; ++round) {
    relax(trial.mesh, trial.fidelity, free, relaxation, serial);
    trial.fidelity.rewalk(trial.mesh, triangles);
  }
  return trial;
}

std::optional<Patch> best_of(const Patch& patch, const std::vector<std::vector<Edit>>& sequences,
                             const TrialOptions& options, const parallel::Workers& workers,
                             PatchScore& best_score) {
  std::vector<std::optional<Patch>> trials(sequences.size());
  std::vector<PatchScore> scores(sequences.size());
  workers.for_each(sequences.size(), 1, [&](std::size_t i) {
    trials[i] = try_edits(patch, sequences[i], options);
    if (trials[i]) scores[i] = score(*trials[i], options);
  });
  std::optional<std::size_t> best;
  for (std::size_t i = 0; i < trials.size(); ++i)
    if (trials[i] && (!best || scores[i] < scores[*best])) best = i;
  if (!best) return std::nullopt;
  best_score = scores[*best];
  return std::move(trials[*best]);
}

}  // namespace nonobtuse::refine
