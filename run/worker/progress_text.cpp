#include "run/worker/progress_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/text.h"

namespace shaken::run {
namespace {

constexpr int kBarWidth = 24;

}  // namespace

std::string describe_progress(const Progress& progress) {
  const double fraction = std::clamp(progress.fraction(), 0.0, 1.0);
  std::string text = fmt::format("{} {:5.1f} %  {:.4g} of {:.4g} s", bar_text(fraction, kBarWidth), 100 * fraction,
                                 progress.sim_time, progress.sim_time_total);
  if (progress.state == "running") {
    text += fmt::format("  {:.3g} s/s  ETA {}", progress.sim_rate, duration_text(progress.eta));
  } else if (progress.state == "rendering") {
    text += fmt::format("  drawing {:.0f} %  ETA {}", 100 * progress.drawn, duration_text(progress.eta));
  } else {
    text += "  " + progress.state;
  }
  return std::isnan(progress.order) ? text : text + fmt::format("  S {:.3f}", progress.order);
}

bool is_under_way(const Progress& progress) { return progress.state == "running" || progress.state == "rendering"; }

}  // namespace shaken::run
