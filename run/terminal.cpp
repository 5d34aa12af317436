// SPDX-License-Identifier: MIT
#include "run/terminal.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace shaken::run {
namespace {

constexpr WallSeconds kLinePeriod{5};
constexpr int kBarWidth = 24;

bool stderr_is_terminal() { return isatty(STDERR_FILENO) == 1; }

}  // namespace

std::string describe_duration(double seconds) {
  if (!(seconds >= 0) || seconds > 1e9) return "unknown";
  if (seconds < 10) return fmt::format("{:.1f} s", seconds);
  const auto s = static_cast<long>(std::lround(seconds));
  if (s < 60) return fmt::format("{} s", s);
  if (s < 3600) return fmt::format("{} min {:02} s", s / 60, s % 60);
  if (s < 86400) return fmt::format("{} h {:02} min", s / 3600, s / 60 % 60);
  return fmt::format("{} d {} h", s / 86400, s / 3600 % 24);
}

std::string describe_progress(const Progress& progress) {
  const double fraction = std::clamp(progress.fraction(), 0.0, 1.0);
  const int filled = static_cast<int>(fraction * kBarWidth);
  std::string text = fmt::format("[{:-<{}}] {:5.1f} %  {:.4g} of {:.4g} s", std::string(filled, '#'), kBarWidth,
                                 100 * fraction, progress.sim_time, progress.sim_time_total);
  if (progress.state == "running") {
    text += fmt::format("  {:.3g} s/s  ETA {}", progress.sim_rate, describe_duration(progress.eta));
  } else {
    text += "  " + progress.state;
  }
  return text + fmt::format("  S {:.3f}", progress.order);
}

ProgressDisplay::ProgressDisplay(bool quiet)
    : quiet_(quiet), terminal_(stderr_is_terminal()), line_pacer_(kLinePeriod, WallClock::now()) {}

void ProgressDisplay::show(const Progress& progress) {
  const bool last = progress.state != "running" && progress.state != "rendering";
  if (quiet_ || (!terminal_ && !line_pacer_.take(WallClock::now()) && !last)) return;
  const std::string text = describe_progress(progress);
  if (terminal_) {
    fmt::print(stderr, "\r\x1b[2K{}{}", text, last ? "\n" : "");
  } else {
    fmt::print(stderr, "{}\n", text);
  }
  std::fflush(stderr);
}

}  // namespace shaken::run
