// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <filesystem>
#include <map>
#include <mutex>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "server/job.h"
#include "server/sqlite.h"
#include "server/terms.h"

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
};

/// What a submit did.
struct Submitted {
  std::int64_t sweep = 0;
  bool created = false;  ///< false: this very sweep was there already
  int n_new = 0;         ///< jobs never seen before, which are queued now
  int n_found = 0;       ///< jobs never seen before that are done, for their results were there
  int n_requeued = 0;    ///< failed, cancelled, timed out, held or about to be so, queued again
  int n_extended = 0;    ///< asked to go on longer than before; none of the above
  JobCounts counts;      ///< of the sweep's jobs, afterwards
};

/// The jobs of a submission would wait for each other. Nothing has happened.
struct Circular : std::runtime_error {
  using std::runtime_error::runtime_error;
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

/// The job queue: a SQLite file that survives kill -9 and power loss. What a function has done is on the disk when it
/// returns, together with its line in the journal; what throws (StorageError) has not happened.
/// The one object that the daemon's threads share; every function may be called from any thread.
class Queue {
 public:
  /// Opens or creates the file. Throws StorageError if it is damaged or was written by a newer Shaken.
  explicit Queue(const std::filesystem::path& file);

  /// Puts what a dead predecessor left running back into the queue (or cancels it, where that had been asked for), but
  /// for what outlives_daemon() lists. Returns the ids of the jobs concerned.
  std::vector<std::string> recover();
  /// Running and stopping jobs whose workers do not end with the daemon: ids, and what set_worker was told.
  std::vector<std::pair<std::string, std::string>> outlives_daemon() const;

  /// Whether jobs may still have the ids of a version in which these depended on the length of a run.
  bool has_former_ids() const;
  /// Gives jobs new ids, pairs of the former and the new one. Of several that get the same, the first stays; it goes on
  /// for as long as any of them asks for.
  void renew_ids(std::span<const std::pair<std::string, std::string>> ids);

  /// One sweep, in one transaction. A job that exists is not done twice; a failed, cancelled or timed out one is queued
  /// again, and one that is about to be cancelled goes on. The same jobs under the same name again give the same sweep.
  /// One whose scene asks for a longer run than it did goes on longer. Throws Circular.
  Submitted submit(const std::string& name, int priority, std::span<const NewJob> jobs, const Terms& terms = {});

  std::vector<Sweep> sweeps() const;  ///< oldest first
  std::optional<Sweep> sweep(std::int64_t id) const;
  /// The newest sweep of that name.
  std::optional<Sweep> sweep_named(const std::string& name) const;
  /// In the order of the sweep, or in the order of arrival where none is given.
  std::vector<Job> jobs(std::optional<std::int64_t> sweep, std::optional<JobState> state = std::nullopt) const;
  /// Jobs of a sweep that have not ended, and were started; brings its counts to the same moment.
  std::vector<Job> begun(Sweep& sweep) const;
  std::optional<Job> job(const std::string& id) const;
  /// Ids that begin with `prefix`, in alphabetical order, at most `limit`.
  std::vector<std::string> ids_beginning_with(const std::string& prefix, int limit) const;
  /// The canonical scene of a job.
  std::string scene(const std::string& id) const;
  JobCounts counts() const;

  /// Asks jobs to go on for as long as a scene says, pairs of id and canonical scene. Done ones are queued again.
  /// Returns how many were asked for more than before.
  int extend(std::span<const std::pair<std::string, std::string>> scenes);

  /// Queued jobs are cancelled, running ones asked to stop (the supervisor sees to that); finished ones stay as they
  /// are. Returns how many were changed.
  int cancel(const Target& target);

  /// Queued jobs are held until they are released; running ones stop at a checkpoint first. Returns how many changed.
  int hold(const Target& target);
  /// Held jobs are queued, and so are failed, cancelled and timed out ones if `retry`; these have their time limit
  /// anew. Returns how many changed.
  int release(const Target& target, bool retry);
  /// Jobs that have not ended; the larger number goes first. Returns how many changed.
  int set_priority(const Target& target, int priority);

