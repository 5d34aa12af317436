#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "base/files.h"
#include "server/queue/job.h"
#include "server/queue/rules.h"
#include "server/queue/store.h"
#include "server/queue/terms.h"

namespace shaken::server {

/// What a submit did.
struct Submitted {
  std::int64_t sweep = 0;
  bool created = false;  ///< false: this very sweep was there already
  int n_new = 0;         ///< jobs never seen before, which are queued now
  int n_found = 0;       ///< jobs never seen before that are done, for their results were there
  int n_requeued = 0;    ///< that came to nothing, were held or about to be so, queued again
  int n_extended = 0;    ///< asked to go on longer than before; none of the above
  JobCounts counts{};    ///< of the sweep's jobs, afterwards
};

/// What was asked for cannot be, as the queue is: jobs would wait for themselves, or a run would not end where others
/// start from it. Nothing has happened.
struct Conflict : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// What keeps a job from being launched, as whoever prepares that has found; nothing where both are empty.
struct Obstacle {
  std::string failure{};               ///< it can never run: it fails
  std::string delay{};                 ///< it cannot run now, and is not among the ready ones until
  std::chrono::milliseconds pause{0};  ///< is over: what cannot start holds up no others
};

/// A job that has been launched: its worker is to be started.
struct Launched {
  int attempt = 0;
  std::string settings;  ///< what its sweep asks of the executor
};

/// The job queue: a SQLite file that survives kill -9 and power loss. What a function has done is on the disk when it
/// returns, together with its line in the journal; what throws (StorageError) has not happened. The one object that the
/// daemon's threads share; every function may be called from any thread. What becomes of jobs, rules.h says; the SQL is
/// in store.h.
class Queue {
 public:
  /// Opens or creates the file. Throws StorageError if it is damaged or of another version (prepare_schema).
  explicit Queue(const std::filesystem::path& file);

  /// Puts what a dead predecessor left running back into the queue (or cancels it, where that had been asked for), but
  /// for jobs whose workers do not end with the daemon. Returns the ids of the jobs concerned.
  std::vector<std::string> recover();
  /// Running and stopping jobs whose workers do not end with the daemon: ids, and what set_worker was told.
  std::vector<std::pair<std::string, std::string>> outlives_daemon() const;

  /// One sweep, in one transaction. A job that exists is not done twice. The same jobs under the same name again give
  /// the same sweep. One whose scene asks for a longer run than it did goes on longer. Throws Conflict.
  Submitted submit(const std::string& name, int priority, std::span<const NewJob> jobs, const Terms& terms = {});
  /// Throws the Conflict that submit() would throw.
  void check(std::span<const NewJob> jobs, const Terms& terms) const;

  std::vector<Sweep> sweeps() const;  ///< oldest first
  std::optional<Sweep> sweep(std::int64_t id) const { return read(&QueueStore::sweep, id); }
  /// The newest sweep of that name.
  std::optional<Sweep> sweep_named(const std::string& name) const { return read(&QueueStore::sweep_named, name); }
  /// In the order of the sweep, or in the order of arrival where none is given.
  std::vector<Job> jobs(std::optional<std::int64_t> sweep, std::optional<JobState> state = std::nullopt) const;
  /// Jobs of a sweep that have not ended, and were started; brings its counts, and `work`, to the same moment.
  std::vector<Job> begun(Sweep& sweep, SweepWork& work) const;
  /// By sweep with queued jobs, the work of the queued jobs of others whose turn is before that of its last one.
  /// It reads all queued jobs; where they are many, the answer is up to two seconds old.
  std::map<std::int64_t, double> work_ahead() const;
  std::vector<Job> active() const { return read(&QueueStore::active); }  ///< running and stopping ones, of all sweeps
  std::optional<Job> job(const std::string& id) const;
  /// Ids that begin with `prefix`, in alphabetical order, at most `limit`.
  std::vector<std::string> ids_beginning_with(const std::string& prefix, int limit) const {
    return read(&QueueStore::ids_beginning_with, prefix, limit);
  }
  /// Jobs that have not begun, and start from the end of this one.
  std::vector<std::string> starting_from(const std::string& id) const {
    return read(&QueueStore::ids_starting_from, id);
  }
  /// The canonical scene of a job.
  std::string scene(const std::string& id) const { return read(&QueueStore::scene, id); }
  JobCounts counts() const;

  /// Asks jobs to go on for as long as a scene says, pairs of id and canonical scene. Done ones are queued again.
  /// Returns how many were asked for more than before. Throws Conflict.
  int extend(std::span<const std::pair<std::string, std::string>> scenes);
  /// kCancel, kHold, kResume or kRetry, to one job or all of a sweep. Returns how many were changed.
  int request(JobEvent event, const Target& target);
  int cancel(const Target& target) { return request(JobEvent::kCancel, target); }
  int hold(const Target& target) { return request(JobEvent::kHold, target); }
  int resume(const Target& target) { return request(JobEvent::kResume, target); }
  int retry(const Target& target) { return request(JobEvent::kRetry, target); }
  /// Sets the priority of jobs that have not ended; the larger number goes first. Returns how many changed.
  int set_priority(const Target& target, int priority);
  /// The results of an ended job are about to be removed: it becomes cancelled. False if it is no longer in
  /// `state`, or that is not an end.
  bool clean(const std::string& id, JobState state);

