// The SQL of the queue.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "server/queue/job.h"
#include "server/queue/sqlite.h"
#include "server/queue/terms.h"

namespace shaken::server {

/// One point of a sweep on its way into the queue.
struct NewJob {
  std::string id;          ///< hash of the canonical scene
  std::string scene;       ///< canonical scene text, as the worker will read it
  std::string label;       ///< swept parameters, as words
  std::string parameters;  ///< swept parameters, as a JSON object
  int replica = 0;
  /// Whether its results are on the disk: a new job is done then, and one that was done is not done any more without
  /// them. Where nobody has looked, the queue is believed.
  std::optional<bool> has_results{};
  std::string starts_from{};  ///< the id of a run whose end it begins at; empty: none
  double starts_at = 0;       ///< that end [s]
};

/// A state change, from the journal.
struct Change {
  std::int64_t sequence = 0;
  std::int64_t utime = 0;
  std::string job;
  std::string from;  ///< empty for a new job
  std::string to;
  int attempt = 0;
  std::string cause;
};

/// What the jobs of a sweep ask for, in rods times simulated seconds (Job::work).
struct SweepWork {
  double all = 0;
  double queued = 0;
  double done = 0;
  /// The work of queued jobs that start from each other, one after the other; not what is left of one that was begun.
  double longest_chain = 0;
  /// Wall seconds of the done jobs, all attempts of each together, by their work; none where none has run.
  std::optional<double> seconds_per_work{};
};

/// What an executor does not take at the moment.
struct ExecutorRefusal {
  std::string executor;
  std::string settings;
  std::int64_t until = 0;  ///< microseconds since 1970-01-01 UTC
  std::string reason;
};

/// The tables of the queue, without its rules, transactions and threads. Every function throws StorageError.
class QueueStore {
 public:
  /// Opens or creates the file. Throws StorageError if it is damaged or of another version (prepare_schema).
  explicit QueueStore(const std::filesystem::path& file);
  Database& database() { return database_; }

  // --- what is there ---
  std::vector<Sweep> sweeps() const;  ///< without their counts
  std::optional<Sweep> sweep(std::int64_t id) const;
  std::optional<Sweep> sweep_named(const std::string& name) const;
  std::vector<Job> jobs(std::optional<std::int64_t> sweep, std::optional<JobState> state) const;
  /// The jobs of a sweep that have not ended, and were started.
  std::vector<Job> begun(std::int64_t sweep) const;
  std::optional<Job> job(const std::string& id) const;
  /// Running and stopping ones.
  std::vector<Job> active() const;
  std::vector<std::string> ids_of(const Target& target) const;
  std::vector<std::string> unfinished(const Target& target) const;
  std::vector<std::string> ids_beginning_with(const std::string& prefix, int limit) const;
  std::string scene(const std::string& id) const;
  std::string settings(const std::string& id) const;  ///< of the sweep that asked for it last
  JobCounts counts() const;
  JobCounts counts_of(const Target& target) const;
  SweepWork work_of(std::int64_t sweep) const;
  /// By sweep with queued jobs, the work of the queued jobs of others whose turn is before that of its last one.
  std::map<std::int64_t, double> work_ahead() const;
  std::vector<Change> history(const std::string& id) const;
  std::vector<Change> changes_since(std::int64_t sequence, int limit) const;
  std::int64_t last_change() const;
  /// Sweeps of which the journal has lines after `sequence`.
  std::vector<std::int64_t> sweeps_changed_since(std::int64_t sequence) const;

  // --- what may start ---
  std::vector<Job> ready(int limit, const ExecutorRole& executor) const;
  /// When the next pause ends, of a job or after a refusal, within an hour.
  std::int64_t next_pause_end() const;
  bool is_ready(const std::string& id) const;
  /// Whether more jobs of at least its priority are ready than others stop, which make room for as many. One of its own
  /// sweep would have its place, although as many of that run as may.
  bool has_successor(const Job& job, const ExecutorRole& executor) const;
  bool is_full(std::int64_t sweep) const;
  /// Held jobs that need at most so many bytes, and whose pause is over.
  std::vector<std::string> held_for_room(std::int64_t free) const;

  // --- what waits for others, and stop rules ---
  std::vector<std::string> prerequisites(std::int64_t sweep) const;
  std::vector<std::string> waiting_in(std::int64_t sweep) const;
  std::vector<std::int64_t> sweeps_that_wait() const;
  std::vector<std::int64_t> sweeps_that_wait_for(const std::string& id) const;
  void end_waiting(std::int64_t sweep);
  /// Those that have not begun, of the jobs that start from run `id`.
  std::vector<std::string> ids_starting_from(const std::string& id) const;
  /// Sweeps with this job that have a stop rule which is not met yet.
  std::vector<std::int64_t> ruled_sweeps_of(const std::string& id) const;
  /// Jobs that obey the terms of a sweep of which they are members.
  std::vector<std::string> ids_obeying(std::int64_t sweep) const;
  void set_stopped(std::int64_t sweep);
  void lift_met_rule(std::int64_t sweep);

  // --- what changes ---
  std::optional<std::int64_t> same_sweep(const std::string& name, std::span<const NewJob> jobs) const;
  std::int64_t add_sweep(const std::string& name);
  void add_member(std::int64_t sweep, std::int64_t position, const NewJob& job);
  void set_terms(std::int64_t sweep, const Terms& terms);
  /// False if it is there already. `cause`: of its line in the journal.
  bool add_job(const NewJob& job, int priority, std::int64_t sweep, const Terms& terms, const std::string& cause);
  void update_request(const NewJob& job, int priority, std::int64_t sweep, const Terms& terms);
  void set_scene(const std::string& id, const std::string& scene);
  /// Goes to another phase, with a line of the journal if that is of another state, and forgets what was of the former.
  void set_phase(const Job& job, JobPhase to, const std::string& reason, const std::string& cause);
  void add_to_journal(std::string_view job, std::string_view from, std::string_view to, int attempt,
                      std::string_view cause);
  /// A column of a job.
  template <class Value>
  void set(const std::string& id, std::string_view column, const Value& value) {
    database_.run("UPDATE jobs SET " + std::string(column) + " = ?2 WHERE id = ?1", id, value);
  }
  /// Sets the priority of those that have not ended; returns how many had another one.
  int set_priority(const Target& target, int priority);
  void add_wall(const std::string& id, std::chrono::milliseconds time);

  // --- what executors refuse, for as long as this daemon is there: the next one may be given other options ---
  std::optional<ExecutorRefusal> refusal_of(std::int64_t sweep) const;
  /// How often in a row that was refused, and whether the last time still counts.
  std::pair<int, bool> times_refused(const ExecutorRequest& request) const;
  void add_refusal(const ExecutorRequest& request, int times, std::chrono::milliseconds pause,
                   const std::string& reason);
  void forget_refusal(const std::string& executor, const std::string& settings);

 private:
  std::vector<std::string> ids_where(const std::string& condition, const Target& target) const;
  mutable Database database_;
};

}  // namespace shaken::server
