// SPDX-License-Identifier: MIT
// How jobs get into the queue, and how they are asked for again, or for longer.
#include <algorithm>

#include "base/clock.h"
#include "server/queue.h"
#include "server/queue_words.h"
#include "server/scene_length.h"

namespace shaken::server {

using enum JobState;

/// Nobody waits any more for what was asked of the job: it goes by what it is asked for next, be that less.
bool Queue::is_withdrawn(const Current& job) {
  return job.state == kFailed || job.state == kCancelled || job.state == kTimedOut ||
         (job.state == kStopping && job.after_stop == to_word(kCancelled));
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
  commit(transaction);
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
  commit(transaction);
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
  commit(transaction);
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

}  // namespace shaken::server
