#pragma once

#include <memory>
#include <optional>
#include <shaken/frame_static_t.hpp>
#include <shaken/posts_t.hpp>
#include <shaken/sizes_t.hpp>
#include <string>

#include "run/live/messages.h"

namespace shaken::run {

/// Sends the live state of one run over LCM from a thread of its own, so that neither a slow network nor a missing one
/// costs the run anything: of each kind only the newest message waits, older ones are dropped before they get a number.
/// If LCM cannot start, that is one warning in the log. What does not change is sent at the start and every 2 s.
class FramePublisher {
 public:
  /// What does not change during a run.
  struct Constants {
    frame_static_t cell;
    std::optional<posts_t> posts{};
    std::optional<sizes_t> sizes{};
  };
  FramePublisher(const std::string& lcm_url, const std::string& job_id, const Constants& constants);
  /// Sends what waits; gives up after a second.
  ~FramePublisher();
  FramePublisher(const FramePublisher&) = delete;
  FramePublisher& operator=(const FramePublisher&) = delete;

  void offer(proto::Frame frame);
  void offer(observables_t message);
  void offer(defects_t message);

  /// Frames sent so far.
  std::int64_t n_frames() const;

 private:
  struct Shared;
  std::shared_ptr<Shared> shared_;
};

}  // namespace shaken::run
