// Other programs: found, started, waited for.
#pragma once

#include <sys/types.h>

#include <chrono>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/core/result.h"

namespace shaken {

/// The program `name` that was installed beside this one; `name` alone where this one cannot tell its own place.
std::filesystem::path sibling_program(const std::string& name);

/// Goes on as the program NAME-wide beside this one, NAME, if it is there and this processor has what it needs
/// (packaging/cmake/Options.cmake); returns otherwise. The first thing that `main` does.
void go_on_as_wide_build(char** argv);

/// How a child process ended.
struct ProcessEnd {
  int exit_code = 0;  ///< 0 if a signal ended it
  int signal = 0;     ///< 0 if it exited

  bool is_success() const { return exit_code == 0 && signal == 0; }
  /// As shells tell it: the exit code, or 128 + the signal.
  int shell_code() const { return signal == 0 ? exit_code : 128 + signal; }
  /// "failed with exit code 3", "was ended by signal 9".
  std::string text() const;
};

/// What is started, and what it has in common with this process.
struct ChildSetup {
  std::vector<std::string> command = {};  ///< a path, or a name that is looked for in PATH; then the arguments
  std::filesystem::path folder = {};      ///< where it runs; where this process runs if empty
  int input = -1;                         ///< descriptor that its stdin reads; -1: there is nothing to be read
  int output = -1;                        ///< descriptor that takes its stdout and stderr; -1: where ours go
  bool own_group = false;                 ///< a Ctrl-C on the terminal is not for it, nor for what it starts
  bool ends_with_us = false;              ///< gets SIGTERM when the thread that started it ends
};

/// Starts a child with no other descriptor of ours and no signal blocked. Fails if the program cannot
/// be run, with its name and the system's reason.
Result<pid_t> start_child(const ChildSetup& setup);
/// Waits for a child, and reaps it.
ProcessEnd wait_for_child(pid_t child);
/// How a child ended, which is then reaped; nothing while it runs.
std::optional<ProcessEnd> poll_child(pid_t child);

struct Captured {
  int exit_code = 0;       ///< 128 + signal if a signal ended it; 127 if it could not be started
  std::string output;      ///< stdout and stderr, in the order written
  bool cut_short = false;  ///< it went beyond its limits, and was killed for that
};

/// What a program may take. Beyond that it is killed, with all that it has started.
struct CaptureLimits {
  std::chrono::milliseconds time;
  std::size_t output = std::numeric_limits<std::size_t>::max();  ///< [bytes]
  std::function<bool()> stop = {};  ///< whether it is to end at once; asked ten times a second
};

/// Runs `command` in `folder` until it ends; or until this process does, however that comes: nobody else wants what it
/// writes.
Captured run_captured(const std::vector<std::string>& command, const std::filesystem::path& folder = ".");
/// The same for one that reads `input` on its stdin.
Captured run_with_input(const std::vector<std::string>& command, std::string_view input);
/// The same for one that may hang; a Ctrl-C on the terminal is not for it.
Captured run_captured(const std::vector<std::string>& command, const CaptureLimits& limits);

/// Becomes `command`: the caller's terminal, signals and exit code are then its own. Throws Failure if that fails.
[[noreturn]] void become(const std::vector<std::string>& command);

}  // namespace shaken
