// SPDX-License-Identifier: MIT
#include "bench/case_words.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>

namespace shaken::bench {

void CaseWords::declare(CLI::App& app) {
  app.add_option("--length", length, "Rod length [mm]; 4.5")->type_name("MM");
  app.add_option("--area-fraction", area_fraction, "Area fraction; 0.75")->type_name("PHI");
  app.add_option("--side", side, fmt::format("Side of the box [mm]; {}", default_side))->type_name("MM");
  app.add_option("--warm-up", warm_up, "Simulated seconds before anything is timed; 0.5")->type_name("S");
}

std::optional<Case> CaseWords::read(OptionReader& options) const {
  const auto number = [&](const char* option, const std::string& text, double low, double high, double otherwise) {
    return text.empty() ? otherwise : options.number(option, text, low, high);
  };
  const auto quantity = [&](const char* option, const std::string& text, const char* field, double otherwise) {
    const auto& [low, high] = limits_of(field);
    return number(option, text, low, high, otherwise);
  };
  const double l = quantity("--length", length, "rods.length", 4.5);
  const double phi = quantity("--area-fraction", area_fraction, "rods.area_fraction", 0.75);
  const double box = quantity("--side", side, "box.side", default_side);
  const double seconds = number("--warm-up", warm_up, 1e-3, 1e4, 0.5);
  return make_case(l, phi, box, 4e-6, seconds, options);
}

}  // namespace shaken::bench
