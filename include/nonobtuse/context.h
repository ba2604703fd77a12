// Part of nonobtuse, MIT licence. Progress, cancellation and threads of one call.
#pragma once

#include <atomic>
#include <functional>
#include <string_view>

namespace nonobtuse {

/// What a long call tells while it works. The views are valid only during the callback.
struct Progress {
  std::string_view stage;    ///< "cvt", "extraction", "valence", "refinement", "certification", ...
  double fraction = 0;       ///< of the whole call, in [0, 1], never decreasing
  std::string_view message;  ///< human-readable detail; may be empty
  long long obtuse = -1;     ///< triangles with an angle >= 90 degrees now; -1 while unknown
};

/// How one call runs. Nothing here is global: two calls with two contexts may run at once.
struct Context {
  int threads = 0;  ///< worker threads; 0 = all cores. The result does not depend on it.
  /// Called from the calling thread, between steps; returning false cancels the call.
  std::function<bool(const Progress&)> progress = {};
  /// Polled between steps; set it from any thread (or a signal handler) to cancel.
  const std::atomic<bool>* cancel = nullptr;

  [[nodiscard]] bool cancelled() const noexcept {
    return cancel != nullptr && cancel->load(std::memory_order_relaxed);
  }
};

}  // namespace nonobtuse
