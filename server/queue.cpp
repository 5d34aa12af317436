// SPDX-License-Identifier: MIT
// The life of jobs: how they are started, stopped, held, released, and how they end. How they get in: queue_submit.cpp.
#include "server/queue.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/clock.h"
#include "base/core/check.h"
#include "base/text.h"
#include "server/queue_rows.h"
#include "server/queue_schema.h"
#include "server/queue_words.h"

namespace shaken::server {
namespace {

using enum JobState;
using std::chrono::milliseconds;

/// Whose pause is over at ?1. One that would last longer than any was begun before the clock was set back.
const std::string kNotPausing = "NOT (not_before_utime > ?1 AND not_before_utime < ?1 + " +
                                std::to_string(std::chrono::microseconds(std::chrono::hours(1)).count()) + ") ";
/// What waits at ?1 for its turn only.
const std::string kWaitsForTurn = "state = 'queued' AND waits = 0 AND " + kNotPausing;
/// Whose sweep names the executor in parameter `first`, or none, where the parameter after that is not 0.
std::string is_of_place(int first) {
  return fmt::format("sweep IN (SELECT id FROM sweeps WHERE executor = ?{} OR (executor = '' AND ?{})) ", first,
                     first + 1);
}
/// Not of a sweep of which as many jobs run as may.
const std::string kHasPlace =
    "sweep NOT IN (SELECT s.id FROM sweeps s WHERE s.at_most > 0 AND s.at_most <= "
    "(SELECT COUNT(*) FROM jobs r WHERE r.state IN ('running', 'stopping') AND r.sweep = s.id)) ";

const std::string kSelectCurrent =
    "SELECT id, state, after_stop, attempt, hold, crashes, priority, time_limit_ms, sweep, waits, longer, worker FROM "
    "jobs ";

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
          query.integer(10) != 0,
          query.text(11)};
}

Queue::Queue(const std::filesystem::path& file) : database_(file) {
  prepare_schema(database_);
  database_.execute("PRAGMA temp_store=MEMORY");
  database_.execute(refusals_schema());
  Query query = database_.query("SELECT COALESCE(MAX(sequence), 0) FROM journal");
  query.next();
  last_change_ = query.integer(0);
}

std::vector<std::string> Queue::recover() {
  const std::lock_guard lock(mutex_);
  Transaction transaction(database_);
  std::vector<std::string> recovered;
  for (const Current& job : active()) {
    if (!job.worker.empty()) continue;
    end_stopping(job, "the daemon ended without warning");
    recovered.push_back(job.id);
  }
  commit(transaction);
  return recovered;
}

std::vector<std::pair<std::string, std::string>> Queue::outlives_daemon() const {
  const std::lock_guard lock(mutex_);
  std::vector<std::pair<std::string, std::string>> found;
  for (const Current& job : active()) {
    if (!job.worker.empty()) found.emplace_back(job.id, job.worker);
  }
  return found;
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
  commit(transaction);
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
  commit(transaction);
  return changed;
}

