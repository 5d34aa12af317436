// SPDX-License-Identifier: MIT
#include "bench/case.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "scene/fields.h"
#include "scene/load.h"

namespace shaken::bench {

Tick Case::warm_up_ticks() const { return std::llround(warm_up / dt); }

Tick Case::period_ticks() const { return std::llround(1 / (system().frequency * dt)); }

double Case::rod_seconds(Tick ticks) const { return system().n_rods * static_cast<double>(ticks) * dt; }

std::string Case::label() const {
  return fmt::format("l = {:.10g} mm, phi = {:.10g}, L = {:.10g} mm", length, area_fraction, side);
}

std::pair<double, double> limits_of(std::string_view field) {
  return {scene::field_at(field).low, scene::field_at(field).high};
}

std::optional<Case> make_case(double length, double area_fraction, double side, double dt, double warm_up,
                              OptionReader& options) {
  Case made{length, area_fraction, side, dt, warm_up, {}};
  const nlohmann::json scene{{"rods", {{"length", length}, {"area_fraction", area_fraction}}},
                             {"box", {{"side", side}}},
                             {"time", {{"step", dt}, {"steady", 0}, {"measure", warm_up}}},
                             {"measure", {{"order", nullptr}}}};
  const auto loaded = scene::load_scene(scene.dump(), "scene");
  for (const scene::Problem& problem : loaded.problems) {
    options.complain(fmt::format("{}: {}: {}", made.label(), problem.path, problem.message));
  }
  if (!loaded.value) return std::nullopt;
  made.plan = *loaded.value;
  return made;
}

}  // namespace shaken::bench
