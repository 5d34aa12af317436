#include "run/files/foreign_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdio>

#include "base/process.h"
#include "run/files/content_hash.h"
#include "run/files/frame_log.h"
#include "run/files/observables_file.h"
#include "run/files/trajectory.h"

namespace shaken::run {
namespace {

constexpr std::chrono::seconds kLimit{60};
/// Frames of a long trajectory that are read, evenly spaced.
constexpr std::size_t kMostFrames = 200;

Result<void> read_frames(const TrajectoryReader& frames) {
  const std::size_t step = std::max<std::size_t>(1, frames.n_frames() / kMostFrames);
  for (std::size_t k = 0; k < frames.n_frames(); k += step) {
    if (const auto frame = frames.frame(k); !frame) return frame.error();
  }
  return {};
}

}  // namespace

Result<void> try_to_read(const std::filesystem::path& file) {
  if (has_hash(file)) return {};
  if (const Result<bool> is_log = is_frame_log(file); !is_log || *is_log) return {};
  const std::vector<std::string> command{sibling_program("shaken-worker").string(), "read", file.string()};
  const Captured read = run_captured(command, CaptureLimits{.time = kLimit});
  constexpr int kSignalled = 128;                                  // and what is above it
  if (!read.cut_short && read.exit_code <= kSignalled) return {};  // the caller says what is wrong with it
  return Error{fmt::format("{} cannot be read: it {}, as damaged files do", file.string(),
                           read.cut_short ? fmt::format("kept its reader for over {} s", kLimit.count())
                                          : fmt::format("ended its reader (signal {})", read.exit_code - kSignalled))};
}

int read_command(int argc, char** argv) {
  if (argc != 2) {
    std::fputs("shaken-worker read FILE is asked by the other programs\n", stderr);
    return 2;
  }
  try {
    const std::filesystem::path file = argv[1];
    if (const auto frames = TrajectoryReader::open(file)) return read_frames(*frames) ? 0 : 1;
    return read_observables(file) ? 0 : 1;
  } catch (const std::exception&) {  // no memory for what a damaged file asks for
    return 1;
  }
}

}  // namespace shaken::run
