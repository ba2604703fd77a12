// Trying sequences of edits on copies of a patch: edit, relax, compare.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "parallel/workers.h"
#include "refine/patch.h"

namespace nonobtuse::refine {

class FoldTest;

/// What trials may still cost, in relaxations of single vertices: a mesh that resists is given up
/// after work in proportion to its size, however many places are left.
class TrialBudget {
 public:
  explicit TrialBudget(std::int64_t work) : left_(work) {}
  void spend(std::int64_t work) { left_ -= work; }
  [[nodiscard]] bool exhausted() const { return left_ <= 0; }

  std::vector<Triangle> resisting;  ///< vertices of triangles that nothing helped, sorted
  /// Where balance_count makes up for a vertex more (0) and one less (1): places not tried yet, the
  /// best last, so that none is searched for, or tried in vain, again and again. Without: the whole
  /// mesh is searched every time.
  std::optional<std::array<std::vector<Index>, 2>> places;

 private:
  std::int64_t left_;
};

struct TrialOptions {
  energy::ShapeWeights shape;  ///< to relax and to compare by
  AngleGoal promise = kPromise;
  AngleGoal goal;
  int passes = 6;  ///< Gauss-Seidel passes over the patch, twice
  bool on_surface = false;
  /// Largest distances beyond this are compared (before the energy), and relaxation works against
  /// them; infinity: distances count by their energy alone.
  double far = std::numeric_limits<double>::infinity();
  const FoldTest* folds = nullptr;  ///< if any, counts folds as it does and not by the feet alone
  TrialBudget* budget = nullptr;    ///< shared; none: whatever it takes
};

/// Gauss-Seidel passes over the inner vertices of a patch, then the feet of its triangles anew;
/// `gauss_newton` as in RelaxationOptions.
void relax_patch(Patch& patch, const TrialOptions& options, int passes, bool gauss_newton);

PatchScore score(const Patch& patch, const TrialOptions& options);

/// The best of several sequences by score, with its score; nothing if none is possible or the
/// budget is exhausted. Parallel over the sequences.
std::optional<Patch> best_of(const Patch& patch, const std::vector<std::vector<Edit>>& sequences,
                             const TrialOptions& options, const parallel::Workers& workers,
                             PatchScore& best_score);

}  // namespace nonobtuse::refine
