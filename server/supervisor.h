// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "run/files/directory.h"
#include "server/executor.h"
#include "server/job_end.h"
#include "server/queue.h"

namespace shaken::server {

struct SupervisorOptions {
  std::filesystem::path runs;               ///< folder of the run directories
  int slots = 1;                            ///< workers that may run at once
  std::vector<std::string> worker_options;  ///< appended to every worker's command line
  std::chrono::milliseconds grace{20'000};  ///< between the request to stop and the kill
};

/// Brings the workers in line with the queue: starts the next jobs while there are slots, stops those that are to
/// stop, and writes into the queue how they ended. To be called by one thread, which must live as long as the workers.
class Supervisor {
 public:
  Supervisor(Queue& queue, Executor& executor, SupervisorOptions options);

  /// One round; waits for nothing. A queue that cannot be written is logged and tried again in the next round.
  void step();

  /// Starts nothing any more, and stops what runs; its jobs go back into the queue.
  void shut_down();
  /// No more patience: ends every worker at once.
  void kill_all();
  bool idle() const { return workers_.empty(); }

 private:
  using Clock = std::chrono::steady_clock;
  struct Worker {
    int handle = 0;
    run::RunDirectory directory;
    std::optional<Clock::time_point> kill_at;  ///< set when it was asked to stop
    bool killed = false;
    std::optional<JobEnd> job_end;  ///< on its end; kept until the queue has taken it
  };

  void settle_ended();
  void stop_stopping();
  void start_queued();
  bool start(const Job& job);
  void complain(const std::string& trouble);

  Queue& queue_;
  Executor& executor_;
  SupervisorOptions options_;
  bool shutting_down_ = false;
  std::map<std::string, Worker> workers_;  ///< by job id
  std::set<std::string> complaints_;       ///< each logged once, not ten times a second
};

}  // namespace shaken::server
