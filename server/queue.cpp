// SPDX-License-Identifier: MIT
#include "server/queue.h"

#include <algorithm>

#include "base/clock.h"
#include "server/queue_schema.h"
#include "sim/core/check.h"

namespace shaken::server {
namespace {

using enum JobState;

const std::string kSelectJobs =
    "SELECT id, sweep, state, reason, label, parameters, replica, attempt, pid, created_utime, started_utime, "
    "finished_utime FROM jobs ";
const std::string kSelectMembers =
    "SELECT j.id, m.sweep, j.state, j.reason, m.label, m.parameters, m.replica, j.attempt, j.pid, j.created_utime, "
    "j.started_utime, j.finished_utime FROM members m JOIN jobs j ON j.number = m.job WHERE m.sweep = ?1 ";

JobState stored_state(const std::string& word) {
  const auto state = job_state(word);
  if (!state) throw StorageError("queue.db is damaged: '" + word + "' is no state of a job");
  return *state;
}

Job read_job(const Query& query) {
  Job job;
  job.id = query.text(0);
  job.sweep = query.integer(1);
  job.state = stored_state(query.text(2));
  job.reason = query.text(3);
  job.label = query.text(4);
  job.parameters = query.text(5);
  job.replica = static_cast<int>(query.integer(6));
  job.attempt = static_cast<int>(query.integer(7));
  job.pid = static_cast<int>(query.integer(8));
  job.created = query.integer(9);
  job.started = query.integer(10);
  job.finished = query.integer(11);
  return job;
}

std::vector<Job> read_jobs(Query query) {
  std::vector<Job> jobs;
  while (query.next()) jobs.push_back(read_job(query));
  return jobs;
}

JobCounts read_counts(Query query) {
  JobCounts counts;
  while (query.next()) counts[stored_state(query.text(0))] = query.integer(1);
  return counts;
}

bool has_ended(JobState state) { return state == kDone || state == kFailed || state == kCancelled; }

}  // namespace

/// What the rules of a job's life depend on.
struct Queue::Current {
  std::string id;
  JobState state;
  std::string after_stop;
  int attempt;

  static Current read(const Query& query) {
    return {query.text(0), stored_state(query.text(1)), query.text(2), static_cast<int>(query.integer(3))};
  }
};

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
  for (const Current& job : unfinished(std::nullopt)) {
    if (job.state == kQueued) continue;
    const bool cancelled = job.state == kStopping && job.after_stop == to_word(kCancelled);
    change(job, cancelled ? kCancelled : kQueued, cancelled ? "cancelled on request" : "",
           "the daemon ended without warning");
    recovered.push_back(job.id);
  }
  transaction.commit();
  committed();
  return recovered;
}

