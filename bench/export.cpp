// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>

#include "bench/commands.h"
#include "bench/options.h"
#include "bench/picture.h"
#include "bench/steady_state.h"

namespace shaken::bench {
namespace {

constexpr const char* kFooter =
    R"(Units: mm, s, mg, rad. Everything that another program needs to go on from the very same state.

Examples:
  shaken bench export --area-fraction 0.75 > state.json
  shaken bench export --area-fraction 0.75 --frames 50 --every 0.0011 --out state.json)";

using Json = nlohmann::ordered_json;

struct Words {
  std::string length = "4.5", fraction = "0.75", side = "41.865", warm_up = "5", frames = "0", every = "0.001";
  std::string cache, out;
};

Json as_json(const std::vector<Vec3>& vectors) {
  Json array = Json::array();
  for (const Vec3& v : vectors) array.push_back({v.x(), v.y(), v.z()});
  return array;
}

Json contact_json(const ContactParameters& contact) {
  return {{"friction", contact.friction}, {"restitution", contact.restitution}};
}

Json system_json(const Case& of, const Species& species) {
  const Scene& system = of.system();
  return {{"n_rods", system.n_rods},
          {"area_fraction", of.area_fraction},
          {"side", system.box_side},
          {"gap", system.gap},
          {"amplitude", system.amplitude},
          {"frequency", system.frequency},
          {"gravity", system.gravity},
          {"dt", of.dt},
          {"rod",
           {{"length", system.rod.length},
            {"area", species.area},
            {"bead_offset", species.bead_offset},
            {"bead_radius", species.bead_radius},
            {"mass", species.mass},
            {"inertia_perp", species.inertia_perp},
            {"inertia_par", species.inertia_par}}},
          {"rod_rod", contact_json(system.rod_rod)},
          {"rod_base", contact_json(system.rod_base)},
          {"rod_lid", contact_json(system.rod_lid)}};
}

Json frame_json(const Simulation& simulation) {
  const Snapshot now = simulation.snapshot();
  return {{"time", now.time},
          {"base", simulation.world().plates.at(now.tick).base},
          {"position", as_json(now.position)},
          {"director", as_json(now.director)},
          {"velocity", as_json(now.velocity)},
          {"angular_velocity", as_json(now.angular_velocity)}};
}

ExitCode run(const Words& words) {
  OptionReader options;
  const auto value = [&](const char* option, const std::string& word, const char* field) {
    const auto& [low, high] = limits_of(field);
    return options.number(option, word, low, high);
  };
  const double length = value("--length", words.length, "rods.length");
  const double fraction = value("--area-fraction", words.fraction, "rods.area_fraction");
  const double side = value("--side", words.side, "box.side");
  const double warm_up = options.number("--warm-up", words.warm_up, 1e-3, 1e4);
  const int frames = options.whole("--frames", words.frames, 0, 100'000);
  const double every = options.number("--every", words.every, 1e-6, 1e4);
  options.finish();
  const auto wanted = make_case(length, fraction, side, Scene{}.dt, warm_up, options);
  options.finish();

  const std::filesystem::path cache = words.cache.empty() ? default_cache() : std::filesystem::path(words.cache);
  Simulation simulation = resumed(*wanted, steady_state(*wanted, cache), Engine::kScheduled);
  Json json = system_json(*wanted, simulation.world().species[0]);
  json["start"] = frame_json(simulation);
  const Tick stride = std::max<Tick>(1, std::llround(every / wanted->dt));
  for (int k = 0; k < frames; ++k) {
    advance(simulation, stride);
    json["frames"].push_back(frame_json(simulation));
  }
  if (words.out.empty()) {
    fmt::print("{}\n", json.dump());
  } else {
    write_text(words.out, json.dump() + "\n");
  }
  return ExitCode::kOk;
}

}  // namespace

void add_export(CLI::App& app, Work& work) {
  const auto words = std::make_shared<Words>();
  CLI::App* app_export = app.add_subcommand("export", "A steady state as JSON, for other programs to start from");
  app_export->footer(kFooter);
  const auto option = [&](const char* name, std::string& word, const char* type, const char* help) {
    app_export->add_option(name, word, help)->type_name(type)->capture_default_str();
  };
  option("--length", words->length, "MM", "Rod length");
  option("--area-fraction", words->fraction, "PHI", "Area fraction");
  option("--side", words->side, "MM", "Side of the box");
  option("--warm-up", words->warm_up, "S", "Simulated seconds before the state");
  option("--frames", words->frames, "N", "States that follow");
  option("--every", words->every, "S", "Time between them");
  option("--cache", words->cache, "DIR", "Where steady states are kept; $XDG_CACHE_HOME/shaken/bench");
  option("-o,--out", words->out, "FILE", "Write there instead of stdout");
  app_export->callback([words, &work] { work = [words] { return run(*words); }; });
}

}  // namespace shaken::bench
