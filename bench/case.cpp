#include "bench/case.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <string_view>

#include "base/failure.h"
#include "base/files.h"
#include "base/progress_line.h"
#include "bench/bench.h"
#include "run/files/checkpoint_file.h"
#include "scene/canonical.h"
#include "scene/keys/derived.h"
#include "scene/keys/fields.h"
#include "scene/load.h"

namespace shaken::bench {
namespace {

/// The state kept in `directory`, if it is whole and of this case.
std::optional<std::vector<std::byte>> read_cached(const Case& wanted, const std::string& key,
                                                  const run::RunDirectory& directory) {
  Result<run::Checkpoint> kept = run::read_checkpoint(directory.checkpoint(), key);
  if (!kept) return std::nullopt;
  const Result<Simulation> simulation = Simulation::resume(wanted.system(), kept->simulation);
  if (!simulation || simulation->tick() != wanted.warm_up_ticks()) return std::nullopt;
  return std::move(kept->simulation);
}

Simulation simulate(const Case& wanted) {
  Result<Simulation> started = Simulation::start(wanted.system());
  if (!started) throw Failure(ExitCode::kBadInput, wanted.label + ": " + started.error().message);
  Simulation simulation = std::move(started).value();
  ProgressLine progress(
      fmt::format("steady state of {} (N = {}), {:.10g} s of it", wanted.label, wanted.n_rods(), wanted.warm_up));
  const Tick end = wanted.warm_up_ticks();
  // short enough for progress to be shown, long enough to cost nothing
  const Tick stride = std::max<Tick>(1, 200'000 / wanted.n_rods());
  while (simulation.tick() < end) {
    advance(simulation, std::min(stride, end - simulation.tick()));
    progress.show(static_cast<double>(simulation.tick()) / static_cast<double>(end));
  }
  return simulation;
}

/// The case of the text of a scene with further settings.
Case loaded_case(std::string_view text, double warm_up, const std::string& label, std::vector<std::string> settings) {
  settings.insert(settings.end(), {"time.steady=0", fmt::format("time.measure={:.17g}", warm_up)});
  const auto loaded = scene::load_scene(text, label, settings);
  if (!loaded) {
    std::string problems;
    for (const keys::Problem& problem : loaded.error()) {
      problems += fmt::format("{}{}: {}: {}", problems.empty() ? "" : "\n  ", label, problem.path, problem.message);
    }
    throw Failure(ExitCode::kBadInput, problems);
  }
  if (loaded->start) throw Failure(ExitCode::kBadInput, label + ": start: benches place the rods, remove it");
  const System& system = loaded->system;
  return {label, system.rod.length, scene::area_fraction_of(system), system.box_side, system.dt, warm_up, *loaded};
}

}  // namespace

Tick Case::warm_up_ticks() const { return std::llround(warm_up / dt); }

Tick Case::period_ticks() const { return std::llround(1 / (system().frequency * dt)); }

double Case::rod_seconds(Tick ticks) const { return n_rods() * static_cast<double>(ticks) * dt; }

std::string label_of(double length, double area_fraction, double side) {
  return fmt::format("l = {:.10g} mm, phi = {:.10g}, L = {:.10g} mm", length, area_fraction, side);
}

std::pair<double, double> limits_of(std::string_view field) {
  return {scene::field_at(field).low, scene::field_at(field).high};
}

Case case_of(nlohmann::json scene, double warm_up, const std::string& label) {
  scene["measure"] = {{"order", nullptr}};
  return loaded_case(scene.dump(), warm_up, label, {});
}

Case read_case(const std::filesystem::path& file, double warm_up) {
  const Result<std::string> text = read_file(file);
  if (!text) throw Failure(ExitCode::kBadInput, text.error().message);
  return loaded_case(*text, warm_up, file.string(),
                     {R"(measure={"order":null})", "trajectory=null", "movie=null", "until=null"});
}

Case make_case(double length, double area_fraction, double side, double dt, double warm_up) {
  Case made = case_of({{"rods", {{"length", length}, {"area_fraction", area_fraction}}},
                       {"box", {{"side", side}}},
                       {"time", {{"step", dt}}}},
                      warm_up, label_of(length, area_fraction, side));
  made.area_fraction = area_fraction;
  return made;
}

void CaseOptions::declare(CLI::App& app) {
  add_number(app, "--length", length, "MM", limits_of("rods.length"), "Rod length [mm]");
  add_number(app, "--area-fraction", area_fraction, "PHI", limits_of("rods.area_fraction"), "Area fraction");
  add_number(app, "--side", side, "MM", limits_of("box.side"), "Side of the box [mm]");
  add_number(app, "--warm-up", warm_up, "S", kWarmUps, "Simulated seconds before anything is measured");
}

void Cache::declare(CLI::App& app) {
  add_path(app, "--cache", folder, "DIR", "Where steady states are kept; $XDG_CACHE_HOME/shaken/bench");
}

std::filesystem::path default_cache() {
  if (const char* base = std::getenv("XDG_CACHE_HOME"); base != nullptr && *base != '\0') {
    return std::filesystem::path(base) / "shaken" / "bench";
  }
  const char* home = std::getenv("HOME");
  return std::filesystem::path(home != nullptr ? home : ".") / ".cache" / "shaken" / "bench";
}

SteadyState steady_state(const Case& wanted, const std::filesystem::path& cache) {
  const std::string key = scene::scene_hash(wanted.plan);
  const run::RunDirectory directory{cache / key};
  if (auto cached = read_cached(wanted, key, directory)) return {std::move(*cached), true};

  done_or_fail(make_folder(directory.root));
  SteadyState made{simulate(wanted).checkpoint(), false};
  done_or_fail(run::write_checkpoint(directory, key, {made.checkpoint, {}, 0, 0}));
  return made;
}

Simulation resumed(const Case& of, const SteadyState& state, StepperKind stepper) {
  System scene = of.system();
  scene.stepper = stepper;
  return value_or_fail(Simulation::resume(scene, state.checkpoint));
}

Flight thrown(const Vec3& position, const Vec3& director, const Vec3& velocity, const Vec3& turn) {
  Flight flight;
  flight.position = position;
  flight.director = director.normalized();
  flight.velocity = velocity;
  flight.precession = turn - turn.dot(flight.director) * flight.director;
  flight.prepare();
  return flight;
}

Simulation begin_with(System system, std::vector<Flight> rods) {
  system.n_rods = static_cast<int>(rods.size());
  World world = empty_world(system);
  world.rods = std::move(rods);
  return Simulation::start_from(std::move(world));
}

void advance(Simulation& simulation, Tick ticks) {
  if (const auto trouble = simulation.advance_to(simulation.tick() + ticks)) {
    throw Failure(ExitCode::kFailed, fmt::format("numerical trouble at tick {}: {}", trouble->tick, trouble->what));
  }
}

}  // namespace shaken::bench
