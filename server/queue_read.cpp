// SPDX-License-Identifier: MIT
// What the queue tells of sweeps, jobs and their journal.
#include <algorithm>

#include "base/core/check.h"
#include "server/queue.h"
#include "server/queue_rows.h"

namespace shaken::server {
namespace {

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

const std::string kSelectSweeps =
    "SELECT id, name, created_utime, at_most, stop_if, stopped, executor, settings FROM sweeps ";

}  // namespace

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
          .stopped = query.integer(5) != 0,
          .executor = query.text(6),
          .settings = query.text(7)};
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

std::vector<Job> Queue::begun(Sweep& sweep) const {
  const std::lock_guard lock(mutex_);
  sweep.counts = sweep_counts(sweep.id);
  std::int64_t n_ended = 0;
  for (const JobState state : kJobStates) n_ended += has_ended(state) ? sweep.counts[state] : 0;
  if (n_ended == sweep.counts.total()) return {};
  return explained(read_jobs(database_.query(
      kSelectMembers + "AND j.state IN ('queued', 'held', 'running', 'stopping') AND j.attempt > 0", sweep.id)));
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

}  // namespace shaken::server
