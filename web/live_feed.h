#pragma once

#include <chrono>
#include <condition_variable>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <shaken/defects_t.hpp>
#include <shaken/observables_t.hpp>
#include <stop_token>
#include <string>
#include <thread>

#include "client/live/live.h"
#include "client/live/live_rods.h"
#include "proto/bus.h"

namespace shaken::web {

/// What the bus has told of one run since somebody asked before.
struct LiveNews {
  std::shared_ptr<const client::RodFrame> frame;  ///< null: none that is new
  std::optional<observables_t> observables;
  std::optional<defects_t> defects;
};

/// Which of a run's messages a listener has had.
struct LiveSeen {
  std::int64_t frames = 0, observables = 0, defects = 0;
};

/// Listens on the bus in a thread of its own. Of the runs that the daemon runs it keeps S(t) from when they were heard
/// first; rods only of those that somebody looks at. May be asked from many threads at once.
class LiveFeed {
 public:
  /// Without a bus it hears only what is handed to note().
  explicit LiveFeed(std::unique_ptr<proto::Bus> bus);
  ~LiveFeed();

  /// Runs to be listened to; others are forgotten.
  void keep(const std::set<std::string>& runs);
  /// Waits for at most `timeout` for something that is not in `seen`, and notes in `seen` what it returns.
  LiveNews wait(const std::string& run, LiveSeen& seen, std::chrono::milliseconds timeout);
  /// The next frame of a run, if it comes within `timeout`; null if not.
  std::shared_ptr<const client::RodFrame> next_frame(const std::string& run, std::chrono::milliseconds timeout);
  /// S(t) as far as it is known: times [s] and values.
  client::History order(const std::string& run) const;
  /// One message of the bus. That of a run which is not kept is ignored: anybody can send them.
  template <class Message>
  void note(const Message& message) {
    const std::lock_guard lock(mutex_);
    const auto place = runs_.find(message.job_id);
    if (place == runs_.end()) return;
    take(place->second, message);
    news_.notify_all();
  }

 private:
  using Clock = std::chrono::steady_clock;
  struct Run {
    LiveSeen count;
    client::History order;
    std::optional<observables_t> observables;
    std::optional<defects_t> defects;
    client::LiveRods rods;
    Clock::time_point looked_at{};  ///< when somebody asked for its rods last
  };
  void listen(const std::stop_token& stop);
  static void take(Run& run, const observables_t& message);
  static void take(Run& run, const defects_t& message);
  static void take(Run& run, const frame_t& message);
  static void take(Run& run, const auto& constants) { run.rods.note(constants); }

  std::unique_ptr<proto::Bus> bus_;
  mutable std::mutex mutex_;
  std::condition_variable news_;
  std::map<std::string, Run> runs_;
  std::jthread thread_;  ///< the last: it uses the others
};

}  // namespace shaken::web
