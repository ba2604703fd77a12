// Progress and cancellation as the steps of the pipeline see them.
#pragma once

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include "nonobtuse/context.h"
#include "nonobtuse/result.h"

namespace nonobtuse::parallel {

/// Maps the fraction of a stage to the fraction of the whole call and remembers a cancellation.
/// Belongs to the calling thread; only `cancelled` may be asked from others.
class Monitor {
 public:
  /// Iterations are noted in `history` unless it is null.
  explicit Monitor(const Context& context, std::vector<IterationRecord>* history = nullptr)
      : context_(context), history_(history) {}

  /// A stage covers [from, to] of the whole call.
  void begin_stage(std::string_view stage, double from, double to) {
    stage_ = stage;
    from_ = from;
    to_ = to;
    tick(0);
  }

  /// Reports; returns false once the call is cancelled, after which the step should return the
  /// best valid state it has. Call it at least every 50 ms of work.
  bool tick(double fraction_of_stage, long long obtuse = -1, std::string_view message = {}) {
    const double f = from_ + (to_ - from_) * std::clamp(fraction_of_stage, 0.0, 1.0);
    reported_ = std::max(reported_, f);
    if (!stopped_ && context_.progress &&
        !context_.progress(Progress{stage_, reported_, message, obtuse}))
      stopped_ = true;
    return !cancelled();
  }

  /// The same where finding out the number of obtuse triangles takes time: `obtuse()` is asked only
  /// if somebody listens.
  template <class Obtuse>
  bool tick_counting(double fraction_of_stage, const Obtuse& obtuse) {
    return tick(fraction_of_stage, context_.progress ? obtuse() : -1);
  }

  /// Whether it is worth finding out what `record` wants to know.
  [[nodiscard]] bool recording() const { return history_ != nullptr; }

  /// Notes an iteration of the present stage.
  void record(int iteration, double energy, Index obtuse, Index small) {
    if (history_ != nullptr) history_->push_back({stage_, iteration, energy, obtuse, small});
  }

  [[nodiscard]] bool cancelled() const { return stopped_ || context_.cancelled(); }

 private:
  const Context& context_;
  std::vector<IterationRecord>* history_;
  std::string stage_;
  double from_ = 0;
  double to_ = 1;
  double reported_ = 0;
  bool stopped_ = false;
};

}  // namespace nonobtuse::parallel