  /// The next jobs to start in a place: by priority, then by age; without those that wait: after a crash, for
  /// others, or because as many of their sweep run as may.
  std::vector<Job> next(int limit, const Place& place = {}) const;
  /// What the sweep of a job asks of the executor.
  std::string settings(const std::string& id) const;
  /// Says why a queued job does not start; "" if nothing keeps it.
  void set_reason(const std::string& id, const std::string& reason);
  /// The same, and the job is not among the next ones until a pause is over: what cannot start holds up no others.
  void pause(const std::string& id, const std::string& reason, std::chrono::milliseconds pause);
  /// queued -> running. Returns the number of the attempt; none if the job is not queued any more, or not with `scene`,
  /// as which the worker would run it (not looked at if null).
  std::optional<int> begin(const std::string& id, const std::string* scene = nullptr);
  void set_pid(const std::string& id, int pid);
  /// By what a worker that outlives the daemon is found again.
  void set_worker(const std::string& id, const std::string& worker);
  /// Says, by id, what running and stopping jobs wait for where their workers have been handed over: for these to
  /// start, or to be told to stop; "" if for nothing.
  void set_notes(std::span<const std::pair<std::string, std::string>> notes);
  /// running or stopping -> done or failed. One that is done, but has been asked to go on longer meanwhile, is queued
  /// again.
  void finish(const std::string& id, JobState state, const std::string& reason);
  /// queued -> failed or timed out, of what is not to be started; nothing if the job is not queued any more.
  void end_queued(const std::string& id, JobState state, const std::string& reason);
  /// The worker has stopped before the end: running -> queued; stopping -> cancelled, held, timed out or queued, as was
  /// asked.
  void stopped(const std::string& id, const std::string& cause);
  /// The worker has crashed: running -> queued, not to start before the next of `pauses` is over; failed when there is
  /// none left. They begin anew where there was a checkpoint since the last crash (`went_on`).
  void crashed(const std::string& id, const std::string& reason, bool went_on,
               std::span<const std::chrono::milliseconds> pauses);
  /// The executor has refused what was asked of it for this job: running -> queued. Nothing that asks the same of it is
  /// started before a pause is over, which doubles from one refusal to the next, up to 16 times; a retry ends it.
  void refused(const std::string& id, const Asked& asked, const std::string& reason,
               std::chrono::milliseconds first_pause);
  /// The executor takes what asks this of it: the next refusal is the first.
  void accepted(const Asked& asked);
  /// The worker found no room on the disk: running -> held, until there are `needed` bytes, and for a `pause` at least:
  /// a quota may allow less than the disk has.
  void no_room(const std::string& id, const std::string& reason, std::int64_t needed, std::chrono::milliseconds pause);
  /// Jobs that wait for room, no longer for the pause, and need at most `free` bytes: held -> queued. Returns their
  /// ids.
  std::vector<std::string> there_is_room(std::int64_t free);
  /// The attempts of these jobs have taken so much more wall time.
  void add_wall(std::span<const std::pair<std::string, std::chrono::milliseconds>> times);
  /// The soft limit of a running job is over: if more of at least its priority are ready to start in its place than
  /// others stop, it stops and is queued again behind all of its priority. Returns whether it stops.
  bool give_way(const std::string& id, const Place& place = {});
  /// The time limit of a running job is over: it stops and is timed out.
  void time_out(const std::string& id);
  /// Why the executor of a place takes nothing at the moment; "" where it does.
  void set_trouble(const Place& place, const std::string& why);
  /// From now on a file that another program keeps is waited for half a second only: the daemon ends.
  void hurry();
  /// running -> stopping, and then queued: the daemon ends, and with it all workers but those that outlive it.
  void stop_all();

  /// The results of an ended job are about to be removed: it becomes cancelled. False if it is no longer in
  /// `state`, or that is not an end.
  bool clean(const std::string& id, JobState state);

  /// Mean wall seconds of the done jobs of a sweep, all attempts of each together; none if none is done.
  std::optional<double> mean_duration(std::int64_t sweep) const;

