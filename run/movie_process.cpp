// SPDX-License-Identifier: MIT
#include "run/movie_process.h"

#include <chrono>
#include <csignal>
#include <string>
#include <thread>

#include "base/process.h"

namespace shaken::run {
namespace {

/// How `child` ended; ends it first if `stop` becomes true.
ProcessEnd wait_for(pid_t child, const std::atomic<bool>& stop) {
  constexpr std::chrono::milliseconds kPause{20};
  bool asked = false;
  for (;;) {
    if (const auto end = poll_child(child)) return *end;
    if (stop && !asked) {
      kill(child, SIGTERM);
      asked = true;
    }
    std::this_thread::sleep_for(kPause);
  }
}

}  // namespace

Result<void> render_movie(const std::filesystem::path& directory, const std::atomic<bool>& stop) {
  const std::string program = sibling_program("shaken-render").string();
  const Result<pid_t> child = start_child({.command = {program, "movie", directory.string()}, .ends_with_us = true});
  if (!child) return child.error();
  const ProcessEnd end = wait_for(*child, stop);
  if (stop) return Error{"stopped while drawing"};
  if (!end.is_success()) return Error{program + " " + end.text()};
  return {};
}

}  // namespace shaken::run
