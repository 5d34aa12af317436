#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "scene/keys/fields.h"
#include "scene/keys/keys.h"

namespace shaken::scene {

/// No sweep has more points, and no key of one more values.
inline constexpr int kMaxPoints = 100000;

/// How many values the keys of a sweep may still have together, settings included. Ranges are asked for room before
/// they are counted up: a short text can name any number of values.
struct Room {
  int left = 10 * kMaxPoints;
};

/// The values that are written for one swept field: an array of values or ranges, a range, or a single value. Ranges
/// are "0.45:0.85:0.05" (from:to:step, the end included if a step falls on it; "2.5:4.5:0.5 mm" with a unit),
/// {"from", "to", "step"} and {"from", "to", "n", "scale"?} (n values, both ends included; evenly spaced, or with even
/// ratios where "scale" is "log"). Their values are exact decimals. None, and a problem, if there are too many.
std::vector<Node> read_values(const Field& field, const Node& node, Room& room, std::vector<Problem>& problems);

/// A whole number in [low, high], or none and a problem.
std::optional<int> read_count(std::string_view path, const Node& node, int low, int high,
                              std::vector<Problem>& problems);

/// from (to / from)^share, with the same bits on every machine; both ends positive, `share` in [0, 1].
double between_on_log_scale(double from, double to, double share);

}  // namespace shaken::scene
