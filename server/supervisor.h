#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "run/files/directory.h"
#include "server/executor.h"
#include "server/job_end.h"
#include "server/queue/queue.h"

namespace shaken::server {

struct SupervisorOptions {
  std::filesystem::path runs;               ///< folder of the run directories
  int slots = 1;                            ///< workers that may run at once
  std::vector<std::string> worker_options;  ///< appended to every worker's command line
  std::chrono::milliseconds grace{20'000};  ///< between the request to stop and the kill
  /// Bytes free on the disk of `runs`, below which nothing is started.
  std::int64_t least_room = 64'000'000;
  /// What is wrong with the scene of a job, if anything; not asked where empty.
  std::function<std::string(const std::string& id, const std::string& scene)> refuse{};
  /// Before a job whose worker has crashed is tried again, from crash to crash.
  std::vector<std::chrono::milliseconds> retry_pauses{std::chrono::seconds(5), std::chrono::seconds(30),
                                                      std::chrono::minutes(3)};
  std::chrono::milliseconds first_pause{1000};  ///< after a start that failed; doubled each time, up to a minute
  ExecutorRole role{};                          ///< of its executor: whose jobs it starts
  /// Before what the executor has refused is handed over again; doubled with each refusal, up to 16 times.
  std::chrono::milliseconds refused_pause{60'000};
  /// For so long the summary of a worker that ended well is looked for; then its run goes back into the queue, where a
  /// worker finds within a second that it is done.
  std::chrono::milliseconds confirm_within{10'000};
  /// Before a job that could not be prepared is looked at again, others being started meanwhile; doubled each time, up
  /// to 16 times: what has waited long must not take the turns of what can start.
  std::chrono::milliseconds waiting_pause{5'000};
  /// How much of a run's wall time is forgotten at most if the daemon is killed.
  std::chrono::milliseconds counting{10'000};
};

/// Brings the workers in line with the queue: starts the next jobs while there are slots, stops those that are to
/// stop, and writes into the queue how they ended. A worker that cannot be started costs no job: it goes back into the
/// queue, and the next start waits. To be called by one thread, which must live as long as the workers.
class Supervisor {
 public:
  Supervisor(Queue& queue, Executor& executor, SupervisorOptions options);

  /// Takes over the workers that a former daemon has left at work. To be called once, before the first round.
  void adopt();

  /// One round; waits for nothing. A queue that cannot be written is logged and tried again in the next round.
  void step();

  /// Starts nothing any more, and stops what runs; its jobs go back into the queue. Not for workers that outlive the
  /// daemon: nothing is to be done for those to go on, and the next one adopts them.
  void shut_down();
  /// No more patience: ends every worker at once.
  void kill_all();
  /// Whether there is nothing more to do: no worker, and none whose end the queue has yet to take.
  bool idle() const { return workers_.empty(); }
  /// Whether no worker is alive. What the queue has not taken of their ends, the next daemon finds out anew.
  bool all_ended() const;

 private:
  using Clock = std::chrono::steady_clock;
  struct Worker {
    int handle = 0;
    run::RunDirectory directory;
    std::filesystem::file_time_type checkpoint_before{};  ///< when the last one was written that it found
    double time_before = 0;                               ///< simulated time that the run had reported by then [s]
    bool was_at_work = false;                             ///< rather than waiting for its turn when it ended
    Clock::time_point started{};
    Clock::time_point counted{};           ///< up to when the queue knows its wall time
    std::optional<std::string> settings;   ///< that were asked for; none: not known, a former daemon has started it
    bool waits = false;                    ///< for its turn, where the executor has it
    std::string note;                      ///< what it waits for
    std::optional<std::string> noted{""};  ///< what the queue has of that; none: not known
    std::string unsaved_name;              ///< by which the next daemon finds it, until the queue has that
    std::optional<Clock::time_point> ended;
    std::optional<WorkerEnd> unconfirmed;      ///< it is no more, but its summary is yet to say that the run is done
    std::optional<Clock::time_point> kill_at;  ///< set when it was asked to stop
    bool killed = false;
    std::optional<JobEnd> job_end;  ///< on its end; kept until the queue has taken it
    bool is_alive() const { return !job_end && !unconfirmed; }
  };

  int free_slots() const;
  void record_ended();
  void write_notes();
  void check_worker(const std::string& id, Worker& worker);
  void judge_end(const std::string& id, Worker& worker, const WorkerEnd& end);
  void count_wall(const std::vector<std::string>& ids);
  void count_wall_of_all();
  void enforce_limits();
  void stop_stopping();
  void record_end(const std::string& id, const Worker& worker);
  void start_queued();
  void start(const Job& job);
  void could_not_start(const std::string& id, const std::string& why);
  Obstacle prepare(const Job& job, const std::string& scene);
  Obstacle delayed(const Job& job, const std::string& why);
  void warn_once(const std::string& warning);

  Queue& queue_;
  Executor& executor_;
  SupervisorOptions options_;
  bool shutting_down_ = false;
  std::string known_trouble_;                                ///< the executor's, as the queue knows it
  std::map<std::string, Worker> workers_;                    ///< by job id
  std::map<std::string, std::chrono::milliseconds> waited_;  ///< the last pause of a job that could not be prepared
  std::set<std::string> warnings_;                           ///< each logged once, not ten times a second
  std::chrono::milliseconds pause_{0};                       ///< after the last start, if that failed
  Clock::time_point start_after_{};
  Clock::time_point count_after_{};
};

}  // namespace shaken::server
