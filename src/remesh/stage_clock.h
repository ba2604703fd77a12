// Progress and seconds of the pipeline's stages.
#pragma once

#include <algorithm>
#include <chrono>
#include <string>
#include <vector>

#include "nonobtuse/result.h"
#include "parallel/monitor.h"

namespace nonobtuse::pipeline {

/// Runs stages, tells the monitor where they stand in the whole call and adds up their seconds;
/// stages of several parts of a surface count together.
class StageClock {
 public:
  StageClock(parallel::Monitor& monitor, std::vector<StageTime>& times)
      : monitor_(monitor), times_(times) {}

  [[nodiscard]] parallel::Monitor& monitor() { return monitor_; }

  /// The stages that follow cover [from, to] of the whole call.
  void begin_part(double from, double to) {
    from_ = from;
    to_ = to;
  }

  /// Runs `step`, a stage that covers [from, to] of its part; returns what it returns.
  template <class Step>
  decltype(auto) run(const char* stage, double from, double to, const Step& step) {
    monitor_.begin_stage(stage, from_ + from * (to_ - from_), from_ + to * (to_ - from_));
    const Timer timer(*this, stage);
    return step();
  }

 private:
  struct Timer {
    Timer(StageClock& clock_, const char* stage_) : clock(clock_), stage(stage_) {}
    Timer(const Timer&) = delete;
    Timer& operator=(const Timer&) = delete;
    ~Timer() {
      const std::chrono::duration<double> d = std::chrono::steady_clock::now() - start;
      clock.add(stage, d.count());
    }
    StageClock& clock;
    const char* stage;
    std::chrono::steady_clock::time_point start = std::chrono::steady_clock::now();
  };

  void add(const char* stage, double seconds) {
    const auto known = std::find_if(times_.begin(), times_.end(),
                                    [&](const StageTime& t) { return t.stage == stage; });
    if (known != times_.end()) {
      known->seconds += seconds;
    } else {
      times_.push_back({stage, seconds});
    }
  }

  parallel::Monitor& monitor_;
  std::vector<StageTime>& times_;
  double from_ = 0;
  double to_ = 1;
};

}  // namespace nonobtuse::pipeline
