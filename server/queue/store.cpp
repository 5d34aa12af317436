#include "server/queue/store.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "base/clock.h"
#include "base/core/check.h"
#include "server/queue/database_schema.h"
#include "server/queue/rules.h"

namespace shaken::server {
namespace {

using std::chrono::milliseconds;

constexpr std::int64_t kHour = std::chrono::microseconds(std::chrono::hours(1)).count();
/// Whose pause is over at ?1. One that would last longer than any was begun before the clock was set back.
const std::string kNotPausing = fmt::format("NOT (not_before_utime > ?1 AND not_before_utime < ?1 + {}) ", kHour);
/// A refusal that counts at ?1; likewise.
const std::string kCounts = fmt::format("f.until_utime > ?1 AND f.until_utime < ?1 + {} ", kHour);
/// True of a job `j` that has not begun if the run from whose end it is to begin is in the queue, and not done. One
/// that has begun goes on from its own state.
const std::string kWaitsForStart =
    "(j.starts_from <> '' AND j.attempt = 0 AND EXISTS "
    "(SELECT 1 FROM jobs p WHERE p.id = j.starts_from AND p.state <> 'done')) ";
const std::string kWaitsForTurn = "state = 'queued' AND waits = 0 AND NOT " + kWaitsForStart + "AND " + kNotPausing;

/// "state IN ('running', 'stopping') ": of a job in one of the states that are so; by the index.
std::string in_states(bool (*are_so)(JobState)) {
  return fmt::format("state IN ('{}') ", fmt::join(words_of(are_so), "', '"));
}
const std::string kWaiting = in_states(is_waiting), kAtWork = in_states(has_worker),
                  kUnfinished = in_states([](JobState state) { return !has_ended(state); });
/// Not of a sweep of which as many jobs run as may.
const std::string kHasPlace =
    "sweep NOT IN (SELECT s.id FROM sweeps s WHERE s.at_most > 0 AND s.at_most <= "
    "(SELECT COUNT(*) FROM jobs r WHERE r." +
    kAtWork + "AND r.sweep = s.id)) ";
/// True of the sweeps of an executor: its name is ?2, and ?3 is not 0 where it is the default; ?1 is the time here,
/// too.
const std::string kOfExecutor = "sweep IN (SELECT id FROM sweeps WHERE executor = ?2 OR (executor = '' AND ?3)) ";
const std::string kNotRefused =
    "sweep NOT IN (SELECT s.id FROM refusals f JOIN sweeps s ON s.settings = f.settings WHERE f.executor = ?2 AND " +
    kCounts + ") ";

/// The jobs of a target, which is ?1.
std::string members_of(const Target& target) {
  return std::holds_alternative<std::string>(target) ? "id = ?1 "
                                                     : "number IN (SELECT job FROM members WHERE sweep = ?1) ";
}

const std::string kColumns =
    ", j.id, j.state, j.hold, j.after_stop, j.reason, j.attempt, j.pid, j.created_utime, j.started_utime, "
    "j.finished_utime, j.priority, j.not_before_utime, j.soft_limit_ms, j.time_limit_ms, j.wall_ms, j.sweep, j.waits, "
    "j.crashes, j.longer, j.worker, j.starts_from, j.work, " +
    kWaitsForStart;
const std::string kSelectJobs = "SELECT j.sweep, j.label, j.parameters, j.replica" + kColumns + "FROM jobs j ";
const std::string kSelectMembers = "SELECT m.sweep, m.label, m.parameters, m.replica" + kColumns +
                                   "FROM members m JOIN jobs j ON j.number = m.job WHERE m.sweep = ?1 ";
const std::string kSelectSweeps =
    "SELECT id, name, created_utime, at_most, stop_if, stopped, executor, settings FROM sweeps ";
const std::string kSelectJournal = "SELECT sequence, utime, job, from_state, to_state, attempt, cause FROM journal ";

int as_int(const Query& query, int column) { return static_cast<int>(query.integer(column)); }

JobState stored_state(const std::string& word) {
  const auto state = job_state(word);
  if (!state) throw StorageError("queue.db is damaged: '" + word + "' is no state of a job");
  return *state;
}

Job read_job(const Query& query) {
  const JobState state = stored_state(query.text(5));
  const auto phase = phase_of(state, query.text(6), query.text(7));
  if (!phase) throw StorageError("queue.db is damaged: job " + query.text(4) + " is held or stops for nothing known");
  return {.id = query.text(4),
          .sweep = query.integer(0),
          .state = state,
          .phase = *phase,
          .reason = query.text(8),
          .label = query.text(1),
          .parameters = query.text(2),
          .replica = as_int(query, 3),
          .priority = as_int(query, 14),
          .attempt = as_int(query, 9),
          .pid = as_int(query, 10),
          .created = query.integer(11),
          .started = query.integer(12),
          .finished = query.integer(13),
          .not_before = query.integer(15),
          .asked_by = query.integer(19),
          .waits = query.integer(20) != 0,
          .waits_for_start = query.integer(26) != 0,
          .soft_limit = milliseconds(query.integer(16)),
          .time_limit = milliseconds(query.integer(17)),
          .wall = milliseconds(query.integer(18)),
          .crashes = as_int(query, 21),
          .longer = query.integer(22) != 0,
          .worker = query.text(23),
          .starts_from = query.text(24),
          .work = query.real(25)};
}

Sweep read_sweep(const Query& query) {
  return {.id = query.integer(0),
          .name = query.text(1),
          .created = query.integer(2),
          .counts = {},
          .at_most = as_int(query, 3),
          .after = {},
          .stop_if = query.text(4),
          .stopped = query.integer(5) != 0,
          .executor = query.text(6),
          .settings = query.text(7)};
}

template <class Read>
auto read_all(Query&& query, const Read& read) {
  std::vector<decltype(read(query))> rows;
  while (query.next()) rows.push_back(read(query));
  return rows;
}

std::vector<Job> read_jobs(Query&& query) { return read_all(std::move(query), read_job); }
std::vector<std::string> read_texts(Query&& query) {
  return read_all(std::move(query), [](const Query& row) { return row.text(0); });
}
std::vector<std::int64_t> read_integers(Query&& query) {
  return read_all(std::move(query), [](const Query& row) { return row.integer(0); });
}
std::vector<Change> read_changes(Query&& query) {
  return read_all(std::move(query), [](const Query& row) -> Change {
    return {row.integer(0), row.integer(1), row.text(2), row.text(3), row.text(4), as_int(row, 5), row.text(6)};
  });
}

std::int64_t read_integer(Query&& query) {
  query.next();
  return query.integer(0);
}

JobCounts read_counts(Query&& query) {
  JobCounts counts;
  while (query.next()) counts[stored_state(query.text(0))] = query.integer(1);
  return counts;
}

}  // namespace

QueueStore::QueueStore(const std::filesystem::path& file) : database_(file) {
  prepare_schema(database_);
  database_.execute("PRAGMA temp_store=MEMORY");
  database_.execute(
      "CREATE TEMP TABLE refusals(executor TEXT NOT NULL, is_default INTEGER NOT NULL, settings TEXT NOT NULL, "
      "times INTEGER NOT NULL, until_utime INTEGER NOT NULL, reason TEXT NOT NULL, PRIMARY KEY(executor, settings))");
}

std::vector<Sweep> QueueStore::sweeps() const {
  std::vector<Sweep> sweeps = read_all(database_.query(kSelectSweeps + "ORDER BY id"), read_sweep);
  for (Sweep& sweep : sweeps) sweep.after = prerequisites(sweep.id);
  return sweeps;
}

std::optional<Sweep> QueueStore::sweep(std::int64_t id) const {
  std::vector<Sweep> found = read_all(database_.query(kSelectSweeps + "WHERE id = ?1", id), read_sweep);
  if (found.empty()) return std::nullopt;
  found.front().after = prerequisites(id);
  found.front().counts = counts_of(id);
  return found.front();
}

std::optional<Sweep> QueueStore::sweep_named(const std::string& name) const {
  const auto ids =
      read_integers(database_.query("SELECT id FROM sweeps WHERE name = ?1 ORDER BY id DESC LIMIT 1", name));
  return ids.empty() ? std::nullopt : sweep(ids.front());
}

std::vector<Job> QueueStore::jobs(std::optional<std::int64_t> sweep, std::optional<JobState> state) const {
  const std::string of_state = state ? "AND j.state = '" + std::string(to_word(*state)) + "' " : "";
  if (sweep) return read_jobs(database_.query(kSelectMembers + of_state + "ORDER BY m.position", *sweep));
  return read_jobs(database_.query(kSelectJobs + "WHERE 1 " + of_state + "ORDER BY number"));
}

std::vector<Job> QueueStore::begun(std::int64_t sweep) const {
  return read_jobs(database_.query(kSelectMembers + "AND j." + kUnfinished + "AND j.attempt > 0", sweep));
}

std::optional<Job> QueueStore::job(const std::string& id) const {
  Query query = database_.query(kSelectJobs + "WHERE id = ?1", id);
  if (!query.next()) return std::nullopt;
  return read_job(query);
}

std::vector<Job> QueueStore::active() const {
  return read_jobs(database_.query(kSelectJobs + "WHERE " + kAtWork + "ORDER BY number"));
}

std::vector<std::string> QueueStore::ids_where(const std::string& condition, const Target& target) const {
  const std::string sql = "SELECT id FROM jobs WHERE " + condition + " AND " + members_of(target) + "ORDER BY number";
  return std::visit([&](const auto& value) { return read_texts(database_.query(sql, value)); }, target);
}

std::vector<std::string> QueueStore::ids_of(const Target& target) const { return ids_where("1", target); }

std::vector<std::string> QueueStore::unfinished(const Target& target) const { return ids_where(kUnfinished, target); }

int QueueStore::set_priority(const Target& target, int priority) {
  const std::string sql = "UPDATE jobs SET priority = ?2 WHERE priority <> ?2 AND " + kUnfinished + "AND ";
  return std::visit([&](const auto& value) { return database_.run(sql + members_of(target), value, priority); },
                    target);
}

std::vector<std::string> QueueStore::ids_beginning_with(const std::string& prefix, int limit) const {
  // '~' sorts after every character of an id.
  return read_texts(
      database_.query("SELECT id FROM jobs WHERE id >= ?1 AND id < ?1 || '~' ORDER BY id LIMIT ?2", prefix, limit));
}

std::string QueueStore::scene(const std::string& id) const {
  Query query = database_.query("SELECT s.scene FROM scenes s JOIN jobs j ON j.number = s.job WHERE j.id = ?1", id);
  SHAKEN_CHECK(query.next(), "no scene of job " + id);
  return query.text(0);
}

std::string QueueStore::settings(const std::string& id) const {
  Query query = database_.query("SELECT s.settings FROM jobs j JOIN sweeps s ON s.id = j.sweep WHERE j.id = ?1", id);
  SHAKEN_CHECK(query.next(), "no job " + id);
  return query.text(0);
}

JobCounts QueueStore::counts() const {
  return read_counts(database_.query("SELECT state, COUNT(*) FROM jobs GROUP BY state"));
}

JobCounts QueueStore::counts_of(const Target& target) const {
  if (const std::string* id = std::get_if<std::string>(&target)) {
    return read_counts(database_.query("SELECT state, 1 FROM jobs WHERE id = ?1", *id));
  }
  return read_counts(database_.query(
      "SELECT j.state, COUNT(*) FROM members m JOIN jobs j ON j.number = m.job WHERE m.sweep = ?1 GROUP BY j.state",
      std::get<std::int64_t>(target)));
}

SweepWork QueueStore::work_of(std::int64_t sweep) const {
  Query query = database_.query(
      "SELECT j.state, TOTAL(j.work), TOTAL(j.work) FILTER (WHERE j.attempt > 0), "
      "TOTAL(j.wall_ms) FILTER (WHERE j.attempt > 0), MAX(CASE j.attempt WHEN 0 THEN j.work ELSE 0 END), "
      "MAX(j.starts_from) FROM members m JOIN jobs j ON j.number = m.job WHERE m.sweep = ?1 GROUP BY j.state",
      sweep);
  SweepWork work;
  bool has_chains = false;
  while (query.next()) {
    const JobState state = stored_state(query.text(0));
    work.all += query.real(1);
    if (state == JobState::kQueued) {
      work.queued = query.real(1);
      work.longest_chain = query.real(4);
      has_chains = !query.text(5).empty();
    }
    if (state != JobState::kDone) continue;
    work.done = query.real(1);
    if (query.real(2) > 0) work.seconds_per_work = 1e-3 * query.real(3) / query.real(2);
  }
  if (!has_chains) return work;  // looking for them takes twenty times as long
  Query chain = database_.query(
      "WITH RECURSIVE chain(id, work) AS ("
      "  SELECT j.id, CASE j.attempt WHEN 0 THEN j.work ELSE 0 END FROM members m JOIN jobs j ON j.number = m.job "
      "  WHERE m.sweep = ?1 AND j.state = 'queued' AND NOT EXISTS (SELECT 1 FROM jobs b WHERE b.id = j.starts_from AND "
      "b.state = 'queued') "
      "  UNION ALL SELECT j.id, chain.work + j.work FROM chain JOIN jobs j ON j.starts_from = chain.id "
      "  WHERE j.starts_from <> '' AND j.state = 'queued') SELECT MAX(work) FROM chain",
      sweep);
  chain.next();
  work.longest_chain = chain.real(0);
  return work;
}

std::map<std::int64_t, double> QueueStore::work_ahead() const {
  Query query = database_.query(
      "WITH line AS (SELECT j.number, j.work, SUM(j.work) OVER (PARTITION BY s.executor ORDER BY j.priority DESC, "
      "j.turn, j.number) AS total FROM jobs j JOIN sweeps s ON s.id = j.sweep WHERE j.state = 'queued') "
      "SELECT m.sweep, MAX(line.total) - TOTAL(line.work) FROM line JOIN members m ON m.job = line.number "
      "GROUP BY m.sweep");
  std::map<std::int64_t, double> ahead;
  while (query.next()) ahead.emplace(query.integer(0), query.real(1));
  return ahead;
}

std::vector<Change> QueueStore::history(const std::string& id) const {
  return read_changes(database_.query(kSelectJournal + "WHERE job = ?1 ORDER BY sequence", id));
}

std::vector<Change> QueueStore::changes_since(std::int64_t sequence, int limit) const {
  return read_changes(
      database_.query(kSelectJournal + "WHERE sequence > ?1 ORDER BY sequence LIMIT ?2", sequence, limit));
}

std::int64_t QueueStore::last_change() const {
  return read_integer(database_.query("SELECT COALESCE(MAX(sequence), 0) FROM journal"));
}

std::vector<std::int64_t> QueueStore::sweeps_changed_since(std::int64_t sequence) const {
  return read_integers(
      database_.query("SELECT DISTINCT m.sweep FROM journal l JOIN jobs j ON j.id = l.job JOIN members m ON "
                      "m.job = j.number WHERE l.sequence > ?1",
                      sequence));
}

std::int64_t QueueStore::next_pause_end() const {
  const std::int64_t now = utime_now();
  return read_integer(
      database_.query("SELECT MIN(COALESCE((SELECT MIN(not_before_utime) FROM jobs WHERE not_before_utime > ?1 AND "
                      "not_before_utime > 0), "
                      "?2), COALESCE((SELECT MIN(until_utime) FROM refusals WHERE until_utime > ?1), ?2))",
                      now, now + kHour));
}

std::vector<Job> QueueStore::ready(int limit, const ExecutorRole& executor) const {
  // else all jobs of others would be looked at
  const std::string any_sweep = "SELECT 1 FROM sweeps WHERE executor = ?1 OR (executor = '' AND ?2) LIMIT 1";
  if (!database_.query(any_sweep, executor.name, executor.is_default ? 1 : 0).next()) return {};
  return read_jobs(database_.query(kSelectJobs + "WHERE " + kWaitsForTurn + "AND " + kHasPlace + "AND " + kOfExecutor +
                                       "AND " + kNotRefused + "ORDER BY priority DESC, turn, number LIMIT ?4",
                                   utime_now(), executor.name, executor.is_default ? 1 : 0, limit));
}

bool QueueStore::is_ready(const std::string& id) const {
  return database_
      .query("SELECT 1 FROM jobs j WHERE id = ?2 AND " + kWaitsForTurn + "AND " + kHasPlace, utime_now(), id)
      .next();
}

bool QueueStore::has_successor(const Job& job, const ExecutorRole& executor) const {
  const int is_default = executor.is_default ? 1 : 0;
  const std::int64_t needed =
      1 + read_integer(database_.query("SELECT COUNT(*) FROM jobs WHERE state = 'stopping' AND " + kOfExecutor,
                                       utime_now(), executor.name, is_default));
  const std::string ready = kWaitsForTurn + "AND priority >= ?4 AND (sweep = ?5 OR " + kHasPlace + ") AND " +
                            kOfExecutor + "AND " + kNotRefused;
  return needed <=
         read_integer(database_.query("SELECT COUNT(*) FROM (SELECT 1 FROM jobs j WHERE " + ready + "LIMIT ?6)",
                                      utime_now(), executor.name, is_default, job.priority, job.asked_by, needed));
}

bool QueueStore::is_full(std::int64_t sweep) const {
  return database_
      .query(
          "SELECT 1 FROM sweeps WHERE id = ?1 AND at_most > 0 AND at_most <= "
          "(SELECT COUNT(*) FROM jobs WHERE " +
              kAtWork + "AND sweep = ?1)",
          sweep)
      .next();
}

std::vector<std::string> QueueStore::held_for_room(std::int64_t free) const {
  return read_texts(
      database_.query("SELECT id FROM jobs WHERE state = 'held' AND hold = ?2 AND needed_bytes > 0 AND "
                      "needed_bytes <= ?3 AND " +
                          kNotPausing + "ORDER BY number",
                      utime_now(), stored(JobPhase::kHeldForRoom).hold, free));
}

std::vector<std::string> QueueStore::prerequisites(std::int64_t sweep) const {
  return read_texts(database_.query("SELECT target FROM prerequisites WHERE sweep = ?1 ORDER BY position", sweep));
}

std::vector<std::string> QueueStore::waiting_in(std::int64_t sweep) const {
  return read_texts(database_.query("SELECT id FROM jobs WHERE sweep = ?1 AND waits ORDER BY number", sweep));
}

std::vector<std::int64_t> QueueStore::sweeps_that_wait() const {
  return read_integers(database_.query("SELECT DISTINCT sweep FROM jobs WHERE waits"));
}

std::vector<std::int64_t> QueueStore::sweeps_that_wait_for(const std::string& id) const {
  return read_integers(database_.query(
      "SELECT DISTINCT sweep FROM prerequisites WHERE target IN "
      "(SELECT ?1 UNION ALL SELECT 's' || m.sweep FROM jobs j JOIN members m ON m.job = j.number WHERE j.id = ?1) "
      "AND EXISTS (SELECT 1 FROM jobs w WHERE w.sweep = prerequisites.sweep AND w.waits)",
      id));
}

void QueueStore::end_waiting(std::int64_t sweep) {
  database_.run("UPDATE jobs SET waits = 0 WHERE sweep = ?1 AND waits", sweep);
}

std::vector<std::string> QueueStore::ids_starting_from(const std::string& id) const {
  return read_texts(database_.query(
      "SELECT id FROM jobs WHERE starts_from = ?1 AND starts_from <> '' AND " + kWaiting + "ORDER BY number", id));
}

std::vector<std::int64_t> QueueStore::ruled_sweeps_of(const std::string& id) const {
  return read_integers(
      database_.query("SELECT s.id FROM jobs j JOIN members m ON m.job = j.number JOIN sweeps s ON s.id = m.sweep "
                      "WHERE j.id = ?1 AND s.stop_if <> '' AND s.stopped = 0",
                      id));
}

std::vector<std::string> QueueStore::ids_obeying(std::int64_t sweep) const {
  return read_texts(
      database_.query("SELECT id FROM jobs WHERE state = 'queued' AND sweep = ?1 "
                      "AND number IN (SELECT job FROM members WHERE sweep = ?1) ORDER BY number",
                      sweep));
}

void QueueStore::set_stopped(std::int64_t sweep) {
  database_.run("UPDATE sweeps SET stopped = 1 WHERE id = ?1", sweep);
}

void QueueStore::lift_met_rule(std::int64_t sweep) {
  database_.run("UPDATE sweeps SET stop_if = '', stopped = 0 WHERE id = ?1 AND stopped = 1", sweep);
}

std::optional<std::int64_t> QueueStore::same_sweep(const std::string& name, std::span<const NewJob> jobs) const {
  const auto newest = sweep_named(name);
  if (!newest) return std::nullopt;
  Query member = database_.query(
      "SELECT j.id, m.label FROM members m JOIN jobs j ON j.number = m.job WHERE m.sweep = ?1 ORDER BY m.position",
      newest->id);
  for (const NewJob& job : jobs) {
    if (!member.next() || member.text(0) != job.id || member.text(1) != job.label) return std::nullopt;
  }
  if (member.next()) return std::nullopt;
  return newest->id;
}

std::int64_t QueueStore::add_sweep(const std::string& name) {
  database_.run("INSERT INTO sweeps(name, created_utime) VALUES(?1, ?2)", name, utime_now());
  return database_.last_row_id();
}

void QueueStore::add_member(std::int64_t sweep, std::int64_t position, const NewJob& job) {
  database_.run(
      "INSERT INTO members(sweep, position, job, label, parameters, replica) "
      "SELECT ?1, ?2, number, ?4, ?5, ?6 FROM jobs WHERE id = ?3",
      sweep, position, job.id, job.label, job.parameters, job.replica);
}

void QueueStore::set_terms(std::int64_t sweep, const Terms& terms) {
  database_.run("UPDATE sweeps SET at_most = ?2, stop_if = ?3, stopped = 0, executor = ?4, settings = ?5 WHERE id = ?1",
                sweep, terms.at_most, terms.stop_if ? terms.stop_if->text() : std::string(), terms.executor,
                terms.settings);
  database_.run("DELETE FROM prerequisites WHERE sweep = ?1", sweep);
  for (std::size_t i = 0; i < terms.after.size(); ++i) {
    database_.run("INSERT INTO prerequisites(sweep, position, target) VALUES(?1, ?2, ?3)", sweep,
                  static_cast<std::int64_t>(i), to_word(terms.after[i]));
  }
  database_.run("UPDATE jobs SET waits = ?2 AND " + kWaiting +
                    "WHERE sweep = ?1 AND (?2 OR waits) "
                    "AND number IN (SELECT job FROM members WHERE sweep = ?1)",
                sweep, terms.after.empty() ? 0 : 1);
}

bool QueueStore::add_job(const NewJob& job, int priority, std::int64_t sweep, const Terms& terms,
                         const std::string& cause) {
  const bool is_done = job.has_results.value_or(false);
  const std::string_view state = to_word(is_done ? JobState::kDone : JobState::kQueued);
  const int added = database_.run(
      "INSERT INTO jobs(id, state, priority, created_utime, sweep, label, parameters, replica, soft_limit_ms, "
      "time_limit_ms, turn, finished_utime, starts_from) VALUES(?1, ?10, ?2, ?3, ?4, ?5, ?6, ?7, ?8, ?9, "
      "(SELECT COALESCE(MAX(sequence), 0) + 1 FROM journal), ?11, ?12) ON CONFLICT(id) DO NOTHING",
      job.id, priority, utime_now(), sweep, job.label, job.parameters, job.replica, terms.soft_limit.count(),
      terms.time_limit.count(), state, is_done ? utime_now() : 0, job.starts_from);
  if (added == 0) return false;
  const std::int64_t number = database_.last_row_id();
  database_.run("INSERT INTO scenes(job, scene) VALUES(?1, ?2)", number, job.scene);
  database_.run(update_of_work("number = ?1"), number);
  add_to_journal(job.id, "", state, 0, cause + (is_done ? "; its results were there already" : ""));
  return true;
}

void QueueStore::update_request(const NewJob& job, int priority, std::int64_t sweep, const Terms& terms) {
  database_.run(
      "UPDATE jobs SET priority = MAX(priority, ?2), sweep = ?3, label = ?4, parameters = ?5, replica = ?6, "
      "soft_limit_ms = ?7, time_limit_ms = ?8 WHERE id = ?1",
      job.id, priority, sweep, job.label, job.parameters, job.replica, terms.soft_limit.count(),
      terms.time_limit.count());
}

void QueueStore::set_scene(const std::string& id, const std::string& scene) {
  database_.run("UPDATE scenes SET scene = ?2 WHERE job = (SELECT number FROM jobs WHERE id = ?1)", id, scene);
  database_.run(update_of_work("id = ?1"), id);
}

void QueueStore::set_phase(const Job& job, JobPhase to, const std::string& reason, const std::string& cause) {
  const auto [state, hold, after_stop] = stored(to);
  if (state == job.state && !has_ended(state)) {  // a stopping job keeps what its worker has said
    database_.run(
        "UPDATE jobs SET hold = ?2, after_stop = ?3, reason = CASE WHEN state = 'held' THEN ?4 ELSE reason END "
        "WHERE id = ?1",
        job.id, hold, after_stop, reason);
    return;
  }
  const bool starts = state == JobState::kRunning;
  const int attempt = job.attempt + (starts ? 1 : 0);
  database_.run(
      "UPDATE jobs SET state = ?2, hold = ?3, after_stop = ?4, reason = ?5, finished_utime = ?6, attempt = ?7, "
      "started_utime = CASE WHEN ?2 = 'running' THEN ?8 ELSE started_utime END, needed_bytes = 0, not_before_utime = 0,"
      "longer = CASE WHEN ?2 = 'running' THEN 0 ELSE longer END, "
      "crashes = CASE WHEN ?10 THEN crashes ELSE 0 END, "
      "pid = CASE WHEN ?2 = 'stopping' THEN pid ELSE 0 END, "
      "worker = CASE WHEN ?2 = 'stopping' THEN worker ELSE '' END, wall_ms = CASE WHEN ?9 THEN 0 ELSE wall_ms END "
      "WHERE id = ?1",
      job.id, to_word(state), hold, after_stop, reason, has_ended(state) ? utime_now() : 0, attempt, utime_now(),
      has_ended(job.state) && !has_ended(state) ? 1 : 0, has_worker(state) ? 1 : 0);
  add_to_journal(job.id, to_word(job.state), to_word(state), attempt, cause);
  if (job.phase == JobPhase::kStopToLast && to == JobPhase::kQueued) {
    database_.run("UPDATE jobs SET turn = (SELECT MAX(sequence) FROM journal) WHERE id = ?1", job.id);
  }
}

void QueueStore::add_to_journal(std::string_view job, std::string_view from, std::string_view to, int attempt,
                                std::string_view cause) {
  database_.run("INSERT INTO journal(utime, job, from_state, to_state, attempt, cause) VALUES(?1, ?2, ?3, ?4, ?5, ?6)",
                utime_now(), job, from, to, attempt, cause);
}

void QueueStore::add_wall(const std::string& id, milliseconds time) {
  database_.run("UPDATE jobs SET wall_ms = wall_ms + ?2 WHERE id = ?1", id, time.count());
}

std::optional<ExecutorRefusal> QueueStore::refusal_of(std::int64_t sweep) const {
  Query query = database_.query(
      "SELECT f.executor, f.settings, f.until_utime, f.reason FROM refusals f JOIN sweeps s ON s.settings = f.settings "
      "WHERE s.id = ?2 AND (s.executor = f.executor OR (s.executor = '' AND f.is_default)) AND " +
          kCounts,
      utime_now(), sweep);
  if (!query.next()) return std::nullopt;
  return ExecutorRefusal{query.text(0), query.text(1), query.integer(2), query.text(3)};
}

std::pair<int, bool> QueueStore::times_refused(const ExecutorRequest& request) const {
  Query query = database_.query("SELECT times, " + kCounts + "FROM refusals f WHERE executor = ?2 AND settings = ?3",
                                utime_now(), request.executor.name, request.settings);
  if (!query.next()) return {0, false};
  return {as_int(query, 0), query.integer(1) != 0};
}

void QueueStore::add_refusal(const ExecutorRequest& request, int times, milliseconds pause, const std::string& reason) {
  database_.run("INSERT OR REPLACE INTO refusals VALUES(?1, ?2, ?3, ?4, ?5, ?6)", request.executor.name,
                request.executor.is_default ? 1 : 0, request.settings, times, utime_now() + 1000 * pause.count(),
                reason);
}

void QueueStore::forget_refusal(const std::string& executor, const std::string& settings) {
  database_.run("DELETE FROM refusals WHERE executor = ?1 AND settings = ?2", executor, settings);
}

}  // namespace shaken::server
