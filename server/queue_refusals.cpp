// SPDX-License-Identifier: MIT
// What executors do not take. Until a pause after a refusal is over, nothing that asks for the same is handed over.
#include <fmt/format.h>

#include "base/clock.h"
#include "base/core/check.h"
#include "base/text.h"
#include "server/queue.h"

namespace shaken::server {
namespace {

/// A refusal that holds at ?1. One that would hold for longer than any was told before the clock was set back.
const std::string kHolds = fmt::format("f.until_utime > ?1 AND f.until_utime < ?1 + {} ",
                                       std::chrono::microseconds(std::chrono::hours(1)).count());

}  // namespace

// A table for as long as this daemon is there: the next one may be given other options for all.
const char* Queue::refusals_schema() {
  return "CREATE TEMP TABLE refusals(executor TEXT NOT NULL, is_default INTEGER NOT NULL, settings TEXT NOT NULL, "
         "times INTEGER NOT NULL, until_utime INTEGER NOT NULL, reason TEXT NOT NULL, PRIMARY KEY(executor, settings))";
}

std::string Queue::is_not_refused(int executor) {
  return fmt::format(
      "sweep NOT IN (SELECT s.id FROM refusals f JOIN sweeps s ON s.settings = f.settings WHERE f.executor = ?{} AND "
      "{}) ",
      executor, kHolds);
}

void Queue::refused(const std::string& id, const Asked& asked, const std::string& reason,
                    std::chrono::milliseconds first_pause) {
  const std::lock_guard lock(mutex_);
  const auto job = current(id);
  SHAKEN_CHECK(job.has_value(), "no job " + id);
  Transaction transaction(database_);
  if (job->state == JobState::kStopping) {
    end_stopping(*job, reason);
  } else {
    change(*job, JobState::kQueued, "", reason);  // why_waiting() says why
  }
  const std::int64_t now = utime_now();
  std::int64_t times = 0;
  bool holds = false;
  {
    Query query = database_.query("SELECT times, " + kHolds + "FROM refusals f WHERE executor = ?2 AND settings = ?3",
                                  now, asked.place.executor, asked.settings);
    if (query.next()) {
      times = query.integer(0);
      holds = query.integer(1) != 0;
    }
  }
  if (!holds) {  // else it is the same refusal: of others that went with this job
    constexpr std::int64_t kMostDoublings = 4;
    const std::int64_t pause = 1000 * first_pause.count() * (std::int64_t{1} << std::min(times, kMostDoublings));
    database_.run("INSERT OR REPLACE INTO refusals VALUES(?1, ?2, ?3, ?4, ?5, ?6)", asked.place.executor,
                  asked.place.is_default ? 1 : 0, asked.settings, times + 1, now + pause, reason);
  }
  commit(transaction);
}

void Queue::accepted(const Asked& asked) {
  const std::lock_guard lock(mutex_);
  database_.run("DELETE FROM refusals WHERE executor = ?1 AND settings = ?2", asked.place.executor, asked.settings);
}

std::optional<Queue::Refusal> Queue::refusal_of(std::int64_t sweep) const {
  Query query = database_.query(
      "SELECT f.executor, f.settings, f.until_utime, f.reason FROM refusals f JOIN sweeps s ON s.settings = f.settings "
      "WHERE s.id = ?2 AND (s.executor = f.executor OR (s.executor = '' AND f.is_default)) AND " +
          kHolds,
      utime_now(), sweep);
  if (!query.next()) return std::nullopt;
  return Refusal{query.text(0), query.text(1), query.integer(2), query.text(3)};
}

void Queue::set_trouble(const Place& place, const std::string& why) {
  const std::lock_guard lock(mutex_);
  troubles_[place.executor] = {place, why};
}

std::string Queue::trouble_of(std::int64_t sweep) const {
  Query query = database_.query("SELECT executor FROM sweeps WHERE id = ?1", sweep);
  if (!query.next()) return {};
  for (const auto& [executor, trouble] : troubles_) {
    const bool goes_there = query.text(0) == executor || (query.text(0).empty() && trouble.first.is_default);
    if (goes_there) return trouble.second;
  }
  return {};
}

std::string Queue::refusal_text(std::int64_t sweep, const Refusal& refusal) {
  const std::int64_t now = utime_now();
  return fmt::format("{}. Next attempt at {}, or at once after `shaken retry {}`", refusal.reason,
                     clock_text(1e-6 * static_cast<double>(refusal.until - now), now), sweep_word(sweep));
}

}  // namespace shaken::server
