#pragma once

#include <cstdint>

namespace shaken::proto {

/// How many messages of one sender are lost between two that came, by their numbers, which count from 0. None where the
/// count goes back, as when a run is started again, or where it leaps farther than any loss (days at the highest rate):
/// such a number comes from somebody else.
inline std::int64_t n_lost_between(std::int64_t last, std::int64_t next) {
  constexpr std::int64_t kLongestLoss = 10'000'000;
  if (last < 0 || next <= last || next - last > kLongestLoss) return 0;
  return next - last - 1;
}

}  // namespace shaken::proto
