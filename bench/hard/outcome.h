// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

namespace shaken::bench {

inline constexpr double kLookEvery = 2e-3;  ///< between two looks at the state of a scene [s]

/// What energy differs by from rounding alone, as a fraction.
inline constexpr double kRounding = 1e-11;
/// What a rod at rest on the base is given, half the fall of a tick upwards, is of this order of its energy.
inline constexpr double kRest = 1e-5;

/// One thing that must hold in a hard case, and how nearly it did not.
struct Outcome {
  std::string holds;      ///< in words
  double worst = 0;       ///< value seen
  double limit = 0;       ///< largest value allowed, or the smallest if `at_least`
  bool at_least = false;  ///< what must hold is worst >= limit
  std::string note = {};  ///< what happened instead, or why the limit is what it is

  bool ok() const { return at_least ? worst >= limit : worst <= limit; }
  /// How often the worst value fits into the limit; below 1 it does not hold. Infinite where nothing was seen.
  double margin() const { return at_least ? worst / limit : limit / worst; }
};

struct HardCase {
  std::string name;
  std::string what;  ///< one line: what is hard
  std::vector<Outcome> outcomes;

  bool ok() const {
    return std::all_of(outcomes.begin(), outcomes.end(), [](const Outcome& outcome) { return outcome.ok(); });
  }
};

}  // namespace shaken::bench
