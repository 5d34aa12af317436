// SPDX-License-Identifier: MIT
#include "run/effects.h"

namespace shaken::run {

std::map<std::string, EffectReport> report_effects(const scene::RunPlan& plan, const Session& session,
                                                   std::optional<std::int64_t> n_live_frames) {
  const Scene& system = plan.system;
  const Counters& counters = session.simulation.world().counters;
  std::map<std::string, EffectReport> effects;

  effects["gravity"] = {system.gravity > 0, {{"g_mm_s2", system.gravity}}};
  effects["vibration"] = {system.amplitude > 0 && system.frequency > 0,
                          {{"periods", session.simulation.time() * system.frequency}}};
  effects["taper"] = {system.rod.end_diameter != system.rod.mid_diameter, {}};
  const auto contact = [&](const std::string& pair, const ContactParameters& parameters, std::int64_t impulses) {
    const auto n = static_cast<double>(impulses);
    effects[pair + "_collisions"] = {true, {{"impulses", n}}};
    effects[pair + "_friction"] = {parameters.friction > 0, {{"impulses", parameters.friction > 0 ? n : 0}}};
    effects[pair + "_restitution"] = {parameters.restitution > 0, {{"impulses", parameters.restitution > 0 ? n : 0}}};
  };
  contact("rod_rod", system.rod_rod, counters.impulses_rod_rod);
  contact("rod_base", system.rod_base, counters.impulses_rod_base);
  contact("rod_lid", system.rod_lid, counters.impulses_rod_lid);

  for (const char* name : {"order", "angles", "tilt", "defects", "g2", "msd"})
    effects["measure_" + std::string(name)] = {};
  for (const auto& [name, samples] : session.measurements.counts()) {
    effects["measure_" + name] = {true, {{"samples", static_cast<double>(samples)}}};
  }
  const double frames = session.trajectory ? static_cast<double>(session.trajectory->n_frames()) : 0.0;
  effects["trajectory"] = {session.trajectory.has_value(), {{"frames", frames}}};
  effects["stream"] = {n_live_frames.has_value(), {{"frames", static_cast<double>(n_live_frames.value_or(0))}}};
  effects["movie"] = {plan.movie.has_value(), {}};
  return effects;
}

}  // namespace shaken::run