  /// The journal of one job, oldest first.
  std::vector<Change> history(const std::string& id) const;
  /// The journal after line `sequence`, oldest first, at most `limit` lines.
  std::vector<Change> changes_since(std::int64_t sequence, int limit) const;
  /// The last line of the journal.
  std::int64_t last_change() const;
  /// Waits until the journal has lines after `sequence`, or the time is over.
  void wait_for_change(std::int64_t sequence, std::chrono::milliseconds timeout) const;

 private:
  /// What the rules of a job's life depend on.
  struct Current {
    std::string id;
    JobState state;
    std::string after_stop;
    int attempt;
    std::string hold;
    int crashes;
    int priority;
    std::chrono::milliseconds time_limit;
    std::int64_t sweep;  ///< that asked for it last
    bool waits;
    bool longer;  ///< than its worker knows
    std::string worker;
  };
  static Current read_current(const Query& query);
  std::optional<Current> current(const std::string& id) const;
  void change(const Current& job, JobState to, const std::string& reason, const std::string& cause);
  void record(std::string_view job, std::string_view from, std::string_view to, int attempt, std::string_view cause);
  void end_stopping(const Current& job, const std::string& cause);
  void stop_for(const Current& job, JobState after_stop, const std::string& cause);
  std::vector<Current> found(const Target& target, const std::string& condition = "1") const;
  std::vector<Current> unfinished(const Target& target) const;
  std::vector<Current> active() const;
  std::optional<std::int64_t> same_sweep(const std::string& name, std::span<const NewJob> jobs) const;
  bool insert(const NewJob& job, int priority, std::int64_t sweep, const Terms& terms);
  static bool is_withdrawn(const Current& job);
  void set_scene(const std::string& id, const std::string& scene);
  bool make_longer(const Current& job, const std::string& scene, const std::string& asked);
  std::string scene_of(const std::string& id) const;
  bool ask_again(const NewJob& job, int priority, std::int64_t sweep, const Terms& terms);
  JobCounts sweep_counts(std::int64_t sweep) const;
  Sweep read_sweep(const Query& query) const;

  // queue_refusals.cpp
  struct Refusal {
    std::string executor;
    std::string settings;
    std::int64_t until;  ///< microseconds since 1970-01-01 UTC
    std::string reason;
  };
  static const char* refusals_schema();
  /// Condition: not of a sweep that asks for what the executor in parameter `executor` has refused; ?1 is the time.
  static std::string is_not_refused(int executor);
  /// What keeps the jobs of a sweep back, if that is a refusal.
  std::optional<Refusal> refusal_of(std::int64_t sweep) const;
  static std::string refusal_text(std::int64_t sweep, const Refusal& refusal);
  /// The trouble of the executor that a sweep goes to, or "".
  std::string trouble_of(std::int64_t sweep) const;

  // queue_terms.cpp
  void set_terms(std::int64_t sweep, const Terms& terms);
  void refuse_circle(std::span<const NewJob> jobs, const Terms& terms) const;
  std::vector<std::string> prerequisites(std::int64_t sweep) const;
  JobCounts counts_of(const Target& target) const;
  void settle_waits(std::int64_t sweep);
  void settle_all_waits();
  /// Sweeps with jobs that wait for job `id`, or for a sweep that it is in.
  std::vector<std::int64_t> sweeps_waiting_for(const std::string& id) const;
  void judge(std::int64_t sweep);
  void follow_end(const std::string& id, JobState state);
  bool is_full(std::int64_t sweep) const;
  /// Why a queued job waits, and until when at least; "" and 0 if nothing keeps it.
  std::pair<std::string, std::int64_t> why_waiting(const Job& job) const;
  std::vector<Job> explained(std::vector<Job> jobs) const;

  /// Ends a transaction, and wakes those who wait for a change.
  void commit(Transaction& transaction);

  mutable std::mutex mutex_;
  mutable std::condition_variable changed_;
  mutable Database database_;
  std::int64_t last_change_ = 0;
  std::map<std::string, std::pair<Place, std::string>> troubles_;  ///< by executor
};

}  // namespace shaken::server