  /// The next jobs to be launched by an executor (rules.h: order).
  std::vector<Job> next(int limit, const ExecutorRole& executor = {}) const;
  /// Launches a job, in one transaction: queued -> running. None if it is not ready any more, has used up its time
  /// limit, or meets an obstacle. `prepare` gets the scene as which its worker will run it; it must not call the queue.
  using Prepare = std::function<Obstacle(const std::string& scene)>;
  std::optional<Launched> launch(const std::string& id, const Prepare& prepare = {});
  /// Says why a queued job does not start; "" if nothing keeps it.
  void set_reason(const std::string& id, const std::string& reason);
  /// The worker of a running job: its pid on this machine, or by what one that outlives the daemon is found again.
  void set_worker(const std::string& id, int pid, const std::string& worker = "");
  /// Says, by id, what running and stopping jobs wait for where their workers have been handed over: for these to
  /// start, or to be told to stop; "" if for nothing.
  void set_notes(std::span<const std::pair<std::string, std::string>> notes);
  /// The attempts of these jobs have taken so much more wall time.
  void add_wall(std::span<const std::pair<std::string, std::chrono::milliseconds>> times);

  /// The worker of a job has ended: kWorkerDone, kWorkerFailed or kWorkerStopped. One that is done, but has been asked
  /// to go on longer meanwhile, is queued again.
  void ended(const std::string& id, JobEvent event, const std::string& why = "");
  /// It has crashed: the job is tried again after the next of `pauses`; failed when there is none left. They begin anew
  /// where there was a checkpoint since the last crash (`went_on`).
  void crashed(const std::string& id, const std::string& reason, bool went_on,
               std::span<const std::chrono::milliseconds> pauses);
  /// It found no room on the disk: the job is held until there are `needed` bytes, and for a `pause` at least: a quota
  /// may allow less than the disk has.
  void no_room(const std::string& id, const std::string& reason, std::int64_t needed, std::chrono::milliseconds pause);
  /// Jobs that wait for room, no longer for the pause, and need at most `free` bytes: held -> queued. Returns their
  /// ids.
  std::vector<std::string> release_for_room(std::int64_t free);
  /// The executor has refused what was asked of it for this job: running -> queued. Nothing that asks the same of it is
  /// started before a pause is over, which doubles from one refusal to the next, up to 16 times; a retry ends it.
  void refused(const std::string& id, const ExecutorRequest& request, const std::string& reason,
               std::chrono::milliseconds first_pause);
  /// The executor takes what asks this of it: the next refusal is the first.
  void accepted(const ExecutorRequest& request);
  /// Why an executor takes nothing at the moment; "" where it does.
  void set_trouble(const ExecutorRole& executor, const std::string& why);

  /// The soft limit of a running job is over: if more of at least its priority are ready for its executor than others
  /// stop, it stops and is queued again behind all of its priority. Returns whether it stops.
  bool preempt(const std::string& id, const ExecutorRole& executor = {});
  /// The time limit of a running job is over: it stops and is timed out.
  void time_out(const std::string& id);
  /// From now on nothing can be written any more: StorageError with these words.
  void close(const std::string& why);
  /// From now on a file that another program keeps is waited for half a second only: the daemon ends.
  void wait_less();
  /// running -> stopping, and then queued: the daemon ends, and with it all workers but those that outlive it.
  void stop_all();

  /// The journal of one job, oldest first.
  std::vector<Change> history(const std::string& id) const { return read(&QueueStore::history, id); }
  /// The journal after line `sequence`, oldest first, at most `limit` lines.
  std::vector<Change> changes_since(std::int64_t sequence, int limit) const {
    return read(&QueueStore::changes_since, sequence, limit);
  }
  /// The last line of the journal.
  std::int64_t last_change() const;
  /// Waits until the journal has lines after `sequence`, or the time is over.
  void wait_for_change(std::int64_t sequence, std::chrono::milliseconds timeout) const;

 private:
  template <class Answer, class... Arguments, class... Values>
  Answer read(Answer (QueueStore::*what)(Arguments...) const, const Values&... values) const {
    const std::lock_guard lock(mutex_);
    return (store_.*what)(values...);
  }
  template <class Work>
  auto write(const Work& work);
  std::optional<JobPhase> apply(const std::string& id, JobEvent event, const std::string& cause,
                                const std::string& reason = "");
  std::optional<JobPhase> change(const Job& job, JobEvent event, const std::string& cause,
                                 const std::string& reason = "");
  void submit_again(const NewJob& job, int priority, const Terms& terms, Submitted& result);
  void update_waiting(std::int64_t sweep);
  void update_all_waiting();
  void hold_or_release(std::vector<std::string> ids);
  void check_stop_rule(std::int64_t sweep);
  std::pair<std::string, std::int64_t> why_waiting(const Job& job) const;
  std::vector<Job> explained(std::vector<Job> jobs) const;

  mutable std::mutex mutex_;
  /// What was found of a sweep; until one of its jobs changes.
  struct Sums {
    JobCounts counts{};
    SweepWork work{};
  };
  const Sums& sums_of(std::int64_t sweep) const;
  const JobCounts& counted() const;

  /// The jobs that an executor may start; until something is written, or a pause ends.
  struct Ready {
    int limit = -1;
    std::int64_t from = 0, until = 0;
    std::vector<Job> jobs{};
  };

  // what is asked for again and again, while nothing may have changed in a queue of a hundred thousand jobs
  mutable std::map<std::int64_t, Sums> sums_{};   ///< by sweep
  mutable std::map<std::string, Ready> ready_{};  ///< by executor
  mutable std::optional<JobCounts> counts_{};
  mutable std::map<std::int64_t, double> work_ahead_{};
  mutable bool work_ahead_is_old_ = true;
  mutable std::chrono::steady_clock::time_point work_ahead_until_{};
  mutable std::condition_variable changed_;
  QueueStore store_;
  FileAsOpened file_;  ///< what is written into another's place would be acknowledged, and lost
  std::string closed_;
  std::int64_t last_change_ = 0;
  std::map<std::string, std::pair<ExecutorRole, std::string>> troubles_;  ///< by executor
};

}  // namespace shaken::server
