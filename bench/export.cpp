#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/files.h"
#include "bench/bench.h"
#include "bench/case.h"
#include "bench/report.h"

namespace shaken::bench {
namespace {

constexpr const char* kExportFooter =
    R"(Units: mm, s, mg, rad. Everything that another program needs to go on from the very same state.

Examples:
  shaken bench export --area-fraction 0.75 > state.json
  shaken bench export --area-fraction 0.75 --frames 50 --every 0.0011 --out state.json)";

Json vectors_json(const std::vector<Vec3>& vectors) {
  Json array = Json::array();
  for (const Vec3& v : vectors) array.push_back({v.x(), v.y(), v.z()});
  return array;
}

Json contact_json(const ContactParameters& contact) {
  return {{"friction", contact.friction}, {"restitution", contact.restitution}};
}

Json system_json(const Case& of, const Species& species) {
  const System& system = of.system();
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
          {"position", vectors_json(now.position)},
          {"director", vectors_json(now.director)},
          {"velocity", vectors_json(now.velocity)},
          {"angular_velocity", vectors_json(now.angular_velocity)}};
}

struct ExportBench {
  CaseOptions scene{.side = 41.865, .warm_up = 5};
  int frames = 0;
  double every = 0.001;
  Cache cache;
  std::string out;

  void declare(CLI::App& app) {
    scene.declare(app);
    add_number(app, "--frames", frames, "N", {0, 100'000}, "States that follow");
    add_number(app, "--every", every, "S", {1e-6, 1e4}, "Time between them");
    cache.declare(app);
    add_path(app, "-o,--out", out, "FILE", "Write there instead of stdout");
  }

  ExitCode run() const {
    const Case wanted = scene.read();
    Simulation simulation = resumed(wanted, cache(wanted), StepperKind::kScheduled);
    Json json = system_json(wanted, simulation.world().species[0]);
    json["start"] = frame_json(simulation);
    const Tick stride = std::max<Tick>(1, std::llround(every / wanted.dt));
    for (int k = 0; k < frames; ++k) {
      advance(simulation, stride);
      json["frames"].push_back(frame_json(simulation));
    }
    if (out.empty()) {
      fmt::print("{}\n", json.dump());
    } else {
      done_or_fail(write_file_atomically(out, json.dump() + "\n"));
    }
    return ExitCode::kOk;
  }
};

}  // namespace

void add_export(CLI::App& app, Work& work) {
  add_bench<ExportBench>(app, work, "export", "A steady state as JSON, for other programs to start from",
                         kExportFooter);
}

}  // namespace shaken::bench
