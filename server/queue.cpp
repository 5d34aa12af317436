// SPDX-License-Identifier: MIT
#include "server/queue.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/clock.h"
#include "base/text.h"
#include "server/queue_schema.h"
#include "server/queue_words.h"
#include "server/scene_length.h"
#include "sim/core/check.h"

namespace shaken::server {
namespace {

using enum JobState;
using std::chrono::milliseconds;

/// Whose pause is over at ?1. One that would last longer than any was begun before the clock was set back.
const std::string kNotPausing = "NOT (not_before_utime > ?1 AND not_before_utime < ?1 + " +
                                std::to_string(std::chrono::microseconds(std::chrono::hours(1)).count()) + ") ";
/// What waits at ?1 for its turn only.
const std::string kWaitsForTurn = "state = 'queued' AND waits = 0 AND " + kNotPausing;
/// Not of a sweep of which as many jobs run as may.
const std::string kHasPlace =
    "sweep NOT IN (SELECT s.id FROM sweeps s WHERE s.at_most > 0 AND s.at_most <= "
    "(SELECT COUNT(*) FROM jobs r WHERE r.state IN ('running', 'stopping') AND r.sweep = s.id)) ";

/// What a job is by itself; read_job has it after its place in a sweep.
const std::string kColumns =
    ", j.id, j.state, j.reason, j.attempt, j.pid, j.created_utime, j.started_utime, j.finished_utime, j.priority, "
    "j.hold, j.needed_bytes, j.not_before_utime, j.soft_limit_ms, j.time_limit_ms, j.wall_ms, "
    "j.sweep, j.waits ";
const std::string kSelectJobs = "SELECT j.sweep, j.label, j.parameters, j.replica" + kColumns + "FROM jobs j ";
const std::string kSelectMembers = "SELECT m.sweep, m.label, m.parameters, m.replica" + kColumns +
                                   "FROM members m JOIN jobs j ON j.number = m.job WHERE m.sweep = ?1 ";

/// What becomes of a stopping job that is queued behind all of its priority; the others become a state.
constexpr std::string_view kLast = "last";

Hold stored_hold(const std::string& word) {
  if (word == kForRoom) return Hold::kRoom;
  if (word == kForOthers) return Hold::kOthers;
  if (word == kByRule) return Hold::kRule;
  return word == kOnRequest ? Hold::kRequest : Hold::kNone;
}

JobState stored_state(const std::string& word) {
  const auto state = job_state(word);
  if (!state) throw StorageError("queue.db is damaged: '" + word + "' is no state of a job");
  return *state;
}

Job read_job(const Query& query) {
  Job job;
  job.sweep = query.integer(0);
  job.label = query.text(1);
  job.parameters = query.text(2);
  job.replica = static_cast<int>(query.integer(3));
  job.id = query.text(4);
  job.state = stored_state(query.text(5));
  job.reason = query.text(6);
  job.attempt = static_cast<int>(query.integer(7));
  job.pid = static_cast<int>(query.integer(8));
  job.created = query.integer(9);
  job.started = query.integer(10);
  job.finished = query.integer(11);
  job.priority = static_cast<int>(query.integer(12));
  job.hold = stored_hold(query.text(13));
  job.needed_bytes = query.integer(14);
  job.not_before = query.integer(15);
  job.soft_limit = milliseconds(query.integer(16));
  job.time_limit = milliseconds(query.integer(17));
  job.wall = milliseconds(query.integer(18));
  job.asked_by = query.integer(19);
  job.waits = query.integer(20) != 0;
  return job;
}

std::vector<Job> read_jobs(Query query) {
  std::vector<Job> jobs;
  while (query.next()) jobs.push_back(read_job(query));
  return jobs;
}

const std::string kSelectJournal = "SELECT sequence, utime, job, from_state, to_state, attempt, cause FROM journal ";

std::vector<Change> read_changes(Query query) {
  std::vector<Change> changes;
  while (query.next()) {
    changes.push_back({query.integer(0), query.integer(1), query.text(2), query.text(3), query.text(4),
                       static_cast<int>(query.integer(5)), query.text(6)});
  }
  return changes;
}

JobCounts read_counts(Query query) {
  JobCounts counts;
  while (query.next()) counts[stored_state(query.text(0))] = query.integer(1);
  return counts;
}

const std::string kSelectCurrent =
    "SELECT id, state, after_stop, attempt, hold, crashes, priority, time_limit_ms, sweep, waits, longer FROM jobs ";
const std::string kSelectSweeps = "SELECT id, name, created_utime, at_most, stop_if, stopped FROM sweeps ";

const std::string kAsked = "cancelled on request";
const std::string kHeldOnRequest = "held on request";

}  // namespace

Queue::Current Queue::read_current(const Query& query) {
  return {query.text(0),
          stored_state(query.text(1)),
          query.text(2),
          static_cast<int>(query.integer(3)),
          query.text(4),
          static_cast<int>(query.integer(5)),
          static_cast<int>(query.integer(6)),
          milliseconds(query.integer(7)),
          query.integer(8),
          query.integer(9) != 0,
          query.integer(10) != 0};
}

/// Nobody waits any more for what was asked of the job: it goes by what it is asked for next, be that less.
bool Queue::is_withdrawn(const Current& job) {
  return job.state == kFailed || job.state == kCancelled || job.state == kTimedOut ||
         (job.state == kStopping && job.after_stop == to_word(kCancelled));
}

Queue::Queue(const std::filesystem::path& file) : database_(file) {
  prepare_schema(database_);
  Query query = database_.query("SELECT COALESCE(MAX(sequence), 0) FROM journal");
  query.next();
  last_change_ = query.integer(0);
}

std::vector<std::string> Queue::recover() {
  const std::lock_guard lock(mutex_);
  Transaction transaction(database_);
  std::vector<std::string> recovered;
  for (const Current& job : active()) {
    end_stopping(job, "the daemon ended without warning");
    recovered.push_back(job.id);
  }
  transaction.commit();
  committed();
  return recovered;
}

Submitted Queue::submit(const std::string& name, int priority, std::span<const NewJob> jobs, const Terms& terms) {
  const std::lock_guard lock(mutex_);
  Transaction transaction(database_);
  Submitted result;
  if (const auto same = same_sweep(name, jobs)) {
    result.sweep = *same;
  } else {
    database_.run("INSERT INTO sweeps(name, created_utime) VALUES(?1, ?2)", name, utime_now());
    result.sweep = database_.last_row_id();
    result.created = true;
  }
  refuse_circle(jobs, terms);
  for (std::size_t position = 0; position < jobs.size(); ++position) {
    const NewJob& job = jobs[position];
    if (insert(job, priority, result.sweep, terms)) {
      ++(job.has_results.value_or(false) ? result.n_found : result.n_new);
    } else {
      const Current known = *current(job.id);
      const bool is_done = known.state == kDone && job.has_results.value_or(true);
      const bool is_longer =
          !is_done && !is_withdrawn(known) && make_longer(known, job.scene, "in " + sweep_word(result.sweep));
      if (is_withdrawn(known)) {
        set_scene(job.id, job.scene);
        // its worker may be about to end without having heard that it is to stop
        database_.run("UPDATE jobs SET longer = 1 WHERE id = ?1 AND state = 'stopping'", job.id);
      }
      const bool is_queued = ask_again(job, priority, result.sweep, terms);
      if (is_longer) {
        ++result.n_extended;
      } else if (is_queued) {
        ++result.n_requeued;
      }
    }
    if (result.created) {
      database_.run(
          "INSERT INTO members(sweep, position, job, label, parameters, replica) "
          "SELECT ?1, ?2, number, ?4, ?5, ?6 FROM jobs WHERE id = ?3",
          result.sweep, static_cast<std::int64_t>(position), job.id, job.label, job.parameters, job.replica);
    }
  }
  set_terms(result.sweep, terms);
  result.counts = sweep_counts(result.sweep);
  transaction.commit();
  committed();
  return result;
}

std::optional<std::int64_t> Queue::same_sweep(const std::string& name, std::span<const NewJob> jobs) const {
  Query newest = database_.query("SELECT id FROM sweeps WHERE name = ?1 ORDER BY id DESC LIMIT 1", name);
  if (!newest.next()) return std::nullopt;
  const std::int64_t id = newest.integer(0);
  Query member = database_.query(
      "SELECT j.id, m.label FROM members m JOIN jobs j ON j.number = m.job WHERE m.sweep = ?1 ORDER BY m.position", id);
  for (const NewJob& job : jobs) {
    if (!member.next() || member.text(0) != job.id || member.text(1) != job.label) return std::nullopt;
  }
  if (member.next()) return std::nullopt;
  return id;
}

bool Queue::insert(const NewJob& job, int priority, std::int64_t sweep, const Terms& terms) {
  const bool found = job.has_results.value_or(false);
  const JobState state = found ? kDone : kQueued;
  const int inserted = database_.run(
      "INSERT INTO jobs(id, state, priority, created_utime, sweep, label, parameters, replica, soft_limit_ms, "
      "time_limit_ms, turn, finished_utime) VALUES(?1, ?10, ?2, ?3, ?4, ?5, ?6, ?7, ?8, ?9, "
      "(SELECT COALESCE(MAX(sequence), 0) + 1 FROM journal), ?11) ON CONFLICT(id) DO NOTHING",
      job.id, priority, utime_now(), sweep, job.label, job.parameters, job.replica, terms.soft_limit.count(),
      terms.time_limit.count(), to_word(state), found ? utime_now() : 0);
  if (inserted == 0) return false;
  database_.run("INSERT INTO scenes(job, scene) VALUES(?1, ?2)", database_.last_row_id(), job.scene);
  std::string cause = "submitted in " + sweep_word(sweep);
  for (const Target& target : terms.after) {
    cause += (&target == &terms.after.front() ? ", to come after " : ", ") + to_word(target);
  }
  record(job.id, "", to_word(state), 0, cause + (found ? "; its results were there already" : ""));
  return true;
}

void Queue::set_scene(const std::string& id, const std::string& scene) {
  database_.run("UPDATE scenes SET scene = ?2 WHERE job = (SELECT number FROM jobs WHERE id = ?1)", id, scene);
}

/// Whether the job's scene has become longer.
bool Queue::make_longer(const Current& job, const std::string& scene, const std::string& asked) {
  const std::string present = scene_of(job.id);
  const std::string longer = as_long_as_both(present, scene);
  if (longer == present) return false;
  set_scene(job.id, longer);
  if (job.state == kRunning || job.state == kStopping) {
    database_.run("UPDATE jobs SET longer = 1 WHERE id = ?1", job.id);
  }
  record(job.id, to_word(job.state), to_word(job.state), job.attempt, "asked to go on longer, " + asked);
  return true;
}

int Queue::extend(std::span<const std::pair<std::string, std::string>> scenes) {
  const std::lock_guard lock(mutex_);
  Transaction transaction(database_);
  int changed = 0;
  for (const auto& [id, scene] : scenes) {
    const auto job = current(id);
    if (!job || !make_longer(*job, scene, "on request")) continue;
    if (job->state == kDone) change(*job, kQueued, "", "goes on from its end");
    ++changed;
  }
  transaction.commit();
  committed();
  return changed;
}

bool Queue::has_former_ids() const {
  const std::lock_guard lock(mutex_);
  return database_.query("SELECT 1 FROM upgrades WHERE name = 'ids'").next();
}

void Queue::renew_ids(std::span<const std::pair<std::string, std::string>> ids) {
  const std::lock_guard lock(mutex_);
  Transaction transaction(database_);
  for (const auto& [former, id] : ids) {
    database_.run("UPDATE journal SET job = ?2 WHERE job = ?1", former, id);
    database_.run("UPDATE prerequisites SET target = ?2 WHERE target = ?1", former, id);
    const auto same = current(id);
    if (!same) {
      database_.run("UPDATE jobs SET id = ?2 WHERE id = ?1", former, id);
      continue;
    }
    const auto former_job = current(former);
    if (former_job && !is_withdrawn(*former_job) && make_longer(*same, scene_of(former), "as job " + former) &&
        same->state == kDone) {
      change(*same, kQueued, "", "goes on from its end");
    }
    database_.run(
        "UPDATE members SET job = (SELECT number FROM jobs WHERE id = ?2) "
        "WHERE job = (SELECT number FROM jobs WHERE id = ?1)",
        former, id);
    database_.run("DELETE FROM scenes WHERE job = (SELECT number FROM jobs WHERE id = ?1)", former);
    database_.run("DELETE FROM jobs WHERE id = ?1", former);
  }
  database_.run("DELETE FROM upgrades WHERE name = 'ids'");
  transaction.commit();
  committed();
}

bool Queue::ask_again(const NewJob& job, int priority, std::int64_t sweep, const Terms& terms) {
  database_.run(
      "UPDATE jobs SET priority = MAX(priority, ?2), sweep = ?3, label = ?4, parameters = ?5, replica = ?6, "
      "soft_limit_ms = ?7, time_limit_ms = ?8 WHERE id = ?1",
      job.id, priority, sweep, job.label, job.parameters, job.replica, terms.soft_limit.count(),
      terms.time_limit.count());
  const Current known = *current(job.id);
  if (known.state == kStopping) {
    if (known.after_stop == to_word(kQueued) || known.after_stop == kLast) return false;
    if (known.after_stop == to_word(kTimedOut)) database_.run("UPDATE jobs SET wall_ms = 0 WHERE id = ?1", job.id);
    stop_for(known, kQueued, "");
    return true;
  }
  const bool waits_for_room = known.state == kHeld && known.hold == kForRoom;
  if (known.state == kQueued || known.state == kRunning || waits_for_room) return false;
  if (known.state == kDone && job.has_results.value_or(true)) return false;
  change(known, kQueued, "", "submitted again in " + sweep_word(sweep));
  return true;
}

std::vector<Sweep> Queue::sweeps() const {
  const std::lock_guard lock(mutex_);
  std::vector<Sweep> sweeps;
  Query query = database_.query(kSelectSweeps + "ORDER BY id");
  while (query.next()) sweeps.push_back(read_sweep(query));

  Query count = database_.query(
      "SELECT m.sweep, j.state, COUNT(*) FROM members m JOIN jobs j ON j.number = m.job GROUP BY m.sweep, j.state");
  while (count.next()) {
    const auto sweep = std::lower_bound(sweeps.begin(), sweeps.end(), count.integer(0),
                                        [](const Sweep& a, std::int64_t id) { return a.id < id; });
    sweep->counts[stored_state(count.text(1))] = count.integer(2);
  }
  return sweeps;
}

std::optional<Sweep> Queue::sweep(std::int64_t id) const {
  const std::lock_guard lock(mutex_);
  Query query = database_.query(kSelectSweeps + "WHERE id = ?1", id);
  if (!query.next()) return std::nullopt;
  Sweep sweep = read_sweep(query);
  sweep.counts = sweep_counts(sweep.id);
  return sweep;
}

std::optional<Sweep> Queue::sweep_named(const std::string& name) const {
  const std::lock_guard lock(mutex_);
  Query query = database_.query(kSelectSweeps + "WHERE name = ?1 ORDER BY id DESC LIMIT 1", name);
  if (!query.next()) return std::nullopt;
  Sweep sweep = read_sweep(query);
  sweep.counts = sweep_counts(sweep.id);
  return sweep;
}

Sweep Queue::read_sweep(const Query& query) const {
  const std::int64_t id = query.integer(0);
  return {.id = id,
          .name = query.text(1),
          .created = query.integer(2),
          .counts = {},
          .at_most = static_cast<int>(query.integer(3)),
          .after = prerequisites(id),
          .stop_if = query.text(4),
          .stopped = query.integer(5) != 0};
}

JobCounts Queue::sweep_counts(std::int64_t sweep) const {
  return read_counts(database_.query(
      "SELECT j.state, COUNT(*) FROM members m JOIN jobs j ON j.number = m.job WHERE m.sweep = ?1 GROUP BY j.state",
      sweep));
}

std::vector<Job> Queue::jobs(std::optional<std::int64_t> sweep, std::optional<JobState> state) const {
  const std::lock_guard lock(mutex_);
  const std::string_view word = state ? to_word(*state) : std::string_view();
  if (sweep && state) {
    return explained(read_jobs(database_.query(kSelectMembers + "AND j.state = ?2 ORDER BY m.position", *sweep, word)));
  }
  if (sweep) return explained(read_jobs(database_.query(kSelectMembers + "ORDER BY m.position", *sweep)));
  if (state) return explained(read_jobs(database_.query(kSelectJobs + "WHERE state = ?1 ORDER BY number", word)));
  return explained(read_jobs(database_.query(kSelectJobs + "ORDER BY number")));
}

std::optional<Job> Queue::job(const std::string& id) const {
  const std::lock_guard lock(mutex_);
  const std::vector<Job> found = explained(read_jobs(database_.query(kSelectJobs + "WHERE id = ?1", id)));
  if (found.empty()) return std::nullopt;
  return found.front();
}

std::vector<std::string> Queue::ids_beginning_with(const std::string& prefix, int limit) const {
  const std::lock_guard lock(mutex_);
  std::vector<std::string> ids;
  // '~' sorts after every character of an id.
  Query query =
      database_.query("SELECT id FROM jobs WHERE id >= ?1 AND id < ?1 || '~' ORDER BY id LIMIT ?2", prefix, limit);
  while (query.next()) ids.push_back(query.text(0));
  return ids;
}

std::string Queue::scene(const std::string& id) const {
  const std::lock_guard lock(mutex_);
  return scene_of(id);
}

std::string Queue::scene_of(const std::string& id) const {
  Query query = database_.query("SELECT s.scene FROM scenes s JOIN jobs j ON j.number = s.job WHERE j.id = ?1", id);
  SHAKEN_CHECK(query.next(), "no scene of job " + id);
  return query.text(0);
}

JobCounts Queue::counts() const {
  const std::lock_guard lock(mutex_);
  return read_counts(database_.query("SELECT state, COUNT(*) FROM jobs GROUP BY state"));
}

void Queue::stop_for(const Current& job, JobState after_stop, const std::string& cause) {
  if (job.state == kRunning) change(job, kStopping, "", cause);
  database_.run("UPDATE jobs SET after_stop = ?2 WHERE id = ?1", job.id, to_word(after_stop));
}

int Queue::cancel(const Target& target) {
  const std::lock_guard lock(mutex_);
  Transaction transaction(database_);
  int changed = 0;
  for (const Current& listed : unfinished(target)) {
    const Current job = *current(listed.id);  // the end of one may have held the next
    if (job.after_stop == to_word(kCancelled)) continue;
    if (job.state == kQueued || job.state == kHeld) {
      change(job, kCancelled, kAsked, kAsked);
    } else {
      stop_for(job, kCancelled, kAsked);
    }
    ++changed;
  }
  transaction.commit();
  committed();
  return changed;
}

int Queue::hold(const Target& target) {
  const std::lock_guard lock(mutex_);
  Transaction transaction(database_);
  int changed = 0;
  for (const Current& job : unfinished(target)) {
    if (job.hold == kOnRequest || job.after_stop == to_word(kHeld)) continue;
    // What was asked for first.
    if (job.after_stop == to_word(kCancelled) || job.after_stop == to_word(kTimedOut)) continue;
    if (job.state == kQueued) {
      change(job, kHeld, kHeldOnRequest, kHeldOnRequest);
    } else if (job.state == kRunning || job.state == kStopping) {
      stop_for(job, kHeld, kHeldOnRequest);
    }
    if (job.state == kQueued || job.state == kHeld) {
      database_.run("UPDATE jobs SET hold = ?2, reason = ?3 WHERE id = ?1", job.id, kOnRequest, kHeldOnRequest);
    }
    ++changed;
  }
  transaction.commit();
  committed();
  return changed;
}

int Queue::release(const Target& target, bool retry) {
  const std::lock_guard lock(mutex_);
  Transaction transaction(database_);
  int changed = 0;
  for (const Current& job : found(target)) {
    const bool is_retried = retry && has_ended(job.state) && job.state != kDone;
    if (job.state == kHeld || is_retried) {
      if (job.hold == kForOthers) database_.run("UPDATE jobs SET waits = 0 WHERE id = ?1", job.id);
      change(job, kQueued, "", job.state == kHeld ? "released on request" : "retried on request");
    } else if (job.state == kStopping && job.after_stop == to_word(kHeld)) {
      stop_for(job, kQueued, "");
    } else if (retry && job.state == kQueued && job.crashes > 0) {
      database_.run("UPDATE jobs SET crashes = 0, not_before_utime = 0, reason = '' WHERE id = ?1", job.id);
    } else {
      continue;
    }
    ++changed;
  }
  if (const std::int64_t* sweep = std::get_if<std::int64_t>(&target)) {
    database_.run("UPDATE sweeps SET stop_if = '', stopped = 0 WHERE id = ?1 AND stopped = 1", *sweep);
  }
  settle_all_waits();
  transaction.commit();
  committed();
  return changed;
}

int Queue::set_priority(const Target& target, int priority) {
  const std::lock_guard lock(mutex_);
  Transaction transaction(database_);
  int changed = 0;
  for (const Current& job : unfinished(target)) {
    if (job.priority == priority) continue;
    database_.run("UPDATE jobs SET priority = ?2 WHERE id = ?1", job.id, priority);
    ++changed;
  }
  transaction.commit();
  return changed;
}

std::vector<Job> Queue::next(int limit) const {
  const std::lock_guard lock(mutex_);
  return read_jobs(database_.query(
      kSelectJobs + "WHERE " + kWaitsForTurn + "AND " + kHasPlace + "ORDER BY priority DESC, turn, number LIMIT ?2",
      utime_now(), limit));
}

std::optional<int> Queue::begin(const std::string& id, const std::string* scene) {
  const std::lock_guard lock(mutex_);
  auto job = current(id);
  if (!job || job->state != kQueued || job->waits || is_full(job->sweep)) return std::nullopt;
  if (scene != nullptr && scene_of(id) != *scene) return std::nullopt;
  ++job->attempt;
  Transaction transaction(database_);
  change(*job, kRunning, "", "attempt " + std::to_string(job->attempt));
  database_.run("UPDATE jobs SET attempt = ?2, started_utime = ?3, longer = 0 WHERE id = ?1", id, job->attempt,
                utime_now());
  transaction.commit();
  committed();
  return job->attempt;
}

void Queue::set_pid(const std::string& id, int pid) {
  const std::lock_guard lock(mutex_);
  database_.run("UPDATE jobs SET pid = ?2 WHERE id = ?1", id, pid);
}

void Queue::finish(const std::string& id, JobState state, const std::string& reason) {
  SHAKEN_CHECK(state == kDone || state == kFailed || state == kTimedOut, "a job ends done, failed or timed out");
  const std::lock_guard lock(mutex_);
  const auto job = current(id);
  SHAKEN_CHECK(job.has_value(), "no job " + id);
  Transaction transaction(database_);
  if (state == kDone && job->longer) {
    end_stopping(*job, "the worker is done; it has been asked to go on longer meanwhile");
  } else {
    change(*job, state, reason, reason.empty() ? "the worker is done" : reason);
  }
  transaction.commit();
  committed();
}

void Queue::end_queued(const std::string& id, JobState state, const std::string& reason) {
  const std::lock_guard lock(mutex_);
  const auto job = current(id);
  if (!job || job->state != kQueued) return;
  Transaction transaction(database_);
  change(*job, state, reason, reason);
  transaction.commit();
  committed();
}

void Queue::end_stopping(const Current& job, const std::string& cause) {
  if (job.state == kStopping && job.after_stop == to_word(kCancelled)) {
    change(job, kCancelled, kAsked, cause);
  } else if (job.state == kStopping && job.after_stop == to_word(kHeld)) {
    change(job, kHeld, kHeldOnRequest, cause);
    database_.run("UPDATE jobs SET hold = ?2 WHERE id = ?1", job.id, kOnRequest);
  } else if (job.state == kStopping && job.after_stop == to_word(kTimedOut)) {
    change(job, kTimedOut, time_limit_over(job.time_limit), cause);
  } else {
    const bool behind_others = job.state == kStopping && job.after_stop == kLast;
    change(job, kQueued, "", cause);
    if (behind_others) {
      database_.run("UPDATE jobs SET turn = (SELECT MAX(sequence) FROM journal) WHERE id = ?1", job.id);
    }
  }
}

void Queue::stopped(const std::string& id, const std::string& cause) {
  const std::lock_guard lock(mutex_);
  const auto job = current(id);
  SHAKEN_CHECK(job.has_value(), "no job " + id);
  Transaction transaction(database_);
  end_stopping(*job, cause);
  transaction.commit();
  committed();
}

void Queue::crashed(const std::string& id, const std::string& reason, bool went_on,
                    std::span<const std::chrono::milliseconds> pauses) {
  const std::lock_guard lock(mutex_);
  const auto job = current(id);
  SHAKEN_CHECK(job.has_value(), "no job " + id);
  Transaction transaction(database_);
  const auto before = static_cast<std::size_t>(went_on ? 0 : job->crashes);
  if (job->state == kStopping) {
    end_stopping(*job, reason);
  } else if (before >= pauses.size()) {
    change(*job, kFailed, fmt::format("{} times in a row, without a checkpoint between: {}", before + 1, reason),
           reason);
  } else {
    const auto pause = pauses[before];
    change(
        *job, kQueued,
        fmt::format("{}; is tried again after {}", reason, duration_text(std::chrono::duration<double>(pause).count())),
        reason);
    database_.run("UPDATE jobs SET crashes = ?2, not_before_utime = ?3 WHERE id = ?1", id,
                  static_cast<std::int64_t>(before) + 1, utime_now() + 1000 * pause.count());
  }
  transaction.commit();
  committed();
}

void Queue::no_room(const std::string& id, const std::string& reason, std::int64_t needed,
                    std::chrono::milliseconds pause) {
  const std::lock_guard lock(mutex_);
  const auto job = current(id);
  SHAKEN_CHECK(job.has_value(), "no job " + id);
  Transaction transaction(database_);
  if (job->state == kStopping) {
    end_stopping(*job, reason);
  } else {
    change(*job, kHeld, reason, reason);
    database_.run("UPDATE jobs SET hold = ?2, needed_bytes = ?3, not_before_utime = ?4 WHERE id = ?1", id, kForRoom,
                  needed, utime_now() + 1000 * pause.count());
  }
  transaction.commit();
  committed();
}

std::vector<std::string> Queue::there_is_room(std::int64_t free) {
  const std::lock_guard lock(mutex_);
  std::vector<Current> jobs;
  {
    Query query =
        database_.query(kSelectCurrent + "WHERE state = 'held' AND hold = ?2 AND needed_bytes <= ?3 AND " + kNotPausing,
                        utime_now(), kForRoom, free);
    while (query.next()) jobs.push_back(read_current(query));
  }
  std::vector<std::string> released;
  if (jobs.empty()) return released;
  Transaction transaction(database_);
  for (const Current& job : jobs) {
    change(job, kQueued, "", "there is room again");
    released.push_back(job.id);
  }
  settle_all_waits();
  transaction.commit();
  committed();
  return released;
}

void Queue::set_reason(const std::string& id, const std::string& reason) {
  const std::lock_guard lock(mutex_);
  database_.run("UPDATE jobs SET reason = ?2 WHERE id = ?1 AND state = 'queued' AND reason <> ?2", id, reason);
}

void Queue::add_wall(std::span<const std::pair<std::string, milliseconds>> times) {
  const std::lock_guard lock(mutex_);
  Transaction transaction(database_);
  for (const auto& [id, time] : times) {
    database_.run("UPDATE jobs SET wall_ms = wall_ms + ?2 WHERE id = ?1", id, time.count());
  }
  transaction.commit();
}

bool Queue::give_way(const std::string& id) {
  const std::lock_guard lock(mutex_);
  const auto job = current(id);
  if (!job || job->state != kRunning) return false;
  {
    Query stopping = database_.query("SELECT COUNT(*) FROM jobs WHERE state = 'stopping'");
    stopping.next();
    // Those that stop already make room for as many. Another of its own sweep would have its place.
    const std::int64_t needed = stopping.integer(0) + 1;
    Query others = database_.query("SELECT COUNT(*) FROM (SELECT 1 FROM jobs WHERE " + kWaitsForTurn +
                                       "AND priority >= ?2 AND (sweep = ?3 OR " + kHasPlace + ") LIMIT ?4)",
                                   utime_now(), job->priority, job->sweep, needed);
    others.next();
    if (others.integer(0) < needed) return false;
  }
  Transaction transaction(database_);
  change(*job, kStopping, "", "its soft limit is over: it gives way to others");
  database_.run("UPDATE jobs SET after_stop = ?2 WHERE id = ?1", id, kLast);
  transaction.commit();
  committed();
  return true;
}

void Queue::time_out(const std::string& id) {
  const std::lock_guard lock(mutex_);
  const auto job = current(id);
  if (!job || job->state != kRunning) return;
  Transaction transaction(database_);
  stop_for(*job, kTimedOut, "its time limit is over");
  transaction.commit();
  committed();
}

void Queue::stop_all() {
  const std::lock_guard lock(mutex_);
  Transaction transaction(database_);
  for (const Current& job : active()) {
    if (job.state != kRunning) continue;
    change(job, kStopping, "", "the daemon stops");
    database_.run("UPDATE jobs SET after_stop = 'queued' WHERE id = ?1", job.id);
  }
  transaction.commit();
  committed();
}

bool Queue::clean(const std::string& id, JobState state) {
  const std::lock_guard lock(mutex_);
  const auto job = current(id);
  if (!job || job->state != state || !has_ended(state)) return false;
  Transaction transaction(database_);
  change(*job, kCancelled, std::string(kCleaned), std::string(kCleaned));
  transaction.commit();
  committed();
  return true;
}

std::vector<Change> Queue::history(const std::string& id) const {
  const std::lock_guard lock(mutex_);
  return read_changes(database_.query(kSelectJournal + "WHERE job = ?1 ORDER BY sequence", id));
}

std::optional<double> Queue::mean_duration(std::int64_t sweep) const {
  const std::lock_guard lock(mutex_);
  Query query = database_.query(
      "SELECT COUNT(*), SUM(j.wall_ms) FROM members m JOIN jobs j ON j.number = m.job "
      "WHERE m.sweep = ?1 AND j.state = 'done' AND j.attempt > 0",
      sweep);
  query.next();
  if (query.integer(0) == 0) return std::nullopt;
  return 1e-3 * static_cast<double>(query.integer(1)) / static_cast<double>(query.integer(0));
}

std::vector<Change> Queue::changes_since(std::int64_t sequence, int limit) const {
  const std::lock_guard lock(mutex_);
  return read_changes(
      database_.query(kSelectJournal + "WHERE sequence > ?1 ORDER BY sequence LIMIT ?2", sequence, limit));
}

std::int64_t Queue::last_change() const {
  const std::lock_guard lock(mutex_);
  return last_change_;
}

void Queue::wait_for_change(std::int64_t sequence, std::chrono::milliseconds timeout) const {
  std::unique_lock lock(mutex_);
  changed_.wait_for(lock, timeout, [&] { return last_change_ > sequence; });
}

std::optional<Queue::Current> Queue::current(const std::string& id) const {
  Query query = database_.query(kSelectCurrent + "WHERE id = ?1", id);
  if (!query.next()) return std::nullopt;
  return read_current(query);
}

std::vector<Queue::Current> Queue::found(const Target& target, const std::string& condition) const {
  const std::int64_t* sweep = std::get_if<std::int64_t>(&target);
  const std::string select =
      kSelectCurrent + "WHERE " + condition +
      (sweep != nullptr ? " AND number IN (SELECT job FROM members WHERE sweep = ?1)" : " AND id = ?1") +
      " ORDER BY number";
  Query query =
      sweep != nullptr ? database_.query(select, *sweep) : database_.query(select, std::get<std::string>(target));
  std::vector<Current> jobs;
  while (query.next()) jobs.push_back(read_current(query));
  return jobs;
}

std::vector<Queue::Current> Queue::unfinished(const Target& target) const {
  return found(target, "state IN ('queued', 'held', 'running', 'stopping')");  // by the index: most jobs have ended
}

std::vector<Queue::Current> Queue::active() const {
  std::vector<Current> jobs;
  Query query =
      database_.query(kSelectCurrent + "WHERE state IN ('running', 'stopping') ORDER BY number");  // by the index
  while (query.next()) jobs.push_back(read_current(query));
  return jobs;
}

void Queue::change(const Current& job, JobState to, const std::string& reason, const std::string& cause) {
  SHAKEN_CHECK(may_become(job.state, to),
               job.id + " from " + std::string(to_word(job.state)) + " to " + std::string(to_word(to)));
  database_.run(
      "UPDATE jobs SET state = ?2, reason = ?3, after_stop = '', finished_utime = ?4, hold = '', needed_bytes = 0, "
      "not_before_utime = 0, crashes = CASE WHEN ?2 IN ('running', 'stopping') THEN crashes ELSE 0 END, "
      "pid = CASE WHEN ?2 = 'stopping' THEN pid ELSE 0 END, wall_ms = CASE WHEN ?5 THEN 0 ELSE wall_ms END "
      "WHERE id = ?1",
      job.id, to_word(to), reason, has_ended(to) ? utime_now() : 0, to == kQueued && has_ended(job.state) ? 1 : 0);
  record(job.id, to_word(job.state), to_word(to), job.attempt, cause);
  if (has_ended(to)) follow_end(job.id, to);
  if (to == kQueued && has_ended(job.state)) {
    for (const std::int64_t sweep : sweeps_waiting_for(job.id)) settle_waits(sweep);
  }
}

void Queue::record(std::string_view job, std::string_view from, std::string_view to, int attempt,
                   std::string_view cause) {
  database_.run("INSERT INTO journal(utime, job, from_state, to_state, attempt, cause) VALUES(?1, ?2, ?3, ?4, ?5, ?6)",
                utime_now(), job, from, to, attempt, cause);
}

void Queue::committed() {
  Query query = database_.query("SELECT COALESCE(MAX(sequence), 0) FROM journal");
  query.next();
  last_change_ = query.integer(0);
  changed_.notify_all();
}

}  // namespace shaken::server
