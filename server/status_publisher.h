#pragma once

#include <atomic>
#include <chrono>
#include <memory>
#include <thread>

#include "proto/bus.h"
#include "server/daemon_info.h"
#include "server/queue/queue.h"

namespace shaken::server {

/// Sends SHAKEN_STATUS once a period, and SHAKEN_JOB at every change of state and once a period for each job that
/// runs. Its thread is the only one that touches the bus; it reads the queue and the progress files, nothing else.
/// At its end it sends what has changed, but for some seconds at most: the other end may take nothing.
class StatusPublisher {
 public:
  StatusPublisher(const Queue& queue, std::unique_ptr<proto::Bus> bus, DaemonInfo info,
                  std::chrono::milliseconds period = std::chrono::seconds(1));
  ~StatusPublisher();

 private:
  using Clock = std::chrono::steady_clock;
  void run(const std::stop_token& stop);
  /// Whether the last messages have had their time.
  bool is_over() const { return Clock::now() >= give_up_at_.load(); }
  void publish_status();
  /// False if there are changes to be sent first.
  bool publish_running();
  /// False once all are sent that there are.
  bool publish_changes();
  void publish_job(const Job& job, const std::string& state);

  const Queue& queue_;
  std::unique_ptr<proto::Bus> bus_;
  DaemonInfo info_;
  std::chrono::milliseconds period_;
  std::int64_t status_sequence_ = 0;
  std::int64_t job_sequence_ = 0;
  std::int64_t last_change_;
  std::atomic<Clock::time_point> give_up_at_ = Clock::time_point::max();
  std::jthread thread_;
};

}  // namespace shaken::server
