#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "base/core/box.h"
#include "base/core/types.h"

namespace shaken {

/// Every rod at one tick, as plain arrays of shape (n_rods): what observables, files, the bus and pictures read.
struct Snapshot {
  Tick tick = 0;
  double time = 0;                                 ///< tick * dt [s]
  Box box;                                         ///< sides [mm]
  std::vector<Vec3> position;                      ///< centre; x and y in the box, z above the base's rest [mm]
  std::vector<std::array<std::int32_t, 2>> image;  ///< box crossings: unwrapped x = position.x + image[0] * box.x
  std::vector<Vec3> director;                      ///< unit vector along the rod; its sign is a label that stays
  std::vector<Vec3> velocity;                      ///< of the centre [mm/s]
  std::vector<Vec3> angular_velocity;              ///< [rad/s]
  /// Of rods that were tracked, and may be missed: which of n_tracks each one is, rising. Of a run, empty and 0.
  std::vector<std::uint32_t> track{};
  std::size_t n_tracks = 0;

  std::size_t n_rods() const { return position.size(); }
  /// The centre of rod `i` without the jumps at the borders of the box [mm].
  Vec3 unwrapped(std::size_t i) const { return position[i] + Vec3(image[i][0] * box.x(), image[i][1] * box.y(), 0); }
  /// The number under which rod `i` is followed from frame to frame.
  std::size_t track_of(std::size_t i) const { return n_tracks > 0 ? track[i] : i; }
  /// The rod that is followed under that number; none if it is missed here.
  std::optional<std::size_t> rod_of(std::size_t number) const {
    if (n_tracks == 0) return number < n_rods() ? std::optional(number) : std::nullopt;
    const auto place = std::ranges::lower_bound(track, number);
    if (place == track.end() || *place != number) return std::nullopt;
    return static_cast<std::size_t>(place - track.begin());
  }
  /// `values` (n_rods) by the number of their track (n_tracks), NaN of rods that are missed.
  std::vector<Vec3> by_track(std::vector<Vec3> values) const {
    if (n_tracks == 0) return values;
    std::vector<Vec3> all(n_tracks, Vec3::Constant(std::numeric_limits<double>::quiet_NaN()));
    for (std::size_t i = 0; i < track.size(); ++i) all[track[i]] = values[i];
    return all;
  }
};

}  // namespace shaken
