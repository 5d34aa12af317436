#include "base/progress_line.h"

#include <fmt/format.h>
#include <unistd.h>

#include <iostream>

#include "base/clock.h"
#include "base/terminal.h"
#include "base/text.h"

namespace shaken {
namespace {

constexpr double kTerminalPeriod = 0.2;  ///< between two redrawings [s]
constexpr double kLogPeriod = 10.0;      ///< between two lines in a log [s]
constexpr int kUsualWidth = 80;

}  // namespace

ProgressLine::ProgressLine(std::string what)
    : ProgressLine(std::cerr, isatty(STDERR_FILENO) == 1, terminal_size(STDERR_FILENO).value_or(TerminalSize{}).columns,
                   kLogPeriod) {
  what_ = std::move(what);
  if (!is_terminal_) shown_ = begun_;
}

ProgressLine::ProgressLine(std::ostream& out, bool is_terminal, int width, double log_period)
    : out_(&out),
      is_terminal_(is_terminal),
      width_(width > 0 ? width : kUsualWidth),
      period_(is_terminal ? kTerminalPeriod : log_period),
      begun_(wall_seconds()),
      shown_(begun_ - period_) {}

bool ProgressLine::is_due() {
  const double now = wall_seconds();
  if (period_ <= 0 || now - shown_ < period_) return false;
  shown_ = now;
  return true;
}

void ProgressLine::show(const std::string& text) {
  if (!is_due()) return;
  if (is_terminal_) {
    *out_ << "\r" << fitted(text, static_cast<std::size_t>(width_ - 1)) << "\x1b[K" << std::flush;
    is_dirty_ = true;
  } else {
    *out_ << text << std::endl;
  }
}

void ProgressLine::show(double fraction) {
  std::string text = fmt::format("{}: {:.0f} %", what_, 100 * fraction);
  if (fraction > 0) {
    text += fmt::format(", {} left", duration_text((wall_seconds() - begun_) * (1 - fraction) / fraction));
  }
  show(text);
}

void ProgressLine::end_with(const std::string& text) {
  clear();
  *out_ << text << std::endl;
}

void ProgressLine::clear() {
  if (is_dirty_) *out_ << "\r\x1b[K" << std::flush;
  is_dirty_ = false;
}

}  // namespace shaken
