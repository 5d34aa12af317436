// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>

#include "bench/case.h"

namespace CLI {
class App;
}  // namespace CLI

namespace shaken::bench {

/// The options that choose a case, as the user wrote them; empty where nothing was said.
struct CaseWords {
  double default_side;          ///< [mm]
  std::string length{};         ///< --length; 4.5 mm
  std::string area_fraction{};  ///< --area-fraction; 0.75
  std::string side{};           ///< --side
  std::string warm_up{};        ///< --warm-up; 0.5 s

  /// Adds the four options to `app`. This must outlive it.
  void declare(CLI::App& app);
  /// The case at a tick of 4 us; none if anything is wrong, which `options` then knows.
  std::optional<Case> read(OptionReader& options) const;
};

}  // namespace shaken::bench
