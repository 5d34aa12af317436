#include "base/memory.h"

#include <sys/resource.h>

#include <atomic>
#include <cstddef>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <new>
#include <string>

namespace shaken {
namespace {

constexpr std::size_t kBytes = std::size_t{4} << 20;
std::atomic<void*> reserve{nullptr};

/// What operator new calls before it tries once more.
void give_it_up() {
  void* kept = reserve.exchange(nullptr);
  if (kept == nullptr) throw std::bad_alloc();
  std::free(kept);
}

constexpr double kKib = 1024;

}  // namespace

void keep_memory_in_reserve() {
  if (reserve != nullptr) return;
  std::free(reserve.exchange(std::malloc(kBytes)));
  std::set_new_handler(give_it_up);
}

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
