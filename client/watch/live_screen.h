#pragma once

#include <chrono>
#include <memory>
#include <string>
#include <vector>

#include "base/terminal.h"
#include "client/live/live.h"
#include "client/live/live_rods.h"
#include "client/watch/keys.h"
#include "client/watch/screen.h"
#include "client/watch/screen_writer.h"
#include "client/watch/steering.h"
#include "client/watch/terminal_session.h"

namespace shaken::client {

/// How long to wait after a screen that took so many bytes: a tenth of a second, or longer, so that there are no more
/// than 1.5 MB per second, or 150 kB where the terminal is on another machine.
std::chrono::milliseconds pause_after(std::size_t bytes, bool is_remote);

/// What is known of a terminal.
struct ScreenSettings {
  ColourDepth depth = ColourDepth::kTrue;
  bool is_remote = false;
};

/// The terminal of `shaken watch`: rods, numbers and keys, from its making to its end.
class LiveScreen {
 public:
  explicit LiveScreen(const ScreenSettings& settings) : settings_(settings), writer_(settings.depth) {}

  /// Frames from the bus go here.
  LiveRods& rods() { return rods_; }
  /// Draws what has changed. Returns when to draw again.
  std::chrono::milliseconds draw(const LiveJobs& jobs, const std::string& title, const std::string& note,
                                 TerminalSize size);
  /// Until there is a key, another size, a message on `bus_descriptor` (-1: none), or the time is over. Returns whether
  /// to draw at once.
  bool wait(int bus_descriptor, std::chrono::milliseconds time, const LiveJobs& jobs);
  /// By a key, or because the terminal is gone.
  bool has_ended() const { return steering_.quit || session_.is_gone(); }

 private:
  using Clock = std::chrono::steady_clock;

  void obey(const std::vector<Key>& keys, const LiveJobs& jobs);

  ScreenSettings settings_;
  Clock::time_point typed_at_{};
  ScreenWriter writer_;
  LiveRods rods_;
  KeyReader keys_;
  Steering steering_;
  std::shared_ptr<const RodFrame> shown_;
  std::vector<DefectMark> defects_;
  TerminalSession session_;  ///< last, so that it goes first
};

}  // namespace shaken::client
