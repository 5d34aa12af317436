#pragma once

#include <cstddef>

namespace shaken {

// How much measurements keep of a run however long it is (analysis/errors/), which their memory follows from
// (scene/keys/observables.cpp).
inline constexpr std::size_t kMostStretches = 64;         ///< of time, each with its own sums
inline constexpr std::size_t kMostSeriesPoints = 65'536;  ///< of a series against time

}  // namespace shaken
