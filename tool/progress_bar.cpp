#include "progress_bar.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <string_view>

namespace nonobtuse::tool {
namespace {

constexpr int kBarWidth = 24;
constexpr auto kRedrawInterval = std::chrono::milliseconds(50);

std::string status_of(const Progress& progress) {
  std::string text = fmt::format("{:3.0f} %  {}", 100 * progress.fraction, progress.stage);
  if (progress.obtuse >= 0) text += fmt::format("  {} obtuse", progress.obtuse);
  if (!progress.message.empty()) text += fmt::format("  {}", progress.message);
  return text;
}

}  // namespace

ProgressStyle progress_style(bool asked_for, bool quiet) {
  if (quiet) return ProgressStyle::None;
  const char* terminal = std::getenv("TERM");
  const bool can_redraw = terminal != nullptr && std::string_view(terminal) != "dumb";
  if (isatty(STDERR_FILENO) == 1 && can_redraw) return ProgressStyle::Bar;
  return asked_for ? ProgressStyle::Lines : ProgressStyle::None;
}

void ProgressBar::show(const Progress& progress) {
  if (style_ == ProgressStyle::None) return;
  const bool new_stage = progress.stage != stage_;
  stage_ = progress.stage;
  if (style_ == ProgressStyle::Lines) {
    if (new_stage) fmt::print(stderr, "{}\n", status_of(progress));
    return;
  }
  const auto now = std::chrono::steady_clock::now();
  if (visible_ && !new_stage && now - drawn_ < kRedrawInterval) return;
  const int filled = std::clamp(static_cast<int>(progress.fraction * kBarWidth), 0, kBarWidth);
  // Return to the start of the line, draw, erase what a longer line before has left.
  fmt::print(stderr, "\r[{:#<{}}{:.<{}}] {}\x1b[K", "", filled, "", kBarWidth - filled,
             status_of(progress));
  std::fflush(stderr);
  visible_ = true;
  drawn_ = now;
}

void ProgressBar::clear() {
  if (!visible_) return;
  std::fputs("\r\x1b[K", stderr);
  std::fflush(stderr);
  visible_ = false;
}

}  // namespace nonobtuse::tool
