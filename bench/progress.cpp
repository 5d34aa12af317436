// SPDX-License-Identifier: MIT
#include "bench/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>

#include "bench/clock.h"

namespace shaken::bench {
namespace {

constexpr double kTerminalPeriod = 0.2;  ///< between two redrawings [s]
constexpr double kLinePeriod = 10.0;     ///< between two lines in a log [s]

}  // namespace

std::string duration_text(double seconds) {
  if (seconds < 10) return fmt::format("{:.1f} s", seconds);
  const long s = std::lround(seconds);
  if (s < 60) return fmt::format("{} s", s);
  if (s < 3600) return fmt::format("{} min {:02} s", s / 60, s % 60);
  return fmt::format("{} h {:02} min", s / 3600, s / 60 % 60);
}

ProgressLine::ProgressLine(std::string what)
    : what_(std::move(what)),
      terminal_(isatty(STDERR_FILENO) == 1),
      started_(wall_seconds()),
      shown_(terminal_ ? 0 : started_) {}

ProgressLine::~ProgressLine() {
  if (terminal_) fmt::print(stderr, "\r\x1b[2K");
  std::fflush(stderr);
}

void ProgressLine::show(double fraction) {
  const double now = wall_seconds();
  if (now - shown_ < (terminal_ ? kTerminalPeriod : kLinePeriod)) return;
  shown_ = now;
  std::string line = fmt::format("{}: {:.0f} %", what_, 100 * fraction);
  if (fraction > 0) line += fmt::format(", {} left", duration_text((now - started_) * (1 - fraction) / fraction));
  fmt::print(stderr, "{}{}{}", terminal_ ? "\r\x1b[2K" : "", line, terminal_ ? "" : "\n");
  std::fflush(stderr);
}

}  // namespace shaken::bench