Submitted Queue::submit(const std::string& name, int priority, std::span<const NewJob> jobs) {
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
  for (std::size_t position = 0; position < jobs.size(); ++position) {
    const NewJob& job = jobs[position];
    if (insert(job, priority, result.sweep)) {
      ++result.n_new;
    } else if (ask_again(job, priority, result.sweep)) {
      ++result.n_requeued;
    }
    if (result.created) {
      database_.run(
          "INSERT INTO members(sweep, position, job, label, parameters, replica) "
          "SELECT ?1, ?2, number, ?4, ?5, ?6 FROM jobs WHERE id = ?3",
          result.sweep, static_cast<std::int64_t>(position), job.id, job.label, job.parameters, job.replica);
    }
  }
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

bool Queue::insert(const NewJob& job, int priority, std::int64_t sweep) {
  const int inserted = database_.run(
      "INSERT INTO jobs(id, state, priority, created_utime, sweep, label, parameters, replica) "
      "VALUES(?1, 'queued', ?2, ?3, ?4, ?5, ?6, ?7) ON CONFLICT(id) DO NOTHING",
      job.id, priority, utime_now(), sweep, job.label, job.parameters, job.replica);
  if (inserted == 0) return false;
  database_.run("INSERT INTO scenes(job, scene) VALUES(?1, ?2)", database_.last_row_id(), job.scene);
  record(job.id, "", to_word(kQueued), 0, "submitted in " + sweep_word(sweep));
  return true;
}

bool Queue::ask_again(const NewJob& job, int priority, std::int64_t sweep) {
  database_.run(
      "UPDATE jobs SET priority = MAX(priority, ?2), sweep = ?3, label = ?4, parameters = ?5, replica = ?6 "
      "WHERE id = ?1",
      job.id, priority, sweep, job.label, job.parameters, job.replica);
  const Current known = *current(job.id);
  if (known.state == kStopping) {
    database_.run("UPDATE jobs SET after_stop = 'queued' WHERE id = ?1", job.id);
    return known.after_stop == to_word(kCancelled);
  }
  if (!has_ended(known.state) || (known.state == kDone && !job.results_lost)) return false;
  change(known, kQueued, "", "submitted again in " + sweep_word(sweep));
  return true;
}

std::vector<Sweep> Queue::sweeps() const {
  const std::lock_guard lock(mutex_);
  std::vector<Sweep> sweeps;
  Query query = database_.query("SELECT id, name, created_utime FROM sweeps ORDER BY id");
  while (query.next()) sweeps.push_back({query.integer(0), query.text(1), query.integer(2), {}});

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
  Query query = database_.query("SELECT id, name, created_utime FROM sweeps WHERE id = ?1", id);
  if (!query.next()) return std::nullopt;
  return Sweep{query.integer(0), query.text(1), query.integer(2), sweep_counts(id)};
}

std::optional<Sweep> Queue::sweep_named(const std::string& name) const {
  const std::lock_guard lock(mutex_);
  Query query =
      database_.query("SELECT id, name, created_utime FROM sweeps WHERE name = ?1 ORDER BY id DESC LIMIT 1", name);
  if (!query.next()) return std::nullopt;
  const std::int64_t id = query.integer(0);
  return Sweep{id, query.text(1), query.integer(2), sweep_counts(id)};
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
    return read_jobs(database_.query(kSelectMembers + "AND j.state = ?2 ORDER BY m.position", *sweep, word));
  }
  if (sweep) return read_jobs(database_.query(kSelectMembers + "ORDER BY m.position", *sweep));
  if (state) return read_jobs(database_.query(kSelectJobs + "WHERE state = ?1 ORDER BY number", word));
  return read_jobs(database_.query(kSelectJobs + "ORDER BY number"));
}

std::optional<Job> Queue::job(const std::string& id) const {
  const std::lock_guard lock(mutex_);
  Query query = database_.query(kSelectJobs + "WHERE id = ?1", id);
  if (!query.next()) return std::nullopt;
  return read_job(query);
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
  Query query = database_.query("SELECT s.scene FROM scenes s JOIN jobs j ON j.number = s.job WHERE j.id = ?1", id);
  SHAKEN_CHECK(query.next(), "no scene of job " + id);
  return query.text(0);
}

JobCounts Queue::counts() const {
  const std::lock_guard lock(mutex_);
  return read_counts(database_.query("SELECT state, COUNT(*) FROM jobs GROUP BY state"));
}

int Queue::cancel_job(const std::string& id) {
  const std::lock_guard lock(mutex_);
  const auto job = current(id);
  return job ? cancel_all({&*job, 1}) : 0;
}

int Queue::cancel_sweep(std::int64_t sweep) {
  const std::lock_guard lock(mutex_);
  return cancel_all(unfinished(sweep));
}

int Queue::cancel_all(std::span<const Current> jobs) {
  Transaction transaction(database_);
  int changed = 0;
  for (const Current& job : jobs) {
    if (has_ended(job.state) || job.after_stop == to_word(kCancelled)) continue;
    if (job.state == kQueued) {
      change(job, kCancelled, "cancelled on request", "cancelled on request");
    } else {
      if (job.state == kRunning) change(job, kStopping, "", "cancelled on request");
      database_.run("UPDATE jobs SET after_stop = 'cancelled' WHERE id = ?1", job.id);
    }
    ++changed;
  }
  transaction.commit();
  committed();
  return changed;
}

std::vector<Job> Queue::next(int limit) const {
  const std::lock_guard lock(mutex_);
  return read_jobs(
      database_.query(kSelectJobs + "WHERE state = 'queued' ORDER BY priority DESC, number LIMIT ?1", limit));
}

std::optional<int> Queue::begin(const std::string& id) {
  const std::lock_guard lock(mutex_);
  auto job = current(id);
  if (!job || job->state != kQueued) return std::nullopt;
  ++job->attempt;
  Transaction transaction(database_);
  change(*job, kRunning, "", "attempt " + std::to_string(job->attempt));
  database_.run("UPDATE jobs SET attempt = ?2, started_utime = ?3 WHERE id = ?1", id, job->attempt, utime_now());
  transaction.commit();
  committed();
  return job->attempt;
}

