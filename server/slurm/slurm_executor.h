// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "scene/slurm_settings.h"
#include "server/executor.h"
#include "server/slurm/batch.h"
#include "server/slurm/command.h"
#include "server/slurm/squeue.h"

namespace shaken::server::slurm {

struct SlurmOptions {
  std::filesystem::path folder;            ///< of batches; every node must see it
  std::filesystem::path worker;            ///< the program that does one run, and
  std::filesystem::path task;              ///< the one that does a task; every node must have them at these places
  int threads = 1;                         ///< cores of a task
  int max_pending = 100;                   ///< tasks that wait in Slurm's queue at most
  int runs_per_task = 1;                   ///< where a sweep does not say
  std::vector<std::string> options;        ///< of sbatch, for every batch; those of a sweep follow
  std::chrono::milliseconds poll{10'000};  ///< from one question to Slurm to the next
  std::chrono::milliseconds longest_pause{300'000};  ///< between questions while Slurm does not answer
  /// How long after the end of a task its last words may still not be seen, as on a network file system.
  std::chrono::milliseconds report_delay{90'000};
};

/// Workers as tasks of Slurm's job arrays. They outlive the daemon. What happens to them is known from squeue, and from
/// what the tasks write into the folder of their batch; sacct is not needed. One program of Slurm's runs at a time, and
/// after one that fails nothing is asked for a pause, which doubles.
class SlurmExecutor final : public Executor {
 public:
  explicit SlurmExecutor(SlurmOptions options);

  int room() const override;
  std::string trouble() const override { return silence_; }
  Result<int> start(const Launch& launch) override;
  WorkerReport poll(int worker) override;
  void stop(int worker) override;
  void kill(int worker) override;
  void step() override;
  std::string name(int worker) const override;
  std::optional<int> adopt(const std::string& name) override;

 private:
  using Clock = std::chrono::steady_clock;

  /// A worker; its place in the batch is its index.
  struct Run {
    Launch launch{};  ///< until the batch is written
    bool begun = false;
    bool stop_asked = false;
    bool told = false;  ///< that it has ended
    std::optional<WorkerEnd> end{};
  };
  struct Task {
    QueuedTask::Stage stage = QueuedTask::Stage::kWaiting;
    std::string words{};             ///< Slurm's, for why it waits or how it ended
    int times_over = 0;              ///< answers in a row in which it was over, or was not there
    Clock::time_point over_since{};  ///< the first of them
    bool cancel = false;             ///< it is to be cancelled
    bool if_waits = false;           ///< but only if it still waits
    bool cancelled = false;          ///< by us, since the last answer
    bool was_cancelled = false;      ///< by us, ever
    bool reported = false;           ///< there was a report

    bool is_over() const { return times_over >= 2; }
  };
  enum class Stage {
    kOpen,     ///< takes further workers
    kClosed,   ///< is to be handed over
    kUnsure,   ///< may have been handed over, or not: the next answer tells
    kOut,      ///< Slurm has it
    kRefused,  ///< Slurm does not have it, and will not
  };
  struct Sent {
    BatchFolder folder;
    std::string settings{};
    int runs_per_task = 1;
    Stage stage = Stage::kOpen;
    bool grown = false;    ///< since the last round
    bool adopted = false;  ///< a former daemon has handed it over
    std::string job{};     ///< Slurm's id of the array
    std::string error{};   ///< why it is unsure or refused
    std::vector<Run> runs{};
    std::vector<Task> tasks{};
  };
  struct Handle {
    std::string batch;
    int run = 0;
  };
  enum class Asked { kSubmit, kCancel, kList };

  Sent& open_batch(const std::string& settings, std::string& token);
  static int task_of(const Sent& batch, int run) { return run / batch.runs_per_task; }
  int n_waiting() const;
  int n_unsent() const;
  void close_batches();
  void ask(Asked what, const std::vector<std::string>& words, const std::filesystem::path& folder,
           std::chrono::milliseconds limit);
  void take_answer(const Captured& answer);
  void failed(const std::string& why, std::chrono::milliseconds first_pause);
  bool cancel_tasks();
  bool submit_next();
  void list_tasks();
  void take_list(const std::vector<QueuedTask>& listed);
  void read_reports();
  void read_report_of(Sent& batch, int task);
  void write_stops();
  bool has_unsaid_stops(const std::string& token) const;
  void remove_finished();
  void remove_unknown();
  std::vector<std::string> sbatch_command(const std::string& token, const Sent& batch) const;
  WorkerReport state_of(const Sent& batch, const Run& run, int task) const;

  SlurmOptions options_;
  std::map<std::string, Sent> batches_;  ///< by their token, which is part of their name in Slurm
  std::map<int, Handle> handles_;
  int last_handle_ = 0;
  /// Of one array. Slurm's own limit (MaxArraySize) is 1,001 where nobody has changed it; halved where it refuses.
  std::size_t most_tasks_ = 500;
  int budget_ = 0;  ///< workers that this round still takes
  /// Tasks whose file of stops is to be written, by their batch and number.
  std::set<std::pair<std::string, int>> unsaid_stops_;
  bool refilling_ = true;
  bool looked_for_unknown_ = false;

  std::optional<Command> command_;
  Asked asked_ = Asked::kList;
  Clock::time_point asked_at_{};
  std::string submitted_;      ///< token of the batch that is being handed over
  bool first_cancel_ = false;  ///< the last scancel named a task for the first time
  std::string trouble_;        ///< with Slurm; empty while it answers
  std::string silence_;        ///< the same in a sentence, where it does not answer at all
  std::chrono::milliseconds pause_{0};
  Clock::time_point ask_after_{};
  Clock::time_point list_after_{};
  Clock::time_point read_after_{};
  Clock::time_point write_stops_after_{};
};

}  // namespace shaken::server::slurm