int Queue::release(const Target& target, bool retry) {
  const std::lock_guard lock(mutex_);
  Transaction transaction(database_);
  int changed = 0;
  std::map<std::int64_t, std::optional<Refusal>> refusals;  // by sweep
  for (const Current& job : found(target)) {
    const auto refusal = [&] {
      const auto [entry, is_new] = refusals.try_emplace(job.sweep);
      if (is_new) entry->second = refusal_of(job.sweep);
      return entry->second.has_value();
    };
    const bool is_retried = retry && has_ended(job.state) && job.state != kDone;
    if (job.state == kHeld || is_retried) {
      if (job.hold == kForOthers) database_.run("UPDATE jobs SET waits = 0 WHERE id = ?1", job.id);
      change(job, kQueued, "", job.state == kHeld ? "released on request" : "retried on request");
    } else if (job.state == kStopping && job.after_stop == to_word(kHeld)) {
      stop_for(job, kQueued, "");
    } else if (retry && job.state == kQueued && (job.crashes > 0 || refusal())) {
      database_.run("UPDATE jobs SET crashes = 0, not_before_utime = 0, reason = '' WHERE id = ?1", job.id);
    } else {
      continue;
    }
    ++changed;
  }
  for (const auto& [sweep, refusal] : refusals) {
    if (!refusal) continue;
    database_.run("DELETE FROM refusals WHERE executor = ?1 AND settings = ?2", refusal->executor, refusal->settings);
  }
  if (const std::int64_t* sweep = std::get_if<std::int64_t>(&target)) {
    database_.run("UPDATE sweeps SET stop_if = '', stopped = 0 WHERE id = ?1 AND stopped = 1", *sweep);
  }
  settle_all_waits();
  commit(transaction);
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

std::vector<Job> Queue::next(int limit, const Place& place) const {
  const std::lock_guard lock(mutex_);
  return read_jobs(database_.query(kSelectJobs + "WHERE " + kWaitsForTurn + "AND " + kHasPlace + "AND " +
                                       is_of_place(3) + "AND " + is_not_refused(3) +
                                       "ORDER BY priority DESC, turn, number LIMIT ?2",
                                   utime_now(), limit, place.executor, place.is_default ? 1 : 0));
}

std::string Queue::settings(const std::string& id) const {
  const std::lock_guard lock(mutex_);
  Query query = database_.query("SELECT s.settings FROM jobs j JOIN sweeps s ON s.id = j.sweep WHERE j.id = ?1", id);
  SHAKEN_CHECK(query.next(), "no job " + id);
  return query.text(0);
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
  commit(transaction);
  return job->attempt;
}

void Queue::set_pid(const std::string& id, int pid) {
  const std::lock_guard lock(mutex_);
  database_.run("UPDATE jobs SET pid = ?2 WHERE id = ?1", id, pid);
}

void Queue::set_worker(const std::string& id, const std::string& worker) {
  const std::lock_guard lock(mutex_);
  database_.run("UPDATE jobs SET worker = ?2 WHERE id = ?1", id, worker);
}

void Queue::set_notes(std::span<const std::pair<std::string, std::string>> notes) {
  const std::lock_guard lock(mutex_);
  Transaction transaction(database_);
  for (const auto& [id, note] : notes) {
    database_.run("UPDATE jobs SET reason = ?2 WHERE id = ?1 AND state IN ('running', 'stopping') AND reason <> ?2", id,
                  note);
  }
  transaction.commit();
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
  commit(transaction);
}

void Queue::end_queued(const std::string& id, JobState state, const std::string& reason) {
  const std::lock_guard lock(mutex_);
  const auto job = current(id);
  if (!job || job->state != kQueued) return;
  Transaction transaction(database_);
  change(*job, state, reason, reason);
  commit(transaction);
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
  commit(transaction);
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
  commit(transaction);
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
  commit(transaction);
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
  commit(transaction);
  return released;
}

void Queue::set_reason(const std::string& id, const std::string& reason) {
  const std::lock_guard lock(mutex_);
  database_.run("UPDATE jobs SET reason = ?2 WHERE id = ?1 AND state = 'queued' AND reason <> ?2", id, reason);
}

void Queue::hurry() {
  const std::lock_guard lock(mutex_);
  database_.wait_at_most(milliseconds(500));
}

void Queue::pause(const std::string& id, const std::string& reason, milliseconds pause) {
  const std::lock_guard lock(mutex_);
  database_.run("UPDATE jobs SET reason = ?2, not_before_utime = ?3 WHERE id = ?1 AND state = 'queued'", id, reason,
                utime_now() + 1000 * pause.count());
}

void Queue::add_wall(std::span<const std::pair<std::string, milliseconds>> times) {
  const std::lock_guard lock(mutex_);
  Transaction transaction(database_);
  for (const auto& [id, time] : times) {
    database_.run("UPDATE jobs SET wall_ms = wall_ms + ?2 WHERE id = ?1", id, time.count());
  }
  transaction.commit();
}

bool Queue::give_way(const std::string& id, const Place& place) {
  const std::lock_guard lock(mutex_);
  const auto job = current(id);
  if (!job || job->state != kRunning) return false;
  {
    Query stopping = database_.query("SELECT COUNT(*) FROM jobs WHERE state = 'stopping' AND " + is_of_place(1),
                                     place.executor, place.is_default ? 1 : 0);
    stopping.next();
    // Those that stop already make room for as many. Another of its own sweep would have its place.
    const std::int64_t needed = stopping.integer(0) + 1;
    Query others = database_.query(
        "SELECT COUNT(*) FROM (SELECT 1 FROM jobs WHERE " + kWaitsForTurn + "AND priority >= ?2 AND (sweep = ?5 OR " +
            kHasPlace + ") AND " + is_of_place(3) + "AND " + is_not_refused(3) + "LIMIT ?6)",
        utime_now(), job->priority, place.executor, place.is_default ? 1 : 0, job->sweep, needed);
    others.next();
    if (others.integer(0) < needed) return false;
  }
  Transaction transaction(database_);
  change(*job, kStopping, "", "its soft limit is over: it gives way to others");
  database_.run("UPDATE jobs SET after_stop = ?2 WHERE id = ?1", id, kLast);
  commit(transaction);
  return true;
}

void Queue::time_out(const std::string& id) {
  const std::lock_guard lock(mutex_);
  const auto job = current(id);
  if (!job || job->state != kRunning) return;
  Transaction transaction(database_);
  stop_for(*job, kTimedOut, "its time limit is over");
  commit(transaction);
}

void Queue::stop_all() {
  const std::lock_guard lock(mutex_);
  Transaction transaction(database_);
  for (const Current& job : active()) {
    if (job.state != kRunning || !job.worker.empty()) continue;
    change(job, kStopping, "", "the daemon stops");
    database_.run("UPDATE jobs SET after_stop = 'queued' WHERE id = ?1", job.id);
  }
  commit(transaction);
}

bool Queue::clean(const std::string& id, JobState state) {
  const std::lock_guard lock(mutex_);
  const auto job = current(id);
  if (!job || job->state != state || !has_ended(state)) return false;
  Transaction transaction(database_);
  change(*job, kCancelled, std::string(kCleaned), std::string(kCleaned));
  commit(transaction);
  return true;
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
      "pid = CASE WHEN ?2 = 'stopping' THEN pid ELSE 0 END, "
      "worker = CASE WHEN ?2 = 'stopping' THEN worker ELSE '' END, wall_ms = CASE WHEN ?5 THEN 0 ELSE wall_ms END "
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

void Queue::commit(Transaction& transaction) {
  transaction.commit();
  Query query = database_.query("SELECT COALESCE(MAX(sequence), 0) FROM journal");
  query.next();
  last_change_ = query.integer(0);
  changed_.notify_all();
}

}  // namespace shaken::server
