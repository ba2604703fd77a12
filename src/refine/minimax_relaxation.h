// Relaxation of a patch against its largest distance from the surface and its angles at once.
#pragma once

#include <cstdint>
#include <optional>

#include "refine/largest_distance.h"
#include "refine/trials.h"

namespace nonobtuse::refine {

class MinimaxRelaxation {
 public:
  /// `allowed`: of what the patch competes with; to be better than that in folds, valences and the
  /// promised angles is worth nothing. Distances below options.far do not count.
  MinimaxRelaxation(Patch patch, const TrialOptions& options, const PatchScore& allowed);

  /// A few passes each, with new weights before. Ends early where nothing is left to do.
  void run(int rounds);

  /// The best patch on the way, nothing before the first round, and its score.
  std::optional<Patch> best;
  PatchScore best_score;

  /// Least of the largest distances on the way, whatever the angles were.
  [[nodiscard]] double least_distance() const { return least_distance_; }
  /// Vertices moved so far, once in every pass.
  [[nodiscard]] std::int64_t effort() const;
  /// Whether going on is worth more than with the other. Early on the way it says less how near the
  /// angles have come to the goal than how near the patch is to the surface.
  [[nodiscard]] bool more_promising(const MinimaxRelaxation& other) const;

 private:
  void renew_weights();

  Patch patch_;
  TrialOptions options_;
  PatchScore allowed_;
  std::vector<double> weights_;    // of the fidelity at the beginning
  std::vector<double> emphasis_;   // their factors
  std::vector<FarWeight> points_;  // far now
  double least_distance_;
  int rounds_ = 0;
};

}  // namespace nonobtuse::refine
