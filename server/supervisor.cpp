#include "server/supervisor.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <limits>

#include "base/files.h"
#include "base/text.h"
#include "run/files/progress.h"

namespace shaken::server {
namespace {

/// How far beyond the free slots the queue is searched when jobs at its head cannot start, because a worker of a
/// predecessor still holds their directory.
constexpr int kLookAhead = 16;
constexpr std::chrono::milliseconds kLongestPause{60'000};

std::string heading(int attempt) { return fmt::format("{}attempt {}, {}", kHeading, attempt, utc_now()); }

/// When the newest checkpoint of a run was written; the beginning of time if there is none.
std::filesystem::file_time_type checkpoint_time(const run::RunDirectory& directory) {
  std::error_code error;
  const auto written = std::filesystem::last_write_time(directory.checkpoint(), error);
  return error ? std::filesystem::file_time_type::min() : written;
}

/// The simulated time that a run has reported [s]; 0 if it has not.
double reported_time(const run::RunDirectory& directory) {
  const auto progress = run::read_progress(directory.progress());
  return progress ? progress->sim_time : 0;
}

std::int64_t bytes_in(const std::filesystem::path& folder) {
  std::error_code error;
  std::int64_t bytes = 0;
  // step by step: a range's ++ throws where the system refuses to read on
  for (std::filesystem::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    std::error_code unknown;
    const auto size = entry->file_size(unknown);
    if (!unknown) bytes += static_cast<std::int64_t>(size);
  }
  return bytes;
}

/// As many as can be where the system does not say.
std::int64_t free_bytes(const std::filesystem::path& folder) {
  std::error_code error;
  const auto space = std::filesystem::space(folder, error);
  constexpr auto kMost = std::numeric_limits<std::int64_t>::max();
  return error || space.available > static_cast<std::uintmax_t>(kMost) ? kMost
                                                                       : static_cast<std::int64_t>(space.available);
}

}  // namespace

Supervisor::Supervisor(Queue& queue, Executor& executor, SupervisorOptions options)
    : queue_(queue), executor_(executor), options_(std::move(options)) {}

void Supervisor::adopt() {
  for (const auto& [id, name] : queue_.outlives_daemon()) {
    const auto handle = executor_.adopt(name);
    if (!handle) {
      queue_.ended(id, JobEvent::kWorkerStopped, "the daemon ended before its worker was handed over");
      continue;
    }
    Worker& worker = workers_[id];
    worker.handle = *handle;
    worker.directory.root = options_.runs / id;
    worker.waits = true;  // until the executor says otherwise
    worker.noted.reset();
    worker.checkpoint_before = checkpoint_time(worker.directory);
    worker.time_before = reported_time(worker.directory);
    spdlog::info("job {}: its worker {} has outlived the former daemon", id, printable(name));
  }
}

int Supervisor::free_slots() const {
  return std::min(options_.slots - static_cast<int>(workers_.size()), executor_.room());
}

void Supervisor::step() {
  try {
    executor_.step();
    if (std::string trouble = executor_.trouble(); trouble != known_trouble_) {
      queue_.set_trouble(options_.role, trouble);
      known_trouble_ = std::move(trouble);
    }
    record_ended();
    count_wall_of_all();
    stop_stopping();
    if (shutting_down_) return;
    start_queued();
    enforce_limits();  // afterwards: what has found a free slot needs nobody to give way
  } catch (const StorageError& problem) {
    warn_once(problem.what());
  }
}

void Supervisor::record_ended() {
  // all of them, whether or not the queue can be written: whether they have ended does not hang on that
  for (auto& [id, worker] : workers_) {
    try {
      if (!worker.job_end) check_worker(id, worker);
    } catch (const std::exception& problem) {
      warn_once(problem.what());
    }
  }
  for (auto& [id, worker] : workers_) {
    if (worker.unsaved_name.empty()) continue;
    queue_.set_worker(id, 0, worker.unsaved_name);
    worker.unsaved_name.clear();
  }
  for (auto entry = workers_.begin(); entry != workers_.end();) {
    auto& [id, worker] = *entry;
    if (!worker.job_end) {
      ++entry;
      continue;
    }
    try {
      record_end(id, worker);
      entry = workers_.erase(entry);
    } catch (const StorageError&) {  // no other could be recorded either
      throw;
    } catch (const std::exception& problem) {  // the others' ends do not wait for this one's
      warn_once("job " + id + ": " + problem.what());
      ++entry;
    }
  }
  write_notes();
}

/// In one transaction: thousands of runs may change their state at once.
void Supervisor::write_notes() {
  std::vector<std::pair<std::string, std::string>> notes;
  for (const auto& [id, worker] : workers_) {
    if (worker.noted != worker.note) notes.emplace_back(id, worker.note);
  }
  if (notes.empty()) return;
  queue_.set_notes(notes);
  for (const auto& [id, note] : notes) workers_.at(id).noted = note;
}

void Supervisor::check_worker(const std::string& id, Worker& worker) {
  using enum WorkerReport::Phase;
  if (worker.unconfirmed) return judge_end(id, worker, *worker.unconfirmed);
  const WorkerReport report = executor_.poll(worker.handle);
  const bool stop_asked = worker.kill_at.has_value();
  switch (report.phase) {
    case kWaiting:
    case kWorking:
      if (worker.waits && report.phase == kWorking) {
        worker.started = worker.counted = Clock::now();
        if (worker.settings) queue_.accepted({options_.role, *worker.settings});
      }
      if (!worker.waits && report.phase == kWaiting) count_wall({id});  // it has been put back
      worker.waits = report.phase == kWaiting;
      worker.note = report.words;
      return;
    case kEnded:
      worker.was_at_work = true;
      worker.ended = Clock::now();
      judge_end(id, worker, report.end);  // first: the executor says it only once
      if (worker.waits && worker.settings) queue_.accepted({options_.role, *worker.settings});
      return;
    case kRevoked:
      worker.job_end = JobEnd{JobEnd::Outcome::kStopped, report.words};
      break;
    case kLost:
      worker.job_end = JobEnd{stop_asked ? JobEnd::Outcome::kStopped : JobEnd::Outcome::kCrashed, report.words};
      break;
    case kRefused:
      worker.job_end = JobEnd{JobEnd::Outcome::kRefused, report.words};
      break;
  }
  worker.ended = Clock::now();
}

void Supervisor::judge_end(const std::string& id, Worker& worker, const WorkerEnd& end) {
  const JobEnd judged = judge(end, worker.kill_at.has_value(), id, worker.directory);
  const bool look_again = judged.outcome == JobEnd::Outcome::kUnconfirmed && !shutting_down_ &&
                          Clock::now() < *worker.ended + options_.confirm_within;
  if (look_again) {
    worker.unconfirmed = end;
  } else {
    worker.job_end = judged;
  }
}

void Supervisor::record_end(const std::string& id, const Worker& worker) {
  using enum JobEnd::Outcome;
  count_wall({id});
  const auto& [outcome, reason] = *worker.job_end;
  switch (outcome) {
    case kDone:
      queue_.ended(id, JobEvent::kWorkerDone);
      break;
    case kFailed:
      queue_.ended(id, JobEvent::kWorkerFailed, reason);
      break;
    case kStopped:
      // else what is stopped as soon as it begins would be started again for ever
      if (worker.was_at_work && !worker.kill_at && reported_time(worker.directory) <= worker.time_before) {
        queue_.crashed(id, "stopped, not by Shaken, before it got any further (a time limit that is too short?)", false,
                       options_.retry_pauses);
        break;
      }
      [[fallthrough]];
    case kNotStarted:
      queue_.ended(id, JobEvent::kWorkerStopped, reason);
      if (outcome == kNotStarted) queue_.set_reason(id, reason);
      break;
    case kUnconfirmed:
    case kCrashed:
      queue_.crashed(id, reason, checkpoint_time(worker.directory) != worker.checkpoint_before, options_.retry_pauses);
      break;
    case kRefused:
      queue_.refused(id, {options_.role, worker.settings.value_or("")}, "could not be started: " + reason,
                     options_.refused_pause);
      break;
    case kNoRoom: {
      const std::int64_t needed = std::max(2 * options_.least_room, 2 * bytes_in(worker.directory.root));
      const std::string text = bytes_text(static_cast<double>(needed));
      queue_.no_room(id, fmt::format("{}. Goes on by itself once {} are free there", reason, text), needed,
                     options_.retry_pauses.empty() ? std::chrono::milliseconds(0) : options_.retry_pauses.front());
      break;
    }
  }
  spdlog::info("job {}: {}", id, reason.empty() ? "done" : printable(reason));
}

void Supervisor::count_wall(const std::vector<std::string>& ids) {
  using std::chrono::milliseconds;
  std::vector<std::pair<std::string, milliseconds>> times;
  const auto now = Clock::now();
  for (const std::string& id : ids) {
    const Worker& worker = workers_.at(id);
    if (worker.handle == 0 || worker.waits) continue;  // it was never started
    const auto time = std::chrono::floor<milliseconds>(worker.ended.value_or(now) - worker.counted);
    if (time > milliseconds(0)) times.emplace_back(id, time);
  }
  if (times.empty()) return;
  queue_.add_wall(times);
  for (const auto& [id, time] : times) workers_.at(id).counted += time;
}

void Supervisor::count_wall_of_all() {
  const auto now = Clock::now();
  if (now < count_after_) return;
  std::vector<std::string> ids;
  for (const auto& [id, worker] : workers_) ids.push_back(id);
  count_wall(ids);
  count_after_ = now + options_.counting;
}

void Supervisor::enforce_limits() {
  const auto now = Clock::now();
  // else nothing would be started in the place of one that gives way
  const bool place_is_short = static_cast<int>(workers_.size()) >= options_.slots && now >= start_after_ &&
                              free_bytes(options_.runs) >= options_.least_room;
  for (const Job& job : queue_.jobs(std::nullopt, JobState::kRunning)) {
    const auto entry = workers_.find(job.id);
    if (entry == workers_.end() || !entry->second.is_alive() || entry->second.waits) continue;
    const Worker& worker = entry->second;
    constexpr std::chrono::milliseconds kNone{0};
    if (job.time_limit != kNone && job.wall + (now - worker.counted) >= job.time_limit) {
      spdlog::info("job {}: its time limit is over", job.id);
      queue_.time_out(job.id);
    } else if (job.soft_limit != kNone && place_is_short && now - worker.started >= job.soft_limit &&
               queue_.preempt(job.id, options_.role)) {
      spdlog::info("job {}: its soft limit is over, it gives way to others", job.id);
    }
  }
}

void Supervisor::stop_stopping() {
  const auto now = Clock::now();
  for (const Job& job : queue_.jobs(std::nullopt, JobState::kStopping)) {
    const auto entry = workers_.find(job.id);
    if (entry == workers_.end() || !entry->second.is_alive()) continue;
    Worker& worker = entry->second;
    if (!worker.kill_at) {
      spdlog::info("job {}: asked to stop", job.id);
      executor_.stop(worker.handle);
      worker.kill_at = now + options_.grace;
      worker.noted = "";  // the change of its state has taken that away
    } else if (now >= *worker.kill_at && !worker.killed) {
      spdlog::warn("job {}: has not stopped within {} s, is killed", job.id,
                   std::chrono::duration<double>(options_.grace).count());
      executor_.kill(worker.handle);
      worker.killed = true;
    }
  }
}

void Supervisor::start_queued() {
  if (Clock::now() < start_after_) return;
  const std::int64_t room = free_bytes(options_.runs);
  if (room >= options_.least_room) {
    for (const std::string& id : queue_.release_for_room(room)) spdlog::info("job {}: there is room again", id);
  }
  if (free_slots() <= 0) return;
  for (const Job& job : queue_.next(free_slots() + kLookAhead, options_.role)) {
    if (free_slots() <= 0 || Clock::now() < start_after_) return;
    if (room < options_.least_room) {  // for any job: none is passed over
      const std::string why = fmt::format("less than {} are free in {}",
                                          bytes_text(static_cast<double>(options_.least_room)), options_.runs.string());
      warn_once("job " + job.id + " waits: " + why);
      if (job.reason != why) queue_.set_reason(job.id, why);
    } else {
      start(job);
    }
  }
}

/// Puts the scene where the worker will find it.
Obstacle Supervisor::prepare(const Job& job, const std::string& scene) {
  const run::RunDirectory directory{options_.runs / job.id};
  std::error_code error;
  std::filesystem::create_directories(directory.root, error);
  if (error) return delayed(job, directory.root.string() + ": " + error.message());
  if (const std::string why = options_.refuse ? options_.refuse(job.id, scene) : ""; !why.empty()) {
    spdlog::error("job {}: {}", job.id, printable(why));
    return {.failure = why};
  }
  const auto lock = run::DirectoryLock::acquire(directory.lock());
  if (!lock) return delayed(job, lock.error().message);
  if (const auto done = write_file_atomically(directory.scene(), scene); !done) {
    return delayed(job, done.error().message);
  }
  return {};
}

void Supervisor::start(const Job& job) {
  // there before the queue says that it runs: whatever is thrown from here on, the job goes back into the queue
  const auto [entry, is_new] = workers_.try_emplace(job.id);
  if (!is_new) return;
  Worker& worker = entry->second;
  worker.job_end = JobEnd{JobEnd::Outcome::kNotStarted, ""};
  std::optional<Launched> launched;
  try {
    launched = queue_.launch(job.id, [&](const std::string& scene) { return prepare(job, scene); });
  } catch (...) {
    workers_.erase(entry);  // nothing has happened
    throw;
  }
  if (!launched) {
    workers_.erase(entry);
    return;
  }
  worker.directory.root = options_.runs / job.id;
  const run::RunDirectory& directory = worker.directory;
  Launch launch{directory.root,
                {directory.scene().string(), "--out", directory.root.string(), "--job-id", job.id, "--sweep-id",
                 sweep_word(job.sweep), "--label", job.label},
                heading(launched->attempt),
                launched->settings};
  launch.arguments.insert(launch.arguments.end(), options_.worker_options.begin(), options_.worker_options.end());
  worker.checkpoint_before = checkpoint_time(directory);
  worker.time_before = reported_time(directory);
  const auto handle = executor_.start(launch);
  if (!handle) {
    could_not_start(job.id, handle.error().message);
    return;
  }
  worker.handle = *handle;
  worker.job_end.reset();
  worker.started = worker.counted = Clock::now();
  worker.settings = launched->settings;
  worker.unsaved_name = executor_.name(*handle);
  worker.waits = !worker.unsaved_name.empty();
  warnings_.clear();
  waited_.erase(job.id);
  pause_ = std::chrono::milliseconds(0);
  spdlog::info("job {}: attempt {}, worker {}: {}", job.id, launched->attempt, *handle, printable(job.label));
  queue_.set_worker(job.id, worker.waits ? 0 : *handle, worker.unsaved_name);
  worker.unsaved_name.clear();
}

void Supervisor::could_not_start(const std::string& id, const std::string& why) {
  pause_ = std::clamp(2 * pause_, options_.first_pause, kLongestPause);
  start_after_ = Clock::now() + pause_;
  const std::string reason = "could not be started: " + why;
  warn_once(fmt::format("job {} {}; next try in {} s", id, reason, std::chrono::duration<double>(pause_).count()));
  workers_.at(id).job_end->reason = reason;  // until the queue has taken it
}

Obstacle Supervisor::delayed(const Job& job, const std::string& why) {
  warn_once("job " + job.id + " waits: " + why);
  std::chrono::milliseconds& pause = waited_[job.id];
  pause = std::clamp(2 * pause, options_.waiting_pause, 16 * options_.waiting_pause);
  return {.delay = why, .pause = pause};
}

bool Supervisor::all_ended() const {
  return std::all_of(workers_.begin(), workers_.end(), [](const auto& entry) { return !entry.second.is_alive(); });
}

void Supervisor::shut_down() {
  shutting_down_ = true;
  queue_.wait_less();
  try {
    queue_.stop_all();
  } catch (const StorageError& problem) {
    warn_once(problem.what());  // recover() of the next daemon does the same
  }
  for (auto& [id, worker] : workers_) {
    if (worker.kill_at || !worker.is_alive()) continue;
    executor_.stop(worker.handle);
    worker.kill_at = Clock::now() + options_.grace;
  }
}

void Supervisor::kill_all() {
  for (const auto& [id, worker] : workers_) {
    if (worker.is_alive()) executor_.kill(worker.handle);
  }
}

void Supervisor::warn_once(const std::string& warning) {
  if (warnings_.insert(warning).second) spdlog::warn("{}", printable(warning));
}

}  // namespace shaken::server
