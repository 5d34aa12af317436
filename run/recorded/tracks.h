#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "base/core/types.h"
#include "scene/keys/keys.h"
#include "scene/keys/run_plan.h"
#include "sim/snapshot.h"

namespace shaken::run {

/// Rods that were seen again and again.
struct Tracks {
  std::vector<std::size_t> n_rods;  ///< of each species in a frame, on average
  std::size_t n_frames = 0;         ///< at least 1
  double interval = 0;              ///< from one to the next [s]
};

/// Ticks from one frame to the next, so that a tick is at most the step of `plan`.
Tick ticks_between(double interval, const scene::RunPlan& plan);

/// `plan` with the number of rods, the frames' times and their length: a tick is a whole part of the interval. `file`:
/// in problems.
keys::Loaded<scene::RunPlan> plan_of_tracks(const scene::RunPlan& plan, const std::string& file, const Tracks& tracks);

/// Boxes that a path goes on through, at most.
inline constexpr double kMostBoxes = 1e6;

/// Where a rod that is followed was last, and how often it had left the box.
struct LastSeen {
  Vec3 position = Vec3::Zero();         ///< in the box [mm]
  std::array<std::int32_t, 2> image{};  ///< box crossings (Snapshot::image)
  bool is_known = false;
};

/// Puts the rods of a frame into a box that repeats itself after `period` [mm], 0 for never, and counts how often each
/// has left it: so often as it was moved, or, where `last` has a place for each rod, so that one that was seen before
/// has moved by less than half a box since. They are within kMostBoxes. `last` is brought up to date.
void fold_into_box(Snapshot& frame, const Vec2& period, std::span<LastSeen> last);

/// Sets the velocities of rods that are the same in all frames, two or more that are `interval` [s] apart: from the
/// frame before to the one after, and at both ends from or to the next.
void set_velocities(std::span<Snapshot> frames, double interval);
/// What is to be said of that.
std::string remark_on_velocities(std::size_t n_frames, double interval);

/// Whether rods of one species point to all sides, as far as seen. Trackers that know no heads give angles of one half
/// turn; of one that gives either end at random that cannot be told.
class HeadsSeen {
 public:
  void see(const Vec3& director) {
    least_ = least_.cwiseMin(director.head<2>());
    most_ = most_.cwiseMax(director.head<2>());
  }
  bool are_told() const { return least_.maxCoeff() < -kRounding && most_.minCoeff() > kRounding; }

 private:
  static constexpr double kRounding = 1e-9;
  // of -90 to 90 degrees all x are positive, of 0 to 180 all y, or, turned over with an image, none
  Vec2 least_ = Vec2::Zero(), most_ = Vec2::Zero();
};

}  // namespace shaken::run
