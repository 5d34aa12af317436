// SPDX-License-Identifier: MIT
#include "server/supervisor.h"

#include <fmt/chrono.h>
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
/// How much of a run's wall time is forgotten at most if the daemon is killed.
constexpr std::chrono::seconds kCounting{10};

std::string heading(int attempt) {
  const auto now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
  return fmt::format("{}attempt {}, {:%Y-%m-%dT%H:%M:%SZ}", kHeading, attempt, fmt::gmtime(now));
}

/// When the newest checkpoint of a run was written; the beginning of time if there is none.
std::filesystem::file_time_type checkpoint_time(const run::RunDirectory& directory) {
  std::error_code error;
  const auto written = std::filesystem::last_write_time(directory.checkpoint(), error);
  return error ? std::filesystem::file_time_type::min() : written;
}

/// The simulated time that a run has told of [s]; 0 if it has not.
double told_time(const run::RunDirectory& directory) {
  const auto progress = run::read_progress(directory.progress());
  return progress ? progress->sim_time : 0;
}

std::int64_t bytes_in(const std::filesystem::path& folder) {
  std::error_code error;
  std::int64_t bytes = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
    const auto size = entry.file_size(error);
    if (!error) bytes += static_cast<std::int64_t>(size);
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
      queue_.stopped(id, "the daemon ended before its worker was handed over");
      continue;
    }
    Worker& worker = workers_[id];
    worker.handle = *handle;
    worker.directory.root = options_.runs / id;
    worker.waits = true;  // until the executor says otherwise
    worker.noted.reset();
    worker.checkpoint_before = checkpoint_time(worker.directory);
    worker.told_before = told_time(worker.directory);
    spdlog::info("job {}: its worker {} has outlived the former daemon", id, printable(name));
  }
}

int Supervisor::free_slots() const {
  return std::min(options_.slots - static_cast<int>(workers_.size()), executor_.room());
}

void Supervisor::step() {
  try {
    executor_.step();
    if (std::string trouble = executor_.trouble(); trouble != told_trouble_) {
      queue_.set_trouble(options_.place, trouble);
      told_trouble_ = std::move(trouble);
    }
    settle_ended();
    count_wall_of_all();
    stop_stopping();
    if (shutting_down_) return;
    start_queued();
    enforce_limits();  // afterwards: what has found a free slot needs nobody to give way
  } catch (const StorageError& problem) {
    warn_once(problem.what());
  }
}

