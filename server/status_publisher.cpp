#include "server/status_publisher.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <chrono>
#include <shaken/job_t.hpp>
#include <shaken/status_t.hpp>

#include "base/clock.h"
#include "run/files/directory.h"
#include "run/files/progress.h"
#include "server/answers.h"

namespace shaken::server {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds kReaction{200};  ///< longest wait before a request to stop is seen

/// Changes sent in one go: a submit of thousands of points must not overrun the receivers' buffers.
constexpr int kBurst = 100;
constexpr milliseconds kPause{10};
/// For what has changed by the end of the daemon.
constexpr milliseconds kLastMessages{2000};

}  // namespace

StatusPublisher::StatusPublisher(const Queue& queue, std::unique_ptr<proto::Bus> bus, DaemonInfo info,
                                 milliseconds period)
    : queue_(queue),
      bus_(std::move(bus)),
      info_(std::move(info)),
      period_(period),
      last_change_(queue.last_change()),
      thread_([this](const std::stop_token& stop) { run(stop); }) {}

StatusPublisher::~StatusPublisher() {
  give_up_at_ = Clock::now() + kLastMessages;
  thread_.request_stop();
}

void StatusPublisher::run(const std::stop_token& stop) {
  auto next_tick = Clock::now();
  bool running_is_due = false;
  do {
    try {
      publish_changes();
      if (Clock::now() >= next_tick) {
        publish_status();
        running_is_due = true;
        next_tick += period_;
      }
      if (running_is_due && publish_running()) running_is_due = false;
    } catch (const std::exception& problem) {  // the queue, memory, a thread; no result depends on live state
      spdlog::error("publisher: {}", problem.what());
      next_tick = Clock::now() + period_;
      std::this_thread::sleep_for(kReaction);
    }
    queue_.wait_for_change(last_change_, std::min(kReaction, period_));
  } while (!stop.stop_requested());
  try {
    while (publish_changes() && !is_over()) continue;  // of the jobs that were stopped with the daemon
  } catch (const std::exception& problem) {
    spdlog::error("publisher: {}", problem.what());
  }
}

void StatusPublisher::publish_status() {
  const JobCounts counts = queue_.counts();
  const auto n = [](std::int64_t count) { return static_cast<std::int32_t>(count); };
  shaken::status_t status;
  status.utime = utime_now();
  status.sequence = status_sequence_++;
  status.host = info_.host;
  status.pid = info_.pid;
  status.version = info_.version;
  status.root = info_.root.string();
  status.uptime_s = info_.uptime();
  status.n_slots = info_.slots;
  status.n_queued = n(counts[JobState::kQueued]);
  status.n_running = n(counts.of(has_worker));
  status.n_done = n(counts[JobState::kDone]);
  status.n_failed = n(counts.of(has_failed));
  status.n_cancelled = n(counts[JobState::kCancelled]);
  bus_->publish(proto::kStatusChannel, status);
}

bool StatusPublisher::publish_running() {
  const std::vector<Job> jobs = queue_.active();
  // Something has changed since the changes were sent, and may have changed these: first that, then what runs.
  if (queue_.last_change() != last_change_) return false;
  for (const Job& job : jobs) {
    if (is_over()) break;
    publish_job(job, std::string(to_word(job.state)));
  }
  return true;
}

bool StatusPublisher::publish_changes() {
  const auto changes = queue_.changes_since(last_change_, kBurst);
  for (const Change& change : changes) {
    if (is_over()) return false;
    if (const auto job = queue_.job(change.job)) publish_job(*job, change.to);
    last_change_ = change.sequence;
  }
  if (changes.size() < kBurst) return false;
  std::this_thread::sleep_for(kPause);
  return true;
}

void StatusPublisher::publish_job(const Job& job, const std::string& state) {
  shaken::job_t message{};
  message.utime = utime_now();
  message.sequence = job_sequence_++;
  message.job_id = job.id;
  message.sweep_id = sweep_word(job.sweep);
  message.state = state;
  message.reason = reason_of(job, info_.runs());
  message.label = job.label;
  message.attempt = job.attempt;
  message.eta_s = -1;
  const auto progress = run::read_progress(run::RunDirectory{info_.runs() / job.id}.progress());
  if (progress) {
    message.progress = progress->fraction();
    message.sim_time_s = progress->sim_time;
    message.sim_time_total_s = progress->sim_time_total;
    message.sim_rate = progress->sim_rate;
    message.eta_s = progress->eta;
  }
  if (state == to_word(JobState::kDone)) message.progress = 1;
  bus_->publish(proto::kJobChannel, message);
}

}  // namespace shaken::server
