#pragma once

#include <memory>
#include <optional>
#include <shaken/frame_static_t.hpp>
#include <shaken/frame_t.hpp>
#include <shaken/posts_t.hpp>
#include <shaken/sizes_t.hpp>
#include <string>
#include <vector>

#include "base/core/result.h"
#include "client/live/rod_frame.h"
#include "proto/frame_codec.h"

namespace shaken::client {

/// The part of a picture that does not change: `time`, `order`, `director` and `rods` are left open. Fails where no
/// scene has such a cell, or it has no room for so many rods: anybody can send them.
Result<RodFrame> constants_of(const Cell& cell, std::size_t n_rods);

/// The rods of one run at a time, from the bus.
class LiveRods {
 public:
  /// From now on the rods of this job are wanted; those of another one are forgotten.
  void select(const std::string& job);
  const std::string& job() const { return job_; }
  /// Messages about other jobs than the selected one are ignored; so are frames that do not fit to the last constants.
  void note(const frame_static_t& message);
  void note(const posts_t& message);
  void note(const sizes_t& message);
  void note(const frame_t& message);

  /// The newest whole frame; null if none has come.
  std::shared_ptr<const RodFrame> newest() const { return newest_; }
  std::int64_t received() const { return received_; }
  std::int64_t lost() const { return assembler_.lost(); }

 private:
  /// False, and nothing changes, where no scene has such a cell.
  bool change(const Cell& cell, std::size_t n_rods);

  std::string job_;
  std::optional<RodFrame> constants_;
  std::size_t n_rods_ = 0;
  StandingPosts posts_;                         ///< the last that have come
  std::vector<std::uint8_t> species_of_shape_;  ///< likewise
  proto::FrameAssembler assembler_{""};
  std::shared_ptr<const RodFrame> newest_;
  std::int64_t received_ = 0;
};

}  // namespace shaken::client
