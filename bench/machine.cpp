// SPDX-License-Identifier: MIT
#include "bench/machine.h"

#include <fmt/format.h>

#include <fstream>
#include <thread>

#include "run/files/version.h"

namespace shaken::bench {
namespace {

std::string cpu_name() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);) {
    const std::size_t colon = line.find(": ");
    if (line.starts_with("model name") && colon != std::string::npos) return line.substr(colon + 2);
  }
  return "unknown CPU";
}

}  // namespace

Machine this_machine() {
  return {cpu_name(), static_cast<int>(std::thread::hardware_concurrency()), run::compiler(), SHAKEN_BENCH_FLAGS};
}

std::string describe(const Machine& machine) {
  return fmt::format("{}, {} cores; {}; {}", machine.cpu, machine.cores, machine.compiler, machine.flags);
}

nlohmann::ordered_json to_json(const Machine& machine) {
  return {{"cpu", machine.cpu}, {"cores", machine.cores}, {"compiler", machine.compiler}, {"flags", machine.flags}};
}

}  // namespace shaken::bench
