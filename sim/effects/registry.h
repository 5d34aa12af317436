#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "sim/system.h"
#include "sim/world.h"

namespace shaken {

/// One thing that the physics does: whether a scene asks for it, and what it then did.
struct Effect {
  std::string_view name;  ///< in summary.json: "rod_rod_friction"
  std::string_view what;  ///< one line
  bool (*is_on)(const System& system);
  /// The keys of the scene that decide, those that matter most in front; * stands for any letters, as in
  /// "rods*.length_spread".
  std::string_view keys;
  /// Work done since tick 0, in `unit`s; 0 where the effect is off.
  std::int64_t (*work)(const World& world);
  std::string_view unit;  ///< "impulses"; also the key in summary.json
  /// Gives the scene the neutral value, with which the effect is off; nullptr where a scene cannot be without.
  void (*switch_off)(System& system);
};

/// Every effect, one line each in registry.cpp. Names are unique.
std::span<const Effect> all_effects();

}  // namespace shaken