void Queue::set_pid(const std::string& id, int pid) {
  const std::lock_guard lock(mutex_);
  database_.run("UPDATE jobs SET pid = ?2 WHERE id = ?1", id, pid);
}

void Queue::finish(const std::string& id, JobState state, const std::string& reason) {
  SHAKEN_CHECK(state == kDone || state == kFailed, "a worker ends done or failed");
  const std::lock_guard lock(mutex_);
  const auto job = current(id);
  SHAKEN_CHECK(job.has_value(), "no job " + id);
  Transaction transaction(database_);
  change(*job, state, reason, reason.empty() ? "the worker is done" : reason);
  transaction.commit();
  committed();
}

void Queue::stopped(const std::string& id, const std::string& cause) {
  const std::lock_guard lock(mutex_);
  const auto job = current(id);
  SHAKEN_CHECK(job.has_value(), "no job " + id);
  const bool cancelled = job->state == kStopping && job->after_stop == to_word(kCancelled);
  Transaction transaction(database_);
  change(*job, cancelled ? kCancelled : kQueued, cancelled ? "cancelled on request" : "", cause);
  transaction.commit();
  committed();
}

void Queue::stop_all() {
  const std::lock_guard lock(mutex_);
  Transaction transaction(database_);
  for (const Current& job : unfinished(std::nullopt)) {
    if (job.state != kRunning) continue;
    change(job, kStopping, "", "the daemon stops");
    database_.run("UPDATE jobs SET after_stop = 'queued' WHERE id = ?1", job.id);
  }
  transaction.commit();
  committed();
}

std::optional<double> Queue::mean_duration(std::int64_t sweep) const {
  const std::lock_guard lock(mutex_);
  Query query = database_.query(
      "SELECT COUNT(*), TOTAL(j.finished_utime - j.started_utime) FROM members m JOIN jobs j ON j.number = m.job "
      "WHERE m.sweep = ?1 AND j.state = 'done'",
      sweep);
  query.next();
  if (query.integer(0) == 0) return std::nullopt;
  return 1e-6 * static_cast<double>(query.integer(1)) / static_cast<double>(query.integer(0));
}

std::vector<Change> Queue::changes_since(std::int64_t sequence, int limit) const {
  const std::lock_guard lock(mutex_);
  std::vector<Change> changes;
  Query query = database_.query(
      "SELECT sequence, utime, job, from_state, to_state, attempt, cause FROM journal WHERE sequence > ?1 "
      "ORDER BY sequence LIMIT ?2",
      sequence, limit);
  while (query.next()) {
    changes.push_back({query.integer(0), query.integer(1), query.text(2), query.text(3), query.text(4),
                       static_cast<int>(query.integer(5)), query.text(6)});
  }
  return changes;
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
  Query query = database_.query("SELECT id, state, after_stop, attempt FROM jobs WHERE id = ?1", id);
  if (!query.next()) return std::nullopt;
  return Current::read(query);
}

std::vector<Queue::Current> Queue::unfinished(std::optional<std::int64_t> sweep) const {
  std::vector<Current> jobs;
  Query query = database_.query(
      "SELECT id, state, after_stop, attempt FROM jobs WHERE state IN ('queued', 'running', 'stopping') AND "
      "(?1 = 0 OR number IN (SELECT job FROM members WHERE sweep = ?1)) ORDER BY number",
      sweep.value_or(0));
  while (query.next()) jobs.push_back(Current::read(query));
  return jobs;
}

void Queue::change(const Current& job, JobState to, const std::string& reason, const std::string& cause) {
  SHAKEN_CHECK(may_become(job.state, to),
               job.id + " from " + std::string(to_word(job.state)) + " to " + std::string(to_word(to)));
  database_.run(
      "UPDATE jobs SET state = ?2, reason = ?3, after_stop = '', finished_utime = ?4, "
      "pid = CASE WHEN ?2 = 'stopping' THEN pid ELSE 0 END WHERE id = ?1",
      job.id, to_word(to), reason, has_ended(to) ? utime_now() : 0);
  record(job.id, to_word(job.state), to_word(to), job.attempt, cause);
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
