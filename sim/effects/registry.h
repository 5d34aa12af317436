// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "sim/system.h"
#include "sim/world.h"

namespace shaken {

/// One thing that the physics does: whether a scene asks for it, and what it then did.
struct Effect {
  std::string_view name;  ///< in summary.json: "rod_rod_friction"
  std::string_view what;  ///< one line
  bool (*is_on)(const System& system);
  /// The key of the scene that decides, with its value: "contacts.rod_rod.friction = 0.05".
  std::string (*why)(const System& system);
  /// Work done since tick 0, in `unit`s; 0 where the effect is off.
  std::int64_t (*work)(const World& world);
  std::string_view unit;  ///< "impulses"; also the key in summary.json
  /// Gives the scene the neutral value, with which the effect is off; nullptr where a scene cannot be without.
  void (*switch_off)(System& system);
};

/// Every effect, one line each in registry.cpp. Names are unique.
std::span<const Effect> all_effects();

}  // namespace shaken
