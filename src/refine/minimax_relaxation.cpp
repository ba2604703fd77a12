// Iteratively reweighted least squares for a high power of the distance (Lawson 1961; for powers
// beyond 3 it needs damping: Burrus et al., Iterative reweighted least-squares design of FIR
// filters, 1994). Weights that only grow, and those of the angles with them, soon ruin the patch:
// here both fall again where there is no need.
#include "refine/minimax_relaxation.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

namespace nonobtuse::refine {
namespace {

constexpr int kPassesPerRound = 2;
constexpr double kNear = 0.7;  // part of the largest distance from which on points get more weight
constexpr double kMostEmphasis = 1000;
constexpr double kHingeGrowth = 3, kHingeDecay = 1.5;
constexpr double kOutside = 0.02;  // of the distance, that a triangle outside the goal is worth

}  // namespace

MinimaxRelaxation::MinimaxRelaxation(Patch patch, const TrialOptions& options,
                                     const PatchScore& allowed)
    : patch_(std::move(patch)),
      options_(options),
      allowed_(allowed),
      least_distance_(allowed.distance) {
  best_score.folded = std::numeric_limits<Index>::max();
  weights_.resize(weight_count(patch_.fidelity));
  for (std::size_t i = 0; i < weights_.size(); ++i) weights_[i] = weight(patch_.fidelity, i);
  emphasis_.assign(weights_.size(), 1);
}

void MinimaxRelaxation::renew_weights() {
  std::vector<double> wanted(weights_.size(), 1);
  for (const FarWeight& p : points_) {
    const double ratio = p.distance / (kNear * least_distance_);
    const double cube = ratio * ratio * ratio;
    wanted[p.weight] = std::max(wanted[p.weight], std::min(cube * cube, kMostEmphasis));
  }
  for (std::size_t i = 0; i < weights_.size(); ++i) {
    emphasis_[i] = std::sqrt(emphasis_[i] * wanted[i]);
    weight(patch_.fidelity, i) = emphasis_[i] * weights_[i];
  }
}

void MinimaxRelaxation::run(int rounds) {
  const AngleTest promise(options_.promise), goal(options_.goal);
  double& hinge = options_.shape.hinge;
  for (int round = 0; round < rounds; ++round) {
    ++rounds_;
    renew_weights();
    relax_patch(patch_, options_, kPassesPerRound, true);
    const double far = std::max(options_.far, kNear * least_distance_);
    points_ = far_weights(patch_.mesh, patch_.fidelity, far);
    PatchScore now = patch_.score(options_.shape, promise, goal);
    now.distance = far;
    for (const FarWeight& p : points_) now.distance = std::max(now.distance, p.distance);
    least_distance_ = std::min(least_distance_, now.distance);
    now.folded = std::max(now.folded, allowed_.folded);
    now.bad_valence = std::max(now.bad_valence, allowed_.bad_valence);
    now.outside_promise = std::max(now.outside_promise, allowed_.outside_promise);
    if (now < best_score) best = patch_, best_score = now;
    if (now.outside_goal == 0 && now.distance <= options_.far) break;
    hinge = now.outside_goal > 0 ? kHingeGrowth * hinge : std::max(1.0, hinge / kHingeDecay);
  }
}

std::int64_t MinimaxRelaxation::effort() const {
  return rounds_ * kPassesPerRound * std::ssize(patch_.inner_vertices());
}

bool MinimaxRelaxation::more_promising(const MinimaxRelaxation& other) const {
  const auto rank = [](const PatchScore& s) {
    return std::tuple(s.folded, s.bad_valence,
                      s.distance * (1 + kOutside * static_cast<double>(s.outside_goal)), s.energy);
  };
  return rank(best_score) < rank(other.best_score);
}

}  // namespace nonobtuse::refine
