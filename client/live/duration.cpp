#include "client/live/duration.h"

#include <fmt/format.h>

#include "base/failure.h"
#include "base/keys/units.h"

namespace shaken::client {

double duration_option(const std::string& option, const std::string& text) {
  constexpr double kDay = 86400;  // scenes, which have the other units, are too short for it
  double seconds = 0;
  if (const auto written = keys::split_quantity(text); written && written->unit == "d") {
    seconds = written->number.value() * kDay;
  } else if (const auto time = keys::parse_quantity(text, keys::Dimension::kTime)) {
    seconds = *time;
  } else {
    throw Failure(ExitCode::kBadInput,
                  fmt::format("{}: {} (write 90s, 10min, 2h or 30d)", option, time.error().message));
  }
  if (!(seconds > 0)) throw Failure(ExitCode::kBadInput, fmt::format("{}: '{}' is no time", option, text));
  return seconds;
}

}  // namespace shaken::client
