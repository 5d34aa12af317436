#pragma once

#include <cstddef>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "scene/keys/run_plan.h"
#include "sim/simulation.h"

namespace CLI {
class App;
}  // namespace CLI

namespace shaken::bench {

/// A scene whose speed is measured, in its user's terms and resolved.
struct Case {
  std::string label;         ///< names it for people
  double length = 0;         ///< of the rods of the first species, tip to tip [mm]
  double area_fraction = 0;  ///< of these; if it was asked for, that of a whole number of rods differs a little
  double side = 0;           ///< of the box [mm]
  double dt = 0;             ///< [s]
  double warm_up = 0;        ///< simulated before anything is measured [s]
  scene::RunPlan plan;       ///< `plan.system` is the scene; the run lasts for `warm_up`

  const System& system() const { return plan.system; }
  int n_rods() const { return system().n_all_rods(); }  ///< of all species
  Tick warm_up_ticks() const;
  /// Ticks of one vibration, rounded.
  Tick period_ticks() const;
  /// Rod-seconds that `ticks` simulate.
  double rod_seconds(Tick ticks) const;
};

/// "l = 4.5 mm, phi = 0.75, L = 41.865 mm"
std::string label_of(double length, double area_fraction, double side);

inline constexpr double kPaperStep = 4e-6;                       ///< [s]
inline constexpr std::pair<double, double> kWarmUps{1e-3, 1e4};  ///< that may be asked for [s]

/// The values that a scene's field may have, in its default unit.
std::pair<double, double> limits_of(std::string_view field);

/// The case of a scene as a user would write it, but for what says how long it runs and what it measures: `warm_up`
/// says the one, and it measures nothing. Throws Failure with all that is wrong with the scene.
Case case_of(nlohmann::json scene, double warm_up, const std::string& label);
/// The case of a scene file, with its own time step. Throws Failure with all that is wrong with it.
Case read_case(const std::filesystem::path& file, double warm_up);
/// The case of rods in a periodic box; everything that is not named here is the scene file's default. Its label is
/// label_of.
Case make_case(double length, double area_fraction, double side, double dt, double warm_up);

/// A case after its warm-up.
struct SteadyState {
  std::vector<std::byte> checkpoint;
  bool was_cached = false;  ///< read from the cache, not simulated now
};

/// $XDG_CACHE_HOME/shaken/bench, or ~/.cache/shaken/bench.
std::filesystem::path default_cache();

/// The state of `wanted` after its warm-up: from `cache`, or simulated now and kept there as checkpoint.bin in a folder
/// named by the hash of all that it depends on. The file bears that hash and its own, so that a damaged one, or one of
/// another scene, is made anew.
SteadyState steady_state(const Case& wanted, const std::filesystem::path& cache);

/// A simulation that goes on from a steady state by either stepper.
Simulation resumed(const Case& of, const SteadyState& state, StepperKind stepper);

/// A rod in flight from tick 0 on, without spin about its axis; the director need not be of length 1, and of the
/// angular velocity `turn` only the part across the rod counts.
Flight thrown(const Vec3& position, const Vec3& director, const Vec3& velocity, const Vec3& turn = Vec3::Zero());
/// A simulation that begins with these rods, at tick 0.
Simulation begin_with(System system, std::vector<Flight> rods);

/// Steps on by `ticks`. Throws Failure on numerical trouble.
void advance(Simulation& simulation, Tick ticks);

/// Where a bench keeps steady states.
struct Cache {
  std::string folder = default_cache().string();
  void declare(CLI::App& app);
  SteadyState operator()(const Case& wanted) const { return steady_state(wanted, folder); }
};

/// The options of a bench that choose one case.
struct CaseOptions {
  double side;  ///< [mm]
  double warm_up = 0.5;
  double length = 4.5;
  double area_fraction = 0.75;

  void declare(CLI::App& app);
  Case read() const { return make_case(length, area_fraction, side, kPaperStep, warm_up); }
};

}  // namespace shaken::bench
