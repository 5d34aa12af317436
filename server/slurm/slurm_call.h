#pragma once

#include <chrono>
#include <filesystem>
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

/// The one program of Slurm's that runs at a time. After one that fails nothing is asked for a pause, which doubles
/// until squeue answers.
class SlurmCall {
 public:
  enum class Kind { kSubmit, kCancel, kList };
  struct Answer {
    Kind kind;
    Captured said;
    bool came_at_once = false;
    bool reached_slurm = true;  ///< false: the program could not be started
    bool is_fine() const { return said.exit_code == 0; }
    /// The words of a program that failed, on one line.
    std::string in_one_line() const;
  };

  explicit SlurmCall(std::chrono::milliseconds longest_pause) : longest_pause_(longest_pause) {}

  /// Whether the program that was started last still runs.
  bool is_busy() const { return command_.has_value(); }
  bool is_pausing() const { return Clock::now() < next_call_; }
  void start(Kind kind, const std::vector<std::string>& words, const std::filesystem::path& folder);
  /// Its answer, told once; none while it runs, or if there is nothing to tell.
  std::optional<Answer> poll();

  void set_failed(const std::string& why, std::chrono::milliseconds first_pause);
  /// squeue has answered.
  void set_fine();
  /// squeue has not.
  void set_silent() { silence_ = "Slurm does not answer: " + trouble_; }
  /// With Slurm; empty while it answers.
  const std::string& trouble() const { return trouble_; }
  /// The same in a sentence, where it does not answer at all.
  const std::string& silence() const { return silence_; }

 private:
  using Clock = std::chrono::steady_clock;
  std::chrono::milliseconds longest_pause_;
  Kind kind_ = Kind::kList;
  std::optional<Command> command_;
  std::optional<Answer> not_started_;
  Clock::time_point started_{};
  std::string trouble_, silence_;
  std::chrono::milliseconds pause_{0};
  Clock::time_point next_call_{};
};

}  // namespace shaken::server::slurm
