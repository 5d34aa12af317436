// SPDX-License-Identifier: MIT
#include "server/supervisor.h"

#include <fmt/chrono.h>
#include <spdlog/spdlog.h>

#include "base/files.h"

namespace shaken::server {
namespace {

/// How far beyond the free slots the queue is searched when jobs at its head cannot start, because a worker of a
/// predecessor still holds their directory.
constexpr int kLookAhead = 16;

std::string heading(int attempt) {
  const auto now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
  return fmt::format("{}attempt {}, {:%Y-%m-%dT%H:%M:%SZ}", kHeading, attempt, fmt::gmtime(now));
}

}  // namespace

Supervisor::Supervisor(Queue& queue, Executor& executor, SupervisorOptions options)
    : queue_(queue), executor_(executor), options_(std::move(options)) {}

void Supervisor::step() {
  try {
    settle_ended();
    stop_stopping();
    if (!shutting_down_) start_queued();
  } catch (const StorageError& problem) {
    complain(problem.what());
  }
}

void Supervisor::settle_ended() {
  for (auto entry = workers_.begin(); entry != workers_.end();) {
    auto& [id, worker] = *entry;
    if (!worker.job_end) {
      if (const auto end = executor_.poll(worker.handle)) {
        worker.job_end = judge(*end, worker.handle, worker.kill_at.has_value(), worker.directory);
      }
    }
    if (!worker.job_end) {
      ++entry;
      continue;
    }
    const auto& [outcome, reason] = *worker.job_end;
    switch (outcome) {
      case JobEnd::Outcome::kDone:
        queue_.finish(id, JobState::kDone, "");
        break;
      case JobEnd::Outcome::kFailed:
        queue_.finish(id, JobState::kFailed, reason);
        break;
      case JobEnd::Outcome::kStopped:
        queue_.stopped(id, reason);
        break;
    }
    spdlog::info("job {}: {}", id, reason.empty() ? "done" : reason);
    entry = workers_.erase(entry);
  }
}

void Supervisor::stop_stopping() {
  const auto now = Clock::now();
  for (const Job& job : queue_.jobs(std::nullopt, JobState::kStopping)) {
    const auto entry = workers_.find(job.id);
    if (entry == workers_.end() || entry->second.job_end) continue;
    Worker& worker = entry->second;
    if (!worker.kill_at) {
      spdlog::info("job {}: asked to stop", job.id);
      executor_.stop(worker.handle);
      worker.kill_at = now + options_.grace;
    } else if (now >= *worker.kill_at && !worker.killed) {
      spdlog::warn("job {}: has not stopped within {} s, is killed", job.id,
                   std::chrono::duration<double>(options_.grace).count());
      executor_.kill(worker.handle);
      worker.killed = true;
    }
  }
}

void Supervisor::start_queued() {
  const int free = options_.slots - static_cast<int>(workers_.size());
  if (free <= 0) return;
  int started = 0;
  for (const Job& job : queue_.next(free + kLookAhead)) {
    if (started == free) return;
    if (start(job)) ++started;
  }
}

bool Supervisor::start(const Job& job) {
  const run::RunDirectory directory{options_.runs / job.id};
  std::error_code error;
  std::filesystem::create_directories(directory.root, error);
  if (error) {
    complain(directory.root.string() + ": " + error.message());
    return false;
  }
  {
    const auto lock = run::DirectoryLock::acquire(directory.lock());
    if (!lock) {
      complain("job " + job.id + " waits: " + lock.error().message);
      return false;
    }
    if (auto done = write_file_atomically(directory.scene(), queue_.scene(job.id)); !done) {
      complain("job " + job.id + " waits: " + done.error().message);
      return false;
    }
  }
  const auto attempt = queue_.begin(job.id);
  if (!attempt) return false;  // cancelled a moment ago

  Launch launch{directory.root,
                {directory.scene().string(), "--out", directory.root.string(), "--job-id", job.id, "--sweep-id",
                 sweep_word(job.sweep), "--label", job.label},
                heading(*attempt)};
  launch.arguments.insert(launch.arguments.end(), options_.worker_options.begin(), options_.worker_options.end());
  Worker& worker = workers_[job.id];
  worker.directory = directory;
  const auto handle = executor_.start(launch);
  if (!handle) {
    worker.job_end = JobEnd{JobEnd::Outcome::kFailed, handle.error().message};
    return false;
  }
  worker.handle = *handle;
  queue_.set_pid(job.id, *handle);
  complaints_.clear();
  spdlog::info("job {}: attempt {}, worker {}: {}", job.id, *attempt, *handle, job.label);
  return true;
}

void Supervisor::shut_down() {
  shutting_down_ = true;
  try {
    queue_.stop_all();
  } catch (const StorageError& problem) {
    complain(problem.what());  // recover() of the next daemon does the same
  }
  for (auto& [id, worker] : workers_) {
    if (worker.kill_at || worker.job_end) continue;
    executor_.stop(worker.handle);
    worker.kill_at = Clock::now() + options_.grace;
  }
}

void Supervisor::kill_all() {
  for (const auto& [id, worker] : workers_) {
    if (!worker.job_end) executor_.kill(worker.handle);
  }
}

void Supervisor::complain(const std::string& trouble) {
  if (complaints_.insert(trouble).second) spdlog::warn("{}", trouble);
}

}  // namespace shaken::server
