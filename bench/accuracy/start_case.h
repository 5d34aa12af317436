// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "sim/motion/flight.h"
#include "sim/simulation.h"
#include "sim/system.h"

namespace shaken::bench {

/// One way to treat impacts whose accuracy is measured.
struct Variant {
  const char* name;
  void (*apply)(System& scene);  ///< sets what the variant is about, and nothing else
};

/// All of them; the first is the default of a scene.
const std::vector<Variant>& variants();

/// A start whose future is followed for a time short enough not to be chaos. Its members differ a little, so that their
/// impacts fall anywhere within a tick.
struct StartCase {
  std::string name;
  std::string what;     ///< for people
  double duration = 0;  ///< a whole number of the longest step [s]
  int members = 0;      ///< of the ensemble, by default
  System scene;         ///< at any dt
  std::function<std::vector<Flight>(int member)> rods;
};

/// The longest step that divides every case's duration; the others are its halves [s].
inline constexpr double kLongestStep = 64e-6;

/// One rod, two rods, a dozen, a hundred.
const std::vector<StartCase>& start_cases();

/// The member at tick 0.
Simulation begin(const StartCase& start, const std::vector<Flight>& rods, const Variant& variant, Engine engine,
                 double dt);

}  // namespace shaken::bench
