#pragma once

#include <sys/types.h>

#include <chrono>
#include <filesystem>
#include <string>
#include <vector>

#include "base/scratch_folder.h"

namespace shaken::test {

/// The path of a program of this build.
inline std::string program(const std::string& name) { return std::string(SHAKEN_BIN_DIR) + "/" + name; }

/// A child process whose stdout and stderr go to files. Killed if still alive at the end.
class Process {
 public:
  Process(const std::vector<std::string>& command, std::filesystem::path output);
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;
  ~Process();

  pid_t pid() const { return pid_; }
  void signal(int number) const;
  /// Exit code, or 128 + signal; -1 if it has not ended by then.
  int wait(std::chrono::seconds limit);
  /// Everything printed so far.
  std::string output() const;
  /// True once the output holds `text`; false if that has not happened by then or the process has ended without it.
  bool wait_for(const std::string& text, std::chrono::seconds limit);

 private:
  bool poll();

  pid_t pid_ = -1;
  int status_ = -1;
  bool ended_ = false;
  std::filesystem::path output_;
};

/// Runs a command to its end.
struct Finished {
  int code;
  std::string output;  ///< stdout and stderr
};
Finished run_command(const std::vector<std::string>& command, std::chrono::seconds limit = std::chrono::seconds(60));

}  // namespace shaken::test
