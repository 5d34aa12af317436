#include "base/plots_by_python.h"

#include <fmt/format.h>

#include <cstdlib>
#include <filesystem>
#include <sstream>

#include "base/failure.h"
#include "base/paths.h"
#include "base/process.h"
#include "base/text.h"

namespace shaken {

std::string chosen_python() {
  const char* chosen = std::getenv("SHAKEN_PYTHON");
  return chosen != nullptr ? chosen : "";
}

std::vector<std::string> python_command(const std::string& module) {
  constexpr const char* kDebian = "/usr/bin/python3";
  std::error_code unknown;
  std::vector<std::string> command{chosen_python()};
  if (command[0].empty()) {
    // with its own packages alone: those of a user, or of a module of a cluster, may not go with them
    command = {std::filesystem::exists(kDebian, unknown) ? kDebian : "python3", "-s", "-E"};
  }
  const std::filesystem::path program = shipped_python() / "shaken" / module / "__main__.py";
  if (!std::filesystem::exists(program, unknown)) {
    throw Failure(
        ExitCode::kFailed,
        fmt::format("{} is not there: `apt install python3-shaken`, whose Python does this", program.string()));
  }
  // By its path, which also says in words what else is not installed.
  command.insert(command.end(), {"-W", "ignore", program});
  return command;
}

std::vector<std::string> plots_by_python(const std::vector<std::string>& arguments, std::string_view input) {
  std::vector<std::string> command = python_command("plots");
  command.insert(command.end(), arguments.begin(), arguments.end());
  const Captured drawn = run_with_input(command, input);
  std::vector<std::string> lines;
  std::istringstream output(drawn.output);
  for (std::string line; std::getline(output, line);) lines.push_back(printable(line));
  if (drawn.exit_code == 0) return lines;
  if (constexpr int kNotStarted = 127; drawn.exit_code == kNotStarted) {
    throw Failure(ExitCode::kBadInput, fmt::format("figures are drawn by Python: {} (`apt install python3-matplotlib "
                                                   "python3-numpy python3-h5py`, or set SHAKEN_PYTHON)",
                                                   printable(drawn.output)));
  }

  // in its own words, which other lines may come before where it had drawn some already; of a traceback the last line
  const bool has_words = drawn.exit_code == 1 || drawn.exit_code == 2;
  const bool is_traceback = drawn.output.find("Traceback (most recent call last)") != std::string::npos;
  std::string words;
  for (const std::string& line : lines) words += (words.empty() ? "" : "\n") + line;
  if (is_traceback || !has_words) {
    words = fmt::format("{} -m shaken.plots ended with exit code {}{}", command[0], drawn.exit_code,
                        lines.empty() ? "" : ": " + lines.back());
  }
  throw Failure(drawn.exit_code == 2 && !is_traceback ? ExitCode::kBadInput : ExitCode::kFailed, words);
}

}  // namespace shaken
