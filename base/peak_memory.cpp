#include "base/peak_memory.h"

#include <sys/resource.h>

#include <fstream>
#include <limits>
#include <string>

namespace shaken {
namespace {

constexpr double kKib = 1024;

}  // namespace

double peak_memory() {
  // not getrusage, which also counts what the process held before it became this program
  std::ifstream status("/proc/self/status");
  for (std::string name; status >> name; status.ignore(std::numeric_limits<std::streamsize>::max(), '\n')) {
    if (double kib = 0; name == "VmHWM:" && status >> kib) return kKib * kib;
  }
  return 0;
}

double children_peak_memory() {
  rusage usage{};
  getrusage(RUSAGE_CHILDREN, &usage);
  return kKib * static_cast<double>(usage.ru_maxrss);
}

}  // namespace shaken
