#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "base/core/result.h"
#include "base/descriptor.h"
#include "base/process.h"

namespace shaken::server::slurm {

/// A program at work beside us, whose words are kept. One that is forgotten about goes on.
class Command {
 public:
  /// `limit`: wall time, after which it is killed.
  static Result<Command> start(const std::vector<std::string>& words, const std::filesystem::path& folder,
                               std::chrono::milliseconds limit);
  /// What became of it, told once; none while it runs. Exit code 124 and a word about it where its time was over, 1 and
  /// nothing but a word about it where it has said more than anybody would read; both are killed.
  std::optional<Captured> poll();

 private:
  using Clock = std::chrono::steady_clock;
  Command(pid_t child, Descriptor output, Clock::time_point end)
      : child_(child), output_(std::move(output)), end_(end) {}

  pid_t child_;
  Descriptor output_;
  Clock::time_point end_;
};

}  // namespace shaken::server::slurm
