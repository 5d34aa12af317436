#include "server/queue/queue.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "base/clock.h"
#include "base/core/check.h"
#include "base/text.h"
#include "scene/canonical.h"
#include "scene/length.h"
#include "scene/load.h"

namespace shaken::server {
namespace {

using enum JobEvent;
using std::chrono::milliseconds;

/// The scene `present` (canonical text), made as long as `wanted`, another text of the same run, also asks for;
/// `present` itself if it is that long already, `wanted` if the two are not of one run or `present` cannot be read.
std::string as_long_as_both(const std::string& present, const std::string& wanted) {
  if (present == wanted) return present;
  const auto now = scene::load_scene(present, "the scene so far");
  const auto then = scene::load_scene(wanted, "the scene asked for");
  if (!now || !then || scene::run_id(*now) != scene::run_id(*then)) return wanted;
  if (!scene::asks_for_more(*then, *now)) return present;
  return scene::to_json(scene::as_long_as_both(*now, *then)).dump(2) + "\n";
}

/// Where the run of a canonical scene ends [ticks]; none where that is known only once it is done, or cannot be read.
std::optional<Tick> end_of(const std::string& text) {
  const auto plan = scene::load_scene(text, "the scene of a job");
  return plan && !plan->until ? std::optional(scene::total_ticks(*plan)) : std::nullopt;
}

/// The journal's words for what users ask for.
std::string cause_of(JobEvent request, JobState state) {
  if (request == kCancel) return std::string(kCancelledOnRequest);
  if (request == kHold) return std::string(kHeldOnRequest);
  return state == JobState::kHeld ? "released on request" : "retried on request";
}

/// Whether a job that is submitted again was done, and its results are not there any more.
bool has_lost_results(const NewJob& job, const Job& known) {
  return known.state == JobState::kDone && !job.has_results.value_or(true);
}

std::string submitted_text(std::int64_t sweep, const Terms& terms) {
  std::string text = "submitted in " + sweep_word(sweep);
  for (const Target& target : terms.after) {
    text += (&target == &terms.after.front() ? ", to come after " : ", ") + to_word(target);
  }
  return text;
}

/// The scene of a job that is there already, once it has been submitted again.
std::string scene_after(const QueueStore& store, const NewJob& job, const Job& known) {
  if (is_withdrawn(known.phase)) return job.scene;
  const std::string present = store.scene(job.id);
  const bool stays = known.state == JobState::kDone && !has_lost_results(job, known);
  return stays ? present : as_long_as_both(present, job.scene);
}

/// Where others wait to start from its end, a job keeps that end.
void refuse_other_end(const QueueStore& store, const std::string& id, const std::string& scene) {
  const std::vector<std::string> next = store.ids_starting_from(id);
  const bool is_needed = std::ranges::any_of(next, [&](const std::string& each) {
    return store.job(each)->attempt == 0;  // afterwards it goes on from its own state
  });
  if (!is_needed) return;
  const std::string present = store.scene(id);
  const auto end = end_of(present), then = end_of(scene);
  if (present == scene || !end || !then || *end == *then) return;
  throw Conflict(fmt::format("run {} cannot end elsewhere: job {} is to start from its end; cancel that one first", id,
                             next.front()));
}

/// Whether the job's scene has become longer.
bool make_longer(QueueStore& store, const Job& job, const std::string& scene, const std::string& how) {
  const std::string present = store.scene(job.id);
  const std::string longer = as_long_as_both(present, scene);
  if (longer == present) return false;
  refuse_other_end(store, job.id, longer);
  store.set_scene(job.id, longer);
  if (has_worker(job.state)) store.set(job.id, "longer", 1);
  store.add_to_journal(job.id, to_word(job.state), to_word(job.state), job.attempt, "asked to go on longer, " + how);
  return true;
}

void refuse_circle(const QueueStore& store, std::span<const NewJob> jobs, const Terms& terms) {
  if (terms.after.empty()) return;
  // Those that may be queued by this submission, and so may wait.
  std::set<std::string> ours;
  for (const NewJob& job : jobs) {
    const auto known = store.job(job.id);
    if (!known || known->state != JobState::kDone || has_lost_results(job, *known)) ours.insert(job.id);
  }
  // Each of the targets, and what the jobs in it wait for themselves.
  std::vector<Target> pending = terms.after;
  std::set<Target> seen(pending.begin(), pending.end());
  while (!pending.empty()) {
    const Target target = pending.back();
    pending.pop_back();
    for (const std::string& id : store.ids_of(target)) {
      if (ours.contains(id)) {
        throw Conflict(fmt::format(
            "these jobs would wait for themselves: job {} is one of them, and {} has it too{}", id, to_word(target),
            std::ranges::find(terms.after, target) == terms.after.end() ? ", for which they would wait by way of others"
                                                                        : ""));
      }
      const Job job = *store.job(id);
      const bool needs_start = !job.starts_from.empty() && job.attempt == 0 && job.state != JobState::kDone;
      if (needs_start && ours.contains(job.starts_from)) {
        throw Conflict(
            fmt::format("these jobs would wait for themselves: job {} starts from run {}, which is one of them", id,
                        job.starts_from));
      }
      if (needs_start && seen.insert(job.starts_from).second) pending.emplace_back(job.starts_from);
      if (!job.waits) continue;
      for (const std::string& word : store.prerequisites(job.asked_by)) {
        if (seen.insert(target_named(word)).second) pending.push_back(target_named(word));
      }
    }
  }
}

void refuse_conflicts(const QueueStore& store, std::span<const NewJob> jobs, const Terms& terms) {
  refuse_circle(store, jobs, terms);
  std::map<std::string, std::string> scenes;  // afterwards, of those jobs that are there already
  for (const NewJob& job : jobs) {
    const auto known = store.job(job.id);
    if (!known) continue;
    std::string scene = scene_after(store, job, *known);
    refuse_other_end(store, job.id, scene);
    if (scene != job.scene) scenes.emplace(job.id, std::move(scene));
  }
  std::set<std::string> ours;
  for (const NewJob& job : jobs) ours.insert(job.id);
  for (const NewJob& job : jobs) {
    if (job.starts_from.empty()) continue;
    auto scene = scenes.find(job.starts_from);
    if (scene == scenes.end()) {
      if (ours.contains(job.starts_from) || !store.job(job.starts_from)) continue;  // it is as this submission says
      scene = scenes.emplace(job.starts_from, store.scene(job.starts_from)).first;
    }
    const auto plan = scene::load_scene(scene->second, "the scene of a job");
    if (!plan || plan->until || std::llround(job.starts_at / plan->system.dt) == scene::total_ticks(*plan)) continue;
    throw Conflict(
        fmt::format("job {} is to start from the end of run {} at {:.10g} s, but that run goes on to {:.10g} s "
                    "here, where its last state is kept: start from there, or clean that run first",
                    job.id, job.starts_from, job.starts_at, plan->total_time()));
  }
}

/// Why what the jobs of a sweep come after will not be done as things are; "" if it may be.
std::string why_never_after(const QueueStore& store, std::int64_t sweep) {
  for (const std::string& word : store.prerequisites(sweep)) {
    const JobCounts counts = store.counts_of(target_named(word));
    const auto trouble = state_without_result(counts);
    if (!trouble) continue;
    const std::string of_all = sweep_number(word) ? fmt::format("{} of {} ", counts[*trouble], counts.total()) : "";
    return fmt::format("it was to come after {}: {}{}", word, of_all, to_word(*trouble));
  }
  return "";
}

/// Why the run that a job starts from will not be done as things are; "" if it may be, or need not be.
std::string why_never_started_from(const QueueStore& store, const Job& job) {
  if (!job.waits_for_start) return "";
  const Job run = *store.job(job.starts_from);
  const bool is_hopeless = has_ended(run.state) || run.phase == JobPhase::kHeldForOthers;
  return is_hopeless ? fmt::format("it is to start from run {}: {}", run.id, to_word(run.state)) : "";
}

}  // namespace

Queue::Queue(const std::filesystem::path& file) : store_(file), file_(file), last_change_(store_.last_change()) {}

/// What `work` does is one transaction. Wakes those who wait for a change.
template <class Work>
auto Queue::write(const Work& work) {
  const std::lock_guard lock(mutex_);
  if (!closed_.empty()) throw StorageError(closed_);
  Transaction transaction(store_.database());
  const auto commit = [&] {
    if (file_.is_gone()) throw StorageError(file_.path().string() + " was removed or replaced");
    const auto changed = store_.sweeps_changed_since(last_change_);
    const std::int64_t last_change = store_.last_change();
    transaction.commit();
    last_change_ = last_change;
    for (const std::int64_t sweep : changed) sums_.erase(sweep);
    ready_.clear();
    counts_.reset();
    work_ahead_is_old_ = true;
    changed_.notify_all();
  };
  if constexpr (std::is_void_v<decltype(work())>) {
    work();
    commit();
  } else {
    auto result = work();
    commit();
    return result;
  }
}

/// What the rules make of a job when something happens to it; then of those that depend on it. The phase that it has
/// now; none if nothing has changed. `reason`: of its new state, where the rules have no words of their own.
std::optional<JobPhase> Queue::apply(const std::string& id, JobEvent event, const std::string& cause,
                                     const std::string& reason) {
  const auto job = store_.job(id);
  const auto to = job ? change(*job, event, cause, reason) : std::nullopt;
  if (!to) return to;
  const bool ends = has_ended(stored(*to).state), had_ended = has_ended(job->state);
  if (ends && *to != JobPhase::kCancelled) {
    for (const std::int64_t sweep : store_.ruled_sweeps_of(id)) check_stop_rule(sweep);
  }
  if (ends || had_ended) {
    for (const std::int64_t sweep : store_.sweeps_that_wait_for(id)) update_waiting(sweep);
  }
  if (ends || had_ended || *to == JobPhase::kHeldForOthers || job->phase == JobPhase::kHeldForOthers) {
    hold_or_release(store_.ids_starting_from(id));
  }
  if (*to == JobPhase::kQueued) hold_or_release({id});
  return to;
}

/// As apply(), of this job alone.
std::optional<JobPhase> Queue::change(const Job& job, JobEvent event, const std::string& cause,
                                      const std::string& reason) {
  const auto to = next_phase(job.phase, event);
  if (!to) return to;
  // a job that was to stop has stopped, whatever its worker ended by
  std::string why = job.state == JobState::kStopping && *to != JobPhase::kFailed ? "" : reason;
  if (*to == JobPhase::kCancelled) why = event == kClean ? kCleanedOnRequest : kCancelledOnRequest;
  if (*to == JobPhase::kHeldOnRequest) why = kHeldOnRequest;
  if (*to == JobPhase::kTimedOut) why = time_limit_text(job.time_limit);
  store_.set_phase(job, *to, why, cause);
  if (event == kClean) store_.set(job.id, "attempt", 0);  // it has no state of its own any more
  return to;
}

std::vector<std::string> Queue::recover() {
  return write([&] {
    std::vector<std::string> recovered;
    for (const Job& job : store_.active()) {
      if (!job.worker.empty()) continue;
      apply(job.id, kWorkerStopped, "the daemon ended without warning");
      recovered.push_back(job.id);
    }
    return recovered;
  });
}

std::vector<std::pair<std::string, std::string>> Queue::outlives_daemon() const {
  std::vector<std::pair<std::string, std::string>> found;
  for (Job& job : read(&QueueStore::active)) {
    if (!job.worker.empty()) found.emplace_back(std::move(job.id), std::move(job.worker));
  }
  return found;
}

Submitted Queue::submit(const std::string& name, int priority, std::span<const NewJob> jobs, const Terms& terms) {
  return write([&] {
    const auto same = store_.same_sweep(name, jobs);
    Submitted result{.sweep = same ? *same : store_.add_sweep(name), .created = !same};
    refuse_conflicts(store_, jobs, terms);
    const std::string cause = submitted_text(result.sweep, terms);
    for (std::size_t position = 0; position < jobs.size(); ++position) {
      const NewJob& job = jobs[position];
      if (store_.add_job(job, priority, result.sweep, terms, cause)) {
        ++(job.has_results.value_or(false) ? result.n_found : result.n_new);
      } else {
        submit_again(job, priority, terms, result);
      }
      if (result.created) store_.add_member(result.sweep, static_cast<std::int64_t>(position), job);
    }
    store_.set_terms(result.sweep, terms);
    if (!terms.after.empty()) update_waiting(result.sweep);
    std::vector<std::string> ids(jobs.size());
    std::ranges::transform(jobs, ids.begin(), &NewJob::id);
    hold_or_release(std::move(ids));
    result.counts = store_.counts_of(Target(result.sweep));
    return result;
  });
}

void Queue::submit_again(const NewJob& job, int priority, const Terms& terms, Submitted& result) {
  const Job known = *store_.job(job.id);
  const std::string sweep = sweep_word(result.sweep);
  const bool is_lost = has_lost_results(job, known);
  bool is_longer = false;
  if (is_withdrawn(known.phase)) {
    store_.set_scene(job.id, job.scene);
    // its worker may be about to end without having heard that it is to stop
    if (known.state == JobState::kStopping) store_.set(job.id, "longer", 1);
  } else if (known.state != JobState::kDone || is_lost) {
    is_longer = make_longer(store_, known, job.scene, "in " + sweep);
  }
  store_.update_request(job, priority, result.sweep, terms);
  const auto changed = apply(job.id, is_lost ? kResultsLost : kSubmitAgain, "submitted again in " + sweep);
  if (known.phase == JobPhase::kStopToTimeOut) store_.set(job.id, "wall_ms", 0);
  if (is_longer) {
    ++result.n_extended;
  } else if (changed) {
    ++result.n_requeued;
  }
}

void Queue::check(std::span<const NewJob> jobs, const Terms& terms) const {
  const std::lock_guard lock(mutex_);
  refuse_conflicts(store_, jobs, terms);
}

/// Queued jobs are held while nothing comes of what they wait for, and those that are held for that are queued again
/// once something may. After each that changes, the jobs that start from its end are looked at in the same way.
void Queue::hold_or_release(std::vector<std::string> ids) {
  std::map<std::int64_t, std::string> why_never;  // by sweep: no job ends here, so that it stays
  std::ranges::reverse(ids);                      // the next one is the last
  while (!ids.empty()) {
    const Job job = *store_.job(ids.back());
    ids.pop_back();
    std::string why = why_never_started_from(store_, job);
    if (why.empty() && job.waits) {
      const auto [entry, is_new] = why_never.try_emplace(job.asked_by);
      if (is_new) entry->second = why_never_after(store_, job.asked_by);
      why = entry->second;
    }
    const auto changed = why.empty() ? change(job, kPrerequisiteRetried, "what it waits for goes on")
                                     : change(job, kPrerequisiteFailed, why, why);
    if (!changed) continue;
    const std::vector<std::string> next = store_.ids_starting_from(job.id);
    ids.insert(ids.end(), next.rbegin(), next.rend());
  }
}

void Queue::update_waiting(std::int64_t sweep) {
  const bool all_done = std::ranges::all_of(store_.prerequisites(sweep), [&](const std::string& word) {
    const JobCounts counts = store_.counts_of(target_named(word));
    return counts[JobState::kDone] == counts.total();
  });
  hold_or_release(store_.waiting_in(sweep));
  if (all_done) store_.end_waiting(sweep);
}

void Queue::update_all_waiting() {
  for (const std::int64_t sweep : store_.sweeps_that_wait()) update_waiting(sweep);
}

void Queue::check_stop_rule(std::int64_t sweep) {
  const Sweep now = *store_.sweep(sweep);
  const auto rule = StopRule::parse(now.stop_if);
  if (!rule || !rule->is_broken(now.counts)) return;
  store_.set_stopped(sweep);
  const std::string reason =
      fmt::format("{}; `shaken resume {}` lifts this rule", rule->reason(now.counts), sweep_word(sweep));
  for (const std::string& id : store_.ids_obeying(sweep)) change(*store_.job(id), kStopRuleMet, reason, reason);
}

std::vector<Job> Queue::jobs(std::optional<std::int64_t> sweep, std::optional<JobState> state) const {
  const std::lock_guard lock(mutex_);
  return explained(store_.jobs(sweep, state));
}

std::vector<Job> Queue::begun(Sweep& sweep, SweepWork& work) const {
  const std::lock_guard lock(mutex_);
  const Sums& sums = sums_of(sweep.id);
  sweep.counts = sums.counts;
  work = sums.work;
  return sweep.counts.of(has_ended) == sweep.counts.total() ? std::vector<Job>{} : explained(store_.begun(sweep.id));
}

std::map<std::int64_t, double> Queue::work_ahead() const {
  constexpr int kMany = 5000;  // some ten milliseconds
  constexpr std::chrono::seconds kStale{2};
  const std::lock_guard lock(mutex_);
  if (const auto now = std::chrono::steady_clock::now(); work_ahead_is_old_ && now >= work_ahead_until_) {
    work_ahead_ = store_.work_ahead();
    work_ahead_is_old_ = false;
    work_ahead_until_ = counted()[JobState::kQueued] > kMany ? now + kStale : now;
  }
  return work_ahead_;
}

const JobCounts& Queue::counted() const {
  if (!counts_) counts_ = store_.counts();
  return *counts_;
}

JobCounts Queue::counts() const {
  const std::lock_guard lock(mutex_);
  return counted();
}

const Queue::Sums& Queue::sums_of(std::int64_t sweep) const {
  const auto known = sums_.find(sweep);
  if (known != sums_.end()) return known->second;
  return sums_.emplace(sweep, Sums{store_.counts_of(Target(sweep)), store_.work_of(sweep)}).first->second;
}

std::vector<Sweep> Queue::sweeps() const {
  const std::lock_guard lock(mutex_);
  std::vector<Sweep> sweeps = store_.sweeps();
  for (Sweep& sweep : sweeps) sweep.counts = sums_of(sweep.id).counts;
  return sweeps;
}

std::vector<Job> Queue::next(int limit, const ExecutorRole& executor) const {
  const std::lock_guard lock(mutex_);
  const std::int64_t now = utime_now();
  const auto known = ready_.find(executor.name);
  if (known != ready_.end() && known->second.limit == limit && known->second.from <= now && now < known->second.until) {
    return known->second.jobs;
  }
  Ready ready{limit, now, store_.next_pause_end(), store_.ready(limit, executor)};
  return (ready_[executor.name] = std::move(ready)).jobs;
}

std::optional<Job> Queue::job(const std::string& id) const {
  const std::lock_guard lock(mutex_);
  auto job = store_.job(id);
  return job ? explained({*std::move(job)}).front() : job;
}

/// Why a queued job waits, and until when at least; "" and 0 if nothing keeps it.
std::pair<std::string, std::int64_t> Queue::why_waiting(const Job& job) const {
  const std::string sweep = sweep_word(job.asked_by);
  if (job.waits) {
    std::string text;
    for (const std::string& word : store_.prerequisites(job.asked_by)) {
      const JobCounts counts = store_.counts_of(target_named(word));
      const std::int64_t n_done = counts[JobState::kDone];
      if (n_done == counts.total()) continue;
      text += text.empty() ? "waits for " : ", ";
      text += sweep_number(word) ? fmt::format("{}: {} of {} done", word, n_done, counts.total()) : word;
    }
    return {text, 0};
  }
  if (const auto refusal = store_.refusal_of(job.asked_by)) {
    const std::int64_t now = utime_now();
    return {fmt::format("{}. Next attempt at {}, or at once after `shaken retry {}`", refusal->reason,
                        clock_text(1e-6 * static_cast<double>(refusal->until - now), now), sweep),
            refusal->until};
  }
  for (const auto& [name, trouble] : troubles_) {
    if (trouble.second.empty()) continue;
    const std::string executor = store_.sweep(job.asked_by)->executor;
    if (executor == name || (executor.empty() && trouble.first.is_default)) return {trouble.second, 0};
  }
  if (!store_.is_full(job.asked_by)) return {};
  return {fmt::format("as many jobs of {} run as may at once", sweep), 0};
}

std::vector<Job> Queue::explained(std::vector<Job> jobs) const {
  std::map<std::pair<std::int64_t, bool>, std::pair<std::string, std::int64_t>>
      reasons;  // by sweep, of jobs that wait for others or do not
  for (Job& job : jobs) {
    if (job.state != JobState::kQueued || !job.reason.empty()) continue;
    if (job.waits_for_start && !job.waits) {
      job.reason = fmt::format("waits for run {}, from which it starts", job.starts_from);
      continue;
    }
    const auto [entry, is_new] = reasons.try_emplace({job.asked_by, job.waits});
    if (is_new) entry->second = why_waiting(job);
    job.reason = entry->second.first;
    job.not_before = std::max(job.not_before, entry->second.second);
  }
  return jobs;
}

int Queue::extend(std::span<const std::pair<std::string, std::string>> scenes) {
  return write([&] {
    int changed = 0;
    for (const auto& [id, scene] : scenes) {
      const auto job = store_.job(id);
      if (!job || !make_longer(store_, *job, scene, "on request")) continue;
      apply(id, kExtend, "goes on from its end");
      ++changed;
    }
    return changed;
  });
}

int Queue::request(JobEvent event, const Target& target) {
  return write([&] {
    int changed = 0;
    std::map<std::int64_t, bool> was_refused;  // by sweep
    const auto end_refusal = [&](std::int64_t sweep) {
      const auto [entry, is_new] = was_refused.try_emplace(sweep);
      const auto refusal = is_new ? store_.refusal_of(sweep) : std::nullopt;
      if (refusal) store_.forget_refusal(refusal->executor, refusal->settings);
      return entry->second = entry->second || refusal;
    };
    for (const std::string& id : event == kRetry ? store_.ids_of(target) : store_.unfinished(target)) {
      const Job job = *store_.job(id);
      const bool is_paused =
          event == kRetry && job.state == JobState::kQueued && (end_refusal(job.asked_by) || job.crashes > 0);
      if (is_paused) {
        for (const std::string_view column : {"crashes", "not_before_utime"}) store_.set(id, column, 0);
        store_.set(id, "reason", "");
      }
      const bool is_released = job.phase == JobPhase::kHeldForOthers && (event == kResume || event == kRetry);
      if (is_released) store_.set(id, "waits", 0);  // it waits for the run that it starts from only
      const auto to = apply(id, event, cause_of(event, job.state));
      changed += to || is_paused ? 1 : 0;
    }
    if (event == kCancel || event == kHold) return changed;
    if (const std::int64_t* sweep = std::get_if<std::int64_t>(&target)) store_.lift_met_rule(*sweep);
    update_all_waiting();
    return changed;
  });
}

int Queue::set_priority(const Target& target, int priority) {
  return write([&] { return store_.set_priority(target, priority); });
}

bool Queue::clean(const std::string& id, JobState state) {
  return write([&] {
    const auto job = store_.job(id);
    return job && job->state == state && apply(id, kClean, std::string(kCleanedOnRequest));
  });
}

std::optional<Launched> Queue::launch(const std::string& id, const Prepare& prepare) {
  return write([&]() -> std::optional<Launched> {
    if (!store_.is_ready(id)) return std::nullopt;  // cancelled a moment ago, say
    const Job job = *store_.job(id);
    if (job.time_limit.count() > 0 && job.wall >= job.time_limit) {
      apply(id, kTimeLimit, time_limit_text(job.time_limit));
      return std::nullopt;
    }
    const Obstacle obstacle = prepare ? prepare(store_.scene(id)) : Obstacle{};
    if (!obstacle.failure.empty()) {
      apply(id, kRefuseScene, obstacle.failure, obstacle.failure);
      return std::nullopt;
    }
    if (!obstacle.delay.empty()) {
      store_.set(id, "reason", obstacle.delay);
      store_.set(id, "not_before_utime", utime_now() + 1000 * obstacle.pause.count());
      return std::nullopt;
    }
    apply(id, kLaunch, "attempt " + std::to_string(job.attempt + 1));
    return Launched{job.attempt + 1, store_.settings(id)};
  });
}

void Queue::set_reason(const std::string& id, const std::string& reason) {
  write([&] {
    if (const auto job = store_.job(id); job && job->state == JobState::kQueued) store_.set(id, "reason", reason);
  });
}

void Queue::set_worker(const std::string& id, int pid, const std::string& worker) {
  write([&] {
    store_.set(id, "pid", pid);
    store_.set(id, "worker", worker);
  });
}

void Queue::set_notes(std::span<const std::pair<std::string, std::string>> notes) {
  write([&] {
    for (const auto& [id, note] : notes) {
      const auto job = store_.job(id);
      if (job && has_worker(job->state) && job->reason != note) store_.set(id, "reason", note);
    }
  });
}

void Queue::add_wall(std::span<const std::pair<std::string, milliseconds>> times) {
  write([&] {
    for (const auto& [id, time] : times) store_.add_wall(id, time);
  });
}

void Queue::ended(const std::string& id, JobEvent event, const std::string& why) {
  write([&] {
    if (event == kWorkerDone && store_.job(id)->longer) {
      apply(id, kWorkerStopped, "the worker is done; it has been asked to go on longer meanwhile");
    } else {
      apply(id, event, why.empty() ? "the worker is done" : why, event == kWorkerFailed ? why : "");
    }
  });
}

void Queue::crashed(const std::string& id, const std::string& reason, bool went_on,
                    std::span<const milliseconds> pauses) {
  write([&] {
    const Job job = *store_.job(id);
    const int before = went_on ? 0 : job.crashes;
    if (before >= static_cast<int>(pauses.size())) {
      apply(id, kCrashedTooOften, reason,
            fmt::format("{} times in a row, without a checkpoint between: {}", before + 1, reason));
      return;
    }
    const milliseconds pause = pauses[static_cast<std::size_t>(before)];
    const std::string text = duration_text(std::chrono::duration<double>(pause).count());
    apply(id, kWorkerCrashed, reason, fmt::format("{}; is tried again after {}", reason, text));
    if (job.state != JobState::kRunning) return;  // it was to stop
    store_.set(id, "crashes", before + 1);
    store_.set(id, "not_before_utime", utime_now() + 1000 * pause.count());
  });
}

void Queue::no_room(const std::string& id, const std::string& reason, std::int64_t needed, milliseconds pause) {
  write([&] {
    if (apply(id, kNoRoom, reason, reason) != JobPhase::kHeldForRoom) return;
    store_.set(id, "needed_bytes", needed);
    store_.set(id, "not_before_utime", utime_now() + 1000 * pause.count());
  });
}

std::vector<std::string> Queue::release_for_room(std::int64_t free) {
  const auto waiting = read(&QueueStore::held_for_room, free);
  if (waiting.empty()) return {};  // asked ten times a second
  return write([&] {
    std::vector<std::string> released;
    for (const std::string& id : waiting) {
      if (apply(id, kRoomAgain, "there is room again")) released.push_back(id);
    }
    update_all_waiting();
    return released;
  });
}

void Queue::refused(const std::string& id, const ExecutorRequest& request, const std::string& reason,
                    milliseconds first_pause) {
  write([&] {
    apply(id, kWorkerStopped, reason);  // why_waiting() says why
    const auto [times, holds] = store_.times_refused(request);
    if (holds) return;  // the same refusal: of others that went with this job
    store_.add_refusal(request, times + 1, refusal_pause(first_pause, times), reason);
  });
}

void Queue::accepted(const ExecutorRequest& request) {
  const std::lock_guard lock(mutex_);
  store_.forget_refusal(request.executor.name, request.settings);
  ready_.clear();
}

void Queue::set_trouble(const ExecutorRole& executor, const std::string& why) {
  const std::lock_guard lock(mutex_);
  troubles_[executor.name] = {executor, why};
}

bool Queue::preempt(const std::string& id, const ExecutorRole& executor) {
  return write([&] {
    const auto job = store_.job(id);
    if (!job || job->state != JobState::kRunning || !store_.has_successor(*job, executor)) return false;
    return apply(id, kSoftLimit, "its soft limit is over: it gives way to others").has_value();
  });
}

void Queue::time_out(const std::string& id) {
  write([&] { apply(id, kTimeLimit, "its time limit is over"); });
}

void Queue::close(const std::string& why) {
  const std::lock_guard lock(mutex_);
  closed_ = why;
}

void Queue::wait_less() {
  const std::lock_guard lock(mutex_);
  store_.database().wait_at_most(milliseconds(500));
}

void Queue::stop_all() {
  write([&] {
    for (const Job& job : store_.active()) {
      if (job.worker.empty()) apply(job.id, kShutDown, "the daemon stops");
    }
  });
}

std::int64_t Queue::last_change() const {
  const std::lock_guard lock(mutex_);
  return last_change_;
}

void Queue::wait_for_change(std::int64_t sequence, milliseconds timeout) const {
  std::unique_lock lock(mutex_);
  changed_.wait_for(lock, timeout, [&] { return last_change_ > sequence; });
}

}  // namespace shaken::server
