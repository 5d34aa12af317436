#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <mutex>
#include <optional>
#include <set>
#include <stop_token>
#include <string>
#include <thread>

#include "web/daemon_link.h"

namespace shaken::web {

/// The queue as it is now, asked for in a thread of its own: once a second while pages look at it, however many these
/// are, and once a minute while none does, so that S(t) is kept of runs that begin meanwhile (with another `every`, as
/// much faster or slower).
class QueueFeed {
 public:
  /// `running` is told the ids of the jobs that run, after every answer.
  QueueFeed(const DaemonLink& daemon, std::function<void(const std::set<std::string>&)> running,
            std::chrono::milliseconds every = std::chrono::seconds(1));
  ~QueueFeed();

  /// {"status", "sweeps", "jobs": those that run} as the daemon has them (docs/protocol.md), or {"error"}. Waits for at
  /// most `timeout` for something else than version `seen`, and notes in `seen` which it is.
  std::optional<std::string> wait(std::int64_t& seen, std::chrono::milliseconds timeout);

 private:
  using Clock = std::chrono::steady_clock;
  void poll(const std::stop_token& stop);
  std::string asked();

  const DaemonLink& daemon_;
  std::function<void(const std::set<std::string>&)> running_;
  std::chrono::milliseconds every_;
  std::mutex mutex_;
  std::condition_variable_any news_;
  std::string newest_;
  std::int64_t version_ = 0;
  Clock::time_point looked_at_{};  ///< when somebody waited last
  bool is_stale_ = true;           ///< nobody has looked for long: `newest_` is no news
  std::jthread thread_;            ///< the last: it uses the others
};

}  // namespace shaken::web
