// Compares both steppers in random scenes (tests/support/random_scenes.h), and makes those in which they differ small.
#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "tests/support/random_scenes.h"

namespace {

using namespace shaken;
using Clock = std::chrono::steady_clock;

constexpr const char* kUsage = R"(usage: fuzz_steppers HOW_MANY [FIRST] [JOBS] [FOLDER]
       fuzz_steppers CASE.json ...

Compares the two steppers in random scenes. HOW_MANY is a number of scenes (20000) or a time in seconds (600s); FIRST
is the number of the first case (1). A case in which they differ is made small and written into FOLDER (.), and can be
compared again by its file.
)";

int compare_files(int argc, char** argv) {
  int n_different = 0;
  for (int k = 1; k < argc; ++k) {
    std::ifstream in(argv[k]);
    const auto json = nlohmann::ordered_json::parse(in, nullptr, false);
    if (json.is_discarded() || !json.contains("scene")) {
      std::fprintf(stderr, "%s is no case\n", argv[k]);
      return 2;
    }
    const test::CaseResult result = test::compare_steppers(test::SceneCase::from_json(json));
    std::printf("%s: %s\n", argv[k],
                !result.is_valid            ? result.problem.c_str()
                : result.difference.empty() ? "same"
                                            : result.difference.c_str());
    n_different += !result.difference.empty();
  }
  return n_different == 0 ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  const std::string what = argc > 1 ? argv[1] : "";
  if (what.ends_with(".json")) return compare_files(argc, argv);
  char* end = nullptr;
  const double amount = std::strtod(what.c_str(), &end);
  const bool by_time = std::string_view(end) == "s";
  if (what.empty() || !(amount > 0) || (*end != '\0' && !by_time)) {
    std::fputs(kUsage, stderr);
    return 2;
  }
  const std::uint64_t first = argc > 2 ? std::strtoull(argv[2], nullptr, 10) : 1;
  const int jobs = argc > 3 ? std::max(1, std::atoi(argv[3])) : 1;
  const std::filesystem::path folder = argc > 4 ? argv[4] : ".";

  std::atomic<std::uint64_t> next = first;
  std::mutex mutex;
  std::int64_t n_valid = 0, n_in_full = 0, n_different = 0, rod_ticks = 0;
  const auto begin = Clock::now();
  const auto seconds = [&] { return std::chrono::duration<double>(Clock::now() - begin).count(); };
  double told = 0;
  const auto work = [&] {
    while (true) {
      {
        const std::lock_guard lock(mutex);
        if (by_time ? seconds() >= amount : static_cast<double>(n_valid) >= amount) return;
      }
      const std::uint64_t seed = next++;
      const test::SceneCase one = test::draw_scene_case(seed);
      const test::CaseResult result = test::compare_steppers(one);
      std::string small;
      if (!result.difference.empty()) small = test::shrink(one).to_json().dump(2) + "\n";
      const std::lock_guard lock(mutex);
      n_valid += result.is_valid;
      n_in_full += result.in_full;
      rod_ticks += result.rod_ticks;
      if (!small.empty()) {
        ++n_different;
        const std::filesystem::path file = folder / ("steppers-" + std::to_string(seed) + ".json");
        std::ofstream(file) << small;
        std::printf("case %llu: %s; see %s\n%s", static_cast<unsigned long long>(seed), result.difference.c_str(),
                    file.c_str(), small.c_str());
      }
      if (seconds() - told > 30) {
        told = seconds();
        std::fprintf(stderr, "%lld scenes, %lld different, %.0f s\n", static_cast<long long>(n_valid),
                     static_cast<long long>(n_different), told);
      }
    }
  };
  std::vector<std::thread> workers;
  for (int k = 0; k < jobs; ++k) workers.emplace_back(work);
  for (std::thread& worker : workers) worker.join();
  std::printf(
      "%lld scenes compared (of %llu drawn, the others are refused or cannot be packed), %.3g rod-ticks, "
      "%lld in full, %lld different, %.0f s\n",
      static_cast<long long>(n_valid), static_cast<unsigned long long>(next - first), static_cast<double>(rod_ticks),
      static_cast<long long>(n_in_full), static_cast<long long>(n_different), seconds());
  return n_different == 0 ? 0 : 1;
}
