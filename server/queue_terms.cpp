// SPDX-License-Identifier: MIT
// What the terms of a submission (server/terms.h) make of its jobs: which wait for which, and which are held.
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "server/queue.h"
#include "server/queue_words.h"

namespace shaken::server {
namespace {

using enum JobState;

/// The first state of these in which there are jobs that came to nothing.
std::optional<JobState> without_result(const JobCounts& counts) {
  for (const JobState state : {kFailed, kTimedOut, kCancelled}) {
    if (counts[state] > 0) return state;
  }
  return std::nullopt;
}

}  // namespace

std::vector<std::string> Queue::prerequisites(std::int64_t sweep) const {
  std::vector<std::string> words;
  Query query = database_.query("SELECT target FROM prerequisites WHERE sweep = ?1 ORDER BY position", sweep);
  while (query.next()) words.push_back(query.text(0));
  return words;
}

JobCounts Queue::counts_of(const Target& target) const {
  if (const std::int64_t* sweep = std::get_if<std::int64_t>(&target)) return sweep_counts(*sweep);
  JobCounts counts;
  if (const auto job = current(std::get<std::string>(target))) counts[job->state] = 1;
  return counts;
}

void Queue::refuse_circle(std::span<const NewJob> jobs, const Terms& terms) const {
  if (terms.after.empty()) return;
  // Those that may be queued by this submission, and so may wait.
  std::set<std::string> ours;
  for (const NewJob& job : jobs) {
    const auto known = current(job.id);
    if (!known || known->state != kDone || !job.has_results.value_or(true)) ours.insert(job.id);
  }
  // Each of the targets, and what the jobs in it wait for themselves.
  std::vector<Target> pending = terms.after;
  std::set<Target> seen(pending.begin(), pending.end());
  while (!pending.empty()) {
    const Target target = pending.back();
    pending.pop_back();
    for (const Current& job : found(target)) {
      if (ours.contains(job.id)) {
        throw Circular(fmt::format("these jobs would wait for themselves: job {} is one of them, and {} has it too{}",
                                   job.id, to_word(target),
                                   std::find(terms.after.begin(), terms.after.end(), target) == terms.after.end()
                                       ? ", for which they would wait by way of others"
                                       : ""));
      }
      if (!job.waits) continue;
      for (const std::string& word : prerequisites(job.sweep)) {
        if (seen.insert(target_named(word)).second) pending.push_back(target_named(word));
      }
    }
  }
}

void Queue::set_terms(std::int64_t sweep, const Terms& terms) {
  database_.run("UPDATE sweeps SET at_most = ?2, stop_if = ?3, stopped = 0, executor = ?4, settings = ?5 WHERE id = ?1",
                sweep, terms.at_most, terms.stop_if ? terms.stop_if->text() : std::string(), terms.executor,
                terms.settings);
  database_.run("DELETE FROM prerequisites WHERE sweep = ?1", sweep);
  for (std::size_t i = 0; i < terms.after.size(); ++i) {
    database_.run("INSERT INTO prerequisites(sweep, position, target) VALUES(?1, ?2, ?3)", sweep,
                  static_cast<std::int64_t>(i), to_word(terms.after[i]));
  }
  database_.run(
      "UPDATE jobs SET waits = ?2 AND state IN ('queued', 'held') WHERE sweep = ?1 AND (?2 OR waits) "
      "AND number IN (SELECT job FROM members WHERE sweep = ?1)",
      sweep, terms.after.empty() ? 0 : 1);
  if (!terms.after.empty()) settle_waits(sweep);
}

void Queue::settle_waits(std::int64_t sweep) {
  bool all_done = true;
  for (const std::string& word : prerequisites(sweep)) {
    const JobCounts counts = counts_of(target_named(word));
    all_done = all_done && counts[kDone] == counts.total();
    const auto trouble = without_result(counts);
    if (!trouble) continue;
    const std::string of_all =
        sweep_number(word) ? fmt::format("{} of {} ", counts[*trouble], counts.total()) : std::string();
    const std::string reason = fmt::format("it was to come after {}: {}{}", word, of_all, to_word(*trouble));
    std::vector<Current> waiting;
    {
      Query query = database_.query("SELECT id FROM jobs WHERE sweep = ?1 AND waits = 1 AND state = 'queued'", sweep);
      while (query.next()) waiting.push_back(*current(query.text(0)));
    }
    for (const Current& job : waiting) {
      change(job, kHeld, reason, reason);
      database_.run("UPDATE jobs SET hold = ?2 WHERE id = ?1", job.id, kForOthers);
    }
    return;
  }
  std::vector<Current> held;
  {
    Query query = database_.query("SELECT id FROM jobs WHERE sweep = ?1 AND waits = 1 AND state = 'held' AND hold = ?2",
                                  sweep, kForOthers);
    while (query.next()) held.push_back(*current(query.text(0)));
  }
  for (const Current& job : held) change(job, kQueued, "", "what it is to come after is tried again");
  if (all_done) database_.run("UPDATE jobs SET waits = 0 WHERE sweep = ?1 AND waits = 1", sweep);
}

std::vector<std::int64_t> Queue::sweeps_waiting_for(const std::string& id) const {
  std::vector<std::int64_t> waiting;
  Query query = database_.query(
      "SELECT DISTINCT sweep FROM prerequisites WHERE target IN "
      "(SELECT ?1 UNION ALL SELECT 's' || m.sweep FROM jobs j JOIN members m ON m.job = j.number WHERE j.id = ?1) "
      "AND EXISTS (SELECT 1 FROM jobs w WHERE w.sweep = prerequisites.sweep AND w.waits = 1)",
      id);
  while (query.next()) waiting.push_back(query.integer(0));
  return waiting;
}

void Queue::settle_all_waits() {
  std::vector<std::int64_t> sweeps;
  {
    Query query = database_.query("SELECT DISTINCT sweep FROM jobs WHERE waits = 1");
    while (query.next()) sweeps.push_back(query.integer(0));
  }
  for (const std::int64_t sweep : sweeps) settle_waits(sweep);
}

void Queue::judge(std::int64_t sweep) {
  std::string text;
  {
    Query query = database_.query("SELECT stop_if FROM sweeps WHERE id = ?1 AND stopped = 0", sweep);
    if (!query.next()) return;
    text = query.text(0);
  }
  const auto rule = StopRule::parse(text);
  if (!rule) return;
  const JobCounts counts = sweep_counts(sweep);
  if (!rule->is_broken(counts)) return;
  database_.run("UPDATE sweeps SET stopped = 1 WHERE id = ?1", sweep);
  const std::string reason =
      fmt::format("{}; `shaken resume {}` lifts this rule", rule->reason(counts), sweep_word(sweep));
  for (const Current& job : unfinished(sweep)) {
    if (job.state != kQueued || job.sweep != sweep) continue;
    change(job, kHeld, reason, reason);
    database_.run("UPDATE jobs SET hold = ?2 WHERE id = ?1", job.id, kByRule);
  }
}

void Queue::follow_end(const std::string& id, JobState state) {
  std::vector<std::int64_t> ruled;
  {
    Query query = database_.query(
        "SELECT s.id FROM jobs j JOIN members m ON m.job = j.number JOIN sweeps s ON s.id = m.sweep "
        "WHERE j.id = ?1 AND s.stop_if <> '' AND s.stopped = 0",
        id);
    while (query.next()) ruled.push_back(query.integer(0));
  }
  if (state != kCancelled) {
    for (const std::int64_t sweep : ruled) judge(sweep);
  }
  for (const std::int64_t sweep : sweeps_waiting_for(id)) settle_waits(sweep);
}

bool Queue::is_full(std::int64_t sweep) const {
  Query query = database_.query(
      "SELECT 1 FROM sweeps WHERE id = ?1 AND at_most > 0 AND at_most <= "
      "(SELECT COUNT(*) FROM jobs WHERE state IN ('running', 'stopping') AND sweep = ?1)",
      sweep);
  return query.next();
}

std::pair<std::string, std::int64_t> Queue::why_waiting(const Job& job) const {
  if (!job.waits) {
    if (const auto refusal = refusal_of(job.asked_by)) return {refusal_text(job.asked_by, *refusal), refusal->until};
    if (std::string trouble = trouble_of(job.asked_by); !trouble.empty()) return {std::move(trouble), 0};
    if (!is_full(job.asked_by)) return {};
    return {fmt::format("as many jobs of {} run as may at once", sweep_word(job.asked_by)), 0};
  }
  std::string text;
  for (const std::string& word : prerequisites(job.asked_by)) {
    const JobCounts counts = counts_of(target_named(word));
    if (counts[kDone] == counts.total()) continue;
    text += text.empty() ? "waits for " : ", ";
    text += sweep_number(word) ? fmt::format("{}: {} of {} done", word, counts[kDone], counts.total()) : word;
  }
  return {text, 0};
}

std::vector<Job> Queue::explained(std::vector<Job> jobs) const {
  std::map<std::pair<std::int64_t, bool>, std::pair<std::string, std::int64_t>>
      reasons;  // by sweep, of jobs that wait for others or do not
  for (Job& job : jobs) {
    if (job.state != kQueued || !job.reason.empty()) continue;
    const auto [entry, is_new] = reasons.try_emplace({job.asked_by, job.waits});
    if (is_new) entry->second = why_waiting(job);
    job.reason = entry->second.first;
    job.not_before = std::max(job.not_before, entry->second.second);
  }
  return jobs;
}

}  // namespace shaken::server
