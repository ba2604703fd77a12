// One line on stderr that tells how far the work is.
#pragma once

#include <chrono>
#include <string>

#include "nonobtuse/context.h"

namespace nonobtuse::tool {

enum class ProgressStyle { None, Bar, Lines };

/// A bar on a terminal; one line per stage where progress was asked for without one; else nothing.
ProgressStyle progress_style(bool asked_for, bool quiet);

class ProgressBar {
 public:
  explicit ProgressBar(ProgressStyle style) : style_(style) {}
  ~ProgressBar() { clear(); }
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  void show(const Progress& progress);
  /// Removes the bar from the terminal.
  void clear();

 private:
  ProgressStyle style_;
  std::string stage_;
  bool visible_ = false;
  std::chrono::steady_clock::time_point drawn_;
};

}  // namespace nonobtuse::tool