void Supervisor::settle_ended() {
  // all of them, whether or not the queue can be written: whether they have ended does not hang on that
  for (auto& [id, worker] : workers_) {
    try {
      if (!worker.job_end) look_at(id, worker);
    } catch (const StorageError& problem) {
      warn_once(problem.what());
    }
  }
  for (auto& [id, worker] : workers_) {
    if (!worker.unsaved_name.empty()) save_name(id, worker);
  }
  for (auto entry = workers_.begin(); entry != workers_.end();) {
    auto& [id, worker] = *entry;
    if (!worker.job_end) {
      ++entry;
      continue;
    }
    settle(id, worker);
    entry = workers_.erase(entry);
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

void Supervisor::look_at(const std::string& id, Worker& worker) {
  using enum WorkerReport::Phase;
  if (worker.unconfirmed) return judge_end(id, worker, *worker.unconfirmed);
  const WorkerReport report = executor_.poll(worker.handle);
  const bool stop_asked = worker.kill_at.has_value();
  switch (report.phase) {
    case kWaiting:
    case kWorking:
      if (worker.waits && report.phase == kWorking) {
        worker.started = worker.counted = Clock::now();
        if (worker.settings) queue_.accepted({options_.place, *worker.settings});
      }
      if (!worker.waits && report.phase == kWaiting) count_wall({id});  // it has been put back
      worker.waits = report.phase == kWaiting;
      worker.note = report.words;
      return;
    case kEnded:
      worker.was_at_work = true;
      worker.ended = Clock::now();
      judge_end(id, worker, report.end);  // first: the executor says it only once
      if (worker.waits && worker.settings) queue_.accepted({options_.place, *worker.settings});
      return;
    case kTaken:
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

void Supervisor::settle(const std::string& id, const Worker& worker) {
  count_wall({id});
  const auto& [outcome, reason] = *worker.job_end;
  switch (outcome) {
    case JobEnd::Outcome::kDone:
      queue_.finish(id, JobState::kDone, "");
      break;
    case JobEnd::Outcome::kFailed:
      queue_.finish(id, JobState::kFailed, reason);
      break;
    case JobEnd::Outcome::kStopped:
      // else what is stopped as soon as it begins would be started again for ever
      if (worker.was_at_work && !worker.kill_at && told_time(worker.directory) <= worker.told_before) {
        queue_.crashed(id, "stopped, not by Shaken, before it got any further (a time limit that is too short?)", false,
                       options_.retry_pauses);
      } else {
        queue_.stopped(id, reason);
      }
      break;
    case JobEnd::Outcome::kUnconfirmed:
    case JobEnd::Outcome::kCrashed:
      queue_.crashed(id, reason, checkpoint_time(worker.directory) != worker.checkpoint_before, options_.retry_pauses);
      break;
    case JobEnd::Outcome::kNotStarted:
      queue_.stopped(id, reason);
      queue_.set_reason(id, reason);
      break;
    case JobEnd::Outcome::kRefused:
      queue_.refused(id, {options_.place, worker.settings.value_or("")}, "could not be started: " + reason,
                     options_.refused_pause);
      break;
    case JobEnd::Outcome::kNoRoom: {
      const std::int64_t needed = std::max(2 * options_.least_room, 2 * bytes_in(worker.directory.root));
      queue_.no_room(
          id,
          fmt::format("{}. Goes on by itself once {} are free there", reason, bytes_text(static_cast<double>(needed))),
          needed, options_.retry_pauses.empty() ? std::chrono::milliseconds(0) : options_.retry_pauses.front());
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
  count_after_ = now + kCounting;
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
               queue_.give_way(job.id, options_.place)) {
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
    for (const std::string& id : queue_.there_is_room(room)) spdlog::info("job {}: there is room again", id);
  }
  if (free_slots() <= 0) return;
  for (const Job& job : queue_.next(free_slots() + kLookAhead, options_.place)) {
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

void Supervisor::start(const Job& job) {
  if (job.time_limit.count() > 0 && job.wall >= job.time_limit) {
    queue_.end_queued(job.id, JobState::kTimedOut, time_limit_over(job.time_limit));
    return;
  }
  const run::RunDirectory directory{options_.runs / job.id};
  std::error_code error;
  std::filesystem::create_directories(directory.root, error);
  if (error) {
    wait(job, directory.root.string() + ": " + error.message());
    return;
  }
  const std::string scene = queue_.scene(job.id);
  if (const std::string why = options_.refuse ? options_.refuse(job.id, scene) : ""; !why.empty()) {
    spdlog::error("job {}: {}", job.id, printable(why));
    queue_.end_queued(job.id, JobState::kFailed, why);
    return;
  }
  {
    const auto lock = run::DirectoryLock::acquire(directory.lock());
    if (!lock) {
      wait(job, lock.error().message);
      return;
    }
    if (const auto done = write_file_atomically(directory.scene(), scene); !done) {
      wait(job, done.error().message);
      return;
    }
  }
  const std::string settings = queue_.settings(job.id);
  const auto attempt = queue_.begin(job.id, &scene);
  if (!attempt) return;  // cancelled, or asked to go on longer, a moment ago

  Launch launch{directory.root,
                {directory.scene().string(), "--out", directory.root.string(), "--job-id", job.id, "--sweep-id",
                 sweep_word(job.sweep), "--label", job.label},
                heading(*attempt),
                settings};
  launch.arguments.insert(launch.arguments.end(), options_.worker_options.begin(), options_.worker_options.end());
  const auto checkpoint_before = checkpoint_time(directory);
  const double told_before = told_time(directory);
  const auto handle = executor_.start(launch);
  if (!handle) {
    could_not_start(job.id, handle.error().message);
    return;
  }
  Worker& worker = workers_[job.id];
  worker.handle = *handle;
  worker.directory = directory;
  worker.started = worker.counted = Clock::now();
  worker.checkpoint_before = checkpoint_before;
  worker.told_before = told_before;
  worker.settings = settings;
  if (const std::string name = executor_.name(*handle); name.empty()) {
    queue_.set_pid(job.id, *handle);
  } else {
    worker.waits = true;
    worker.unsaved_name = name;
    save_name(job.id, worker);
  }
  warnings_.clear();
  waited_.erase(job.id);
  pause_ = std::chrono::milliseconds(0);
  spdlog::info("job {}: attempt {}, worker {}: {}", job.id, *attempt, *handle, printable(job.label));
}

void Supervisor::save_name(const std::string& id, Worker& worker) {
  queue_.set_worker(id, worker.unsaved_name);
  worker.unsaved_name.clear();
}

void Supervisor::could_not_start(const std::string& id, const std::string& why) {
  pause_ = std::clamp(2 * pause_, options_.first_pause, kLongestPause);
  start_after_ = Clock::now() + pause_;
  const std::string told = "could not be started: " + why;
  warn_once(fmt::format("job {} {}; next try in {} s", id, told, std::chrono::duration<double>(pause_).count()));
  workers_[id].job_end = JobEnd{JobEnd::Outcome::kNotStarted, told};  // until the queue has taken it
}

void Supervisor::wait(const Job& job, const std::string& why) {
  warn_once("job " + job.id + " waits: " + why);
  std::chrono::milliseconds& pause = waited_[job.id];
  pause = std::clamp(2 * pause, options_.waiting_pause, 16 * options_.waiting_pause);
  queue_.pause(job.id, why, pause);
}

bool Supervisor::all_ended() const {
  return std::all_of(workers_.begin(), workers_.end(), [](const auto& entry) { return !entry.second.is_alive(); });
}

void Supervisor::shut_down() {
  shutting_down_ = true;
  queue_.hurry();
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
