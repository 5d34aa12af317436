// SPDX-License-Identifier: MIT
#include "bench/accuracy/report.h"

#include <fmt/format.h>

#include "bench/machine.h"
#include "run/files/version.h"

namespace shaken::bench {

std::string accuracy_heading() { return fmt::format("shaken {} on {}\n", run::version(), describe(this_machine())); }

nlohmann::ordered_json accuracy_head(const char* part) {
  return {{"bench", fmt::format("accuracy {}", part)},
          {"version", run::version()},
          {"machine", to_json(this_machine())},
          {"rows", nlohmann::ordered_json::array()}};
}

}  // namespace shaken::bench
