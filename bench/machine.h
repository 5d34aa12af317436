// SPDX-License-Identifier: MIT
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace shaken::bench {

/// What figures of speed depend on besides the code.
struct Machine {
  std::string cpu;       ///< as the kernel names it
  int cores = 0;         ///< that the kernel shows
  std::string compiler;  ///< with its version and the build type
  std::string flags;     ///< given to it, without those for warnings
};

Machine this_machine();
/// "AMD EPYC, 2 cores; GNU 12.2.0, Release; -O3 -DNDEBUG -ffp-contract=off"
std::string describe(const Machine& machine);
nlohmann::ordered_json to_json(const Machine& machine);

}  // namespace shaken::bench
