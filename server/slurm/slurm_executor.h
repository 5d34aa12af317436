#pragma once

#include <chrono>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "server/executor.h"
#include "server/slurm/sent_batch.h"
#include "server/slurm/slurm_call.h"
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
/// what the tasks write into the folder of their batch; sacct is not needed. It leads three kinds of machines: batches,
/// their tasks, and the one call of Slurm.
class SlurmExecutor final : public Executor {
 public:
  explicit SlurmExecutor(SlurmOptions options);

  int room() const override;
  std::string trouble() const override { return call_.silence(); }
  Result<int> start(const Launch& launch) override;
  WorkerReport poll(int worker) override;
  void stop(int worker) override { batch_of(worker).stop(handles_.at(worker).run); }
  void kill(int worker) override { batch_of(worker).kill(handles_.at(worker).run); }
  void step() override;
  std::string name(int worker) const override;
  std::optional<int> adopt(const std::string& name) override;

 private:
  using Clock = std::chrono::steady_clock;
  struct Handle {
    std::string batch;
    int run = 0;
  };

  SentBatch& batch_of(int worker) { return batches_.at(handles_.at(worker).batch); }
  int n_waiting() const;
  void write_stops();
  void read_reports();
  bool cancel_tasks();
  bool submit_next();
  void list_tasks();
  void handle_answer(const SlurmCall::Answer& answer);
  void handle_submitted(const SlurmCall::Answer& answer);
  void update_tasks(const std::vector<QueuedTask>& listed);
  void remove_finished();
  void remove_unknown();
  std::vector<std::string> sbatch_command(const std::string& token, const SentBatch& batch) const;

  SlurmOptions options_;
  SlurmCall call_;
  std::map<std::string, SentBatch> batches_;  ///< by their token, which is part of their name in Slurm
  std::map<int, Handle> handles_;
  int last_handle_ = 0;
  /// The most tasks of one array. Slurm's own limit (MaxArraySize) is 1,001 where nobody has changed it; halved where
  /// it refuses.
  std::size_t most_tasks_ = 500;
  int budget_ = 0;  ///< workers that this round still takes
  bool refilling_ = true;
  bool looked_for_unknown_ = false;
  std::string submitted_;      ///< token of the batch that is being handed over
  bool first_cancel_ = false;  ///< the last scancel named a task for the first time
  Clock::time_point list_after_{}, read_after_{}, write_stops_after_{};
};

}  // namespace shaken::server::slurm
