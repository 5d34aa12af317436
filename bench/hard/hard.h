#pragma once

#include <algorithm>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "scene/keys/run_plan.h"
#include "sim/world.h"

namespace shaken::bench {

inline constexpr double kSampleEvery = 2e-3;  ///< between two samples of the state of a scene [s]

/// What energy differs by from rounding alone, as a fraction.
inline constexpr double kRounding = 1e-11;
/// What a rod at rest on the base is given, half the fall of a tick upwards, is of this order of its energy.
inline constexpr double kRest = 1e-5;

/// One thing that must hold in a hard case, and how nearly it did not.
struct Outcome {
  std::string holds;      ///< in words
  double worst = 0;       ///< value seen
  double limit = 0;       ///< largest value allowed, or the smallest if `at_least`
  bool at_least = false;  ///< what must hold is worst >= limit
  std::string note = {};  ///< what happened instead, or why the limit is what it is

  bool ok() const { return at_least ? worst >= limit : worst <= limit; }
  /// How often the worst value fits into the limit; below 1 it does not hold. Infinite where nothing was found.
  double margin() const { return at_least ? worst / limit : limit / worst; }
};

struct HardCase {
  std::string name;
  std::string what;  ///< one line: what is hard
  std::vector<Outcome> outcomes;

  bool ok() const {
    return std::all_of(outcomes.begin(), outcomes.end(), [](const Outcome& outcome) { return outcome.ok(); });
  }
};

/// A hard case made by hand: a few rods placed exactly so that something degenerates, or a run that must not go on.
struct MadeCase {
  std::string name;
  std::string what;
  std::function<std::vector<Outcome>()> outcomes;
  /// The worlds that it begins with, either stepper of which must make the same; none where the rods do not fit.
  std::function<std::vector<World>()> starts;

  HardCase run() const { return {name, what, outcomes()}; }
};
const std::vector<MadeCase>& made_cases();

/// A hard case that is a point of a sweep file in DIR.
struct SceneCase {
  std::string name;
  std::string what;
  double max_overlap = 0.1;   ///< allowed, as a fraction of the thinnest bead's radius; 0.5 ends a run
  bool makes_energy = false;  ///< known to, although nothing shakes it: the law's fault
};
const std::vector<SceneCase>& scene_cases();

/// The scene of this name, from the sweep file in `folder` that has it. Throws Failure if it cannot be read.
scene::RunPlan read_hard_scene(const std::filesystem::path& folder, const std::string& name);

/// Tick, rods and values.
std::string to_text(const NumericalTrouble& trouble);

/// Called now and then with the part of the work that is done.
using OnProgress = std::function<void(double)>;

/// Runs the scene to its end, or for `seconds` if that is sooner, and samples its state every 2 ms of its time.
HardCase run_scene_case(const SceneCase& wanted, const scene::RunPlan& plan, double seconds,
                        const OnProgress& on_progress);

/// A scene's rods over one of the stretches of time into which its history is divided.
struct HistoryPoint {
  double time = 0;            ///< at the end of the stretch [s]
  double order = 0;           ///< nematic order S, mean of 23 samples of the stretch
  double kinetic_energy = 0;  ///< per rod, mean of these samples [pJ]
  double overlap = 0;         ///< deepest since the start, as a fraction of the thinnest bead's radius
  double energy_error = 0;    ///< energy unaccounted for since the start / turnover (Balance::energy_error)
};
inline constexpr int kHistoryPoints = 200;

/// Runs the scene for `seconds` of its time, however long it would be, in kHistoryPoints equal stretches. Throws
/// Failure if the rods cannot be placed, or on numerical trouble.
std::vector<HistoryPoint> history_of(const System& scene, double seconds, const OnProgress& on_progress);

/// The least radius of all beads of all species [mm].
double thinnest_radius(const World& world);

/// The three scenes order-sorted, order-reversed and order-shuffled, of which the statistics are compared.
inline constexpr const char* kOrderCase = "order";

/// How much is spent on that, and what counts as an answer.
struct OrderEffort {
  int replicas = 15;  ///< runs of each scene, which differ in their seed; each gives one sample of every mean
  double seconds =
      1e9;           ///< simulated, of a replica; that of the scene if it is less. The first eleventh is not counted
  double slack = 1;  ///< the bounds are so many times wider, and say so
};

/// Means of one scene under three orders of the contacts of a tick. Each must be shown to be the same within its bound:
/// what is left open for want of replicas does not hold.
HardCase run_order_case(const std::filesystem::path& folder, const OrderEffort& effort, const OnProgress& on_progress);

}  // namespace shaken::bench
