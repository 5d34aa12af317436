#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "base/failure.h"
#include "base/files.h"
#include "bench/hard/hard.h"
#include "scene/sweeps/sweep.h"
#include "sim/balance.h"
#include "sim/motion/start_motion.h"
#include "sim/simulation.h"

namespace shaken::bench {
namespace {

/// The sweep files of the hard scenes, with the names of their points in order.
const std::vector<std::pair<const char*, std::vector<std::string>>> kFiles{
    {"packing", {"packed", "crystal", "narrow", "tall"}},
    {"restitution", {"inelastic", "collapse", "elastic"}},
    {"friction",
     {"friction-0-newton", "friction-0-energetic", "friction-1-newton", "friction-1-energetic", "friction-1000-newton",
      "friction-1000-energetic"}},
    {"rough", {"elastic-rough-energetic", "elastic-rough-poisson", "elastic-rough-newton"}},
    {"shapes", {"spheres", "three-beads", "no-taper", "needle", "dumbbell"}},
    {"shaking", {"strong", "wild", "coarse"}},
    {"plates", {"squeezed", "two-frequencies", "steep", "posts", "unequal", "pile"}},
    {"walls", {"corner", "tips", "stadium"}},
    {"rest", {"rest"}},
    {"sticky", {"sticky-below", "sticky-above", "sticky-slow", "sticky-fast"}},
    {"order", {"order-sorted", "order-reversed", "order-shuffled"}},
};

/// The energy balance must close to this, as a fraction of all that changed hands; and to a rounding for each impulse.
constexpr double kLedgerLimit = 1e-12;
constexpr double kLedgerPerImpulse = 1e-16;
/// Rods between plates at rest have come to rest after a tenth of this [s]; a shorter run cannot tell.
constexpr double kLongEnoughToRest = 10;

/// The largest values of a run.
struct Extremes {
  std::optional<NumericalTrouble> trouble;
  double most_energy = 0;       ///< kinetic, per rod [pJ]
  double growth = -1;           ///< largest rise of the total energy between two samples, of that at the start
  double drift = 0;             ///< largest change of the total energy, of that at the start
  double longest_director = 0;  ///< | |n| - 1 |
  double late_bouncing = 0;     ///< largest kinetic energy of vertical motion per rod after a tenth of the time [pJ]
  double tenth_energy = 0;      ///< kinetic, after a tenth of the time [pJ]
  double late_energy = 0;       ///< largest of that later [pJ]
};

double total_energy(const World& world) { return content(world).energy; }

Extremes follow_run(Simulation& simulation, double seconds, const OnProgress& on_progress) {
  Extremes found;
  const World& world = simulation.world();
  const auto n = static_cast<double>(world.rods.size());
  const auto end = static_cast<Tick>(std::llround(seconds / world.system.dt));
  const Tick stride = std::max<Tick>(1, std::llround(kSampleEvery / world.system.dt));
  const double start = total_energy(world);
  double before = start;
  while (simulation.tick() < end) {
    found.trouble = simulation.advance_to(std::min(end, simulation.tick() + stride));
    if (found.trouble) return found;
    const double kinetic = kinetic_energy(world).total() / n;
    found.most_energy = std::max(found.most_energy, kinetic);
    const double now = total_energy(world);
    found.growth = std::max(found.growth, (now - before) / start);
    found.drift = std::max(found.drift, std::abs(now - start) / start);
    before = now;
    for (const Vec3& director : simulation.snapshot().director) {
      found.longest_director = std::max(found.longest_director, std::abs(director.norm() - 1));
    }
    if (10 * simulation.tick() >= end) {
      if (found.tenth_energy == 0) found.tenth_energy = kinetic;
      found.late_energy = std::max(found.late_energy, kinetic);
      found.late_bouncing = std::max(found.late_bouncing, kinetic_energy(world).translation_z / n);
    }
    on_progress(static_cast<double>(simulation.tick()) / static_cast<double>(end));
  }
  return found;
}

/// Energy that a rod cannot exceed on average, with a body hit by both plates again and again as the worst case: it
/// leaves a plate at (1 + e) / (1 - e) of the plate's speed, and falls through the gap and down the slope.
double energy_limit(const World& world, double duration) {
  const System& scene = world.system;
  const double e = std::max(scene.rod_base.restitution, scene.rod_lid.restitution);
  const double slid = scene.gravity_on_plates().along_size() * duration;  // [mm/s]
  const double speed = (1 + e) / (1 - e) * world.plates.peak_speed() + std::sqrt(2 * scene.gravity * scene.gap) +
                       std::sqrt(3.0) * kStartSpeed + slid;
  return 0.5 * world.species.front().mass * speed * speed;
}

}  // namespace

double thinnest_radius(const World& world) {
  double radius = std::numeric_limits<double>::infinity();
  for (const Species& species : world.species) {
    radius = std::min(radius, *std::min_element(species.bead_radius.begin(), species.bead_radius.end()));
  }
  return radius;
}

std::string to_text(const NumericalTrouble& trouble) {
  return fmt::format("tick {}, rods {}: {}", trouble.tick, fmt::join(trouble.rods, ", "), trouble.what);
}

const std::vector<SceneCase>& scene_cases() {
  static const std::vector<SceneCase> cases{
      {"packed", "packed to 0.90 and started there"},
      {"crystal", "aligned rods in a gap of 0.9 mm"},
      {"narrow", "a gap of 0.82 mm: rods nearly touch both plates"},
      {"tall", "a gap of 6 mm: rods stand upright and tumble"},
      {"inelastic", "e = 0"},
      {"collapse", "e = 0.05: inelastic collapse"},
      {"elastic", "e = 1, no friction, plates at rest: nothing is lost"},
      {"friction-0-newton", "no friction"},
      {"friction-0-energetic", "no friction, energetic law"},
      {"friction-1-newton", "mu = 1"},
      {"friction-1-energetic", "mu = 1, energetic law"},
      {"friction-1000-newton", "mu = 1000"},
      {"friction-1000-energetic", "mu = 1000, energetic law"},
      {"elastic-rough-energetic", "e = 1, mu = 1, plates at rest, energetic law"},
      {"elastic-rough-poisson", "e = 1, mu = 1, plates at rest, Poisson's law"},
      {"elastic-rough-newton", "e = 1, mu = 1, plates at rest, Newton's law", 0.1, true},
      {"spheres", "one bead"},
      {"three-beads", "three beads"},
      {"no-taper", "no taper"},
      {"needle", "aspect ratio 50"},
      {"dumbbell", "wider at the ends"},
      {"strong", "Gamma = 30"},
      {"wild", "Gamma = 100"},
      {"coarse", "a tick ten times too long", 0.5},
      {"squeezed", "a lid against the base: 0.81 mm are left for rods 0.8 mm thick"},
      {"two-frequencies", "a second vibration at 317 Hz, three times as strong as the first"},
      {"steep", "inclined by 60 degrees: rods slide faster and faster"},
      {"posts", "rough posts on a slope, two rods apart"},
      {"unequal", "rods that differ in size, packed to 0.80"},
      {"pile", "an open container, weakly shaken: sticky rods pile up; four passes over contacts", 0.5},
      {"corner", "polar rods in a triangle with a sharp corner"},
      {"tips", "an ellipse with tips as sharp as beads allow, and elastic walls"},
      {"stadium", "a stadium with rough walls without restitution, energetic law"},
      {"rest", "Gamma = 0: all comes to rest"},
      {"sticky-below", "e = 0, mu = 1, 10 Hz, Gamma = 0.95: plates too weak to throw rods"},
      {"sticky-above", "e = 0, mu = 1, 10 Hz, Gamma = 1.05: plates that just throw rods"},
      {"sticky-slow", "e = 0, mu = 1, 6 Hz, Gamma = 1.2, energetic law"},
      {"sticky-fast", "e = 0, mu = 1, 20 Hz, Gamma = 1.1, energetic law"},
  };
  return cases;
}

scene::RunPlan read_hard_scene(const std::filesystem::path& folder, const std::string& name) {
  for (const auto& [file_name, points] : kFiles) {
    const auto point = static_cast<std::size_t>(std::ranges::find(points, name) - points.begin());
    if (point == points.size()) continue;
    const std::filesystem::path file = folder / (std::string(file_name) + ".json");
    const Result<std::string> text = read_file(file);
    if (!text) {
      throw Failure(ExitCode::kBadInput,
                    text.error().message + "; --cases DIR names the folder of the scenes, configs/hard of the sources");
    }
    const keys::Loaded<scene::Sweep> sweep = scene::load_sweep(*text, file.string());
    if (!sweep) throw Failure(ExitCode::kBadInput, to_string(sweep.error()));
    if (sweep->points.size() != points.size()) {
      throw Failure(ExitCode::kBadInput, fmt::format("{} has {} points, where {} are known: {}", file.string(),
                                                     sweep->points.size(), points.size(), fmt::join(points, ", ")));
    }
    return sweep->points[point].plan;
  }
  throw Failure(ExitCode::kBadInput, "no hard scene is called '" + name + "'");
}

HardCase run_scene_case(const SceneCase& wanted, const scene::RunPlan& plan, double seconds,
                        const OnProgress& on_progress) {
  HardCase result{wanted.name, wanted.what, {}};
  auto simulation = Simulation::start(plan.system);
  if (!simulation) {
    result.outcomes.push_back({"the rods can be placed", 1, 0, false, simulation.error().message});
    return result;
  }
  const double duration = std::min(seconds, plan.total_time());
  const Extremes found = follow_run(*simulation, duration, on_progress);
  const World& world = simulation->world();
  if (found.trouble) {
    result.outcomes.push_back({"no numerical trouble", 1, 0, false, to_text(*found.trouble)});
    return result;
  }
  result.outcomes.push_back(
      {"overlap / thinnest bead's radius", world.counters.max_overlap() / thinnest_radius(world), wanted.max_overlap});
  const bool shaken = world.system.has_moving_plates();
  if (shaken) {
    result.outcomes.push_back({"kinetic energy per rod [pJ]", found.most_energy, energy_limit(world, duration)});
  } else if (wanted.makes_energy) {
    // in the whole of its time: a shorter run may not come to an impact that makes some
    if (duration >= plan.total_time())
      result.outcomes.push_back({"energy made in 2 ms / energy", found.growth, 1e-4, true, "by this law, as is known"});
  } else {
    const bool elastic = world.system.rod_base.restitution == 1;
    result.outcomes.push_back(
        {"energy made in 2 ms / energy", std::max(0.0, found.growth), elastic ? kRounding : kRest});
  }
  if (wanted.name == "elastic") {
    result.outcomes.push_back({"change of energy / energy", found.drift, kRounding});
  }
  if (wanted.name == "rest" && duration >= kLongEnoughToRest) {
    // A tick of free fall, ended by the base, is all the bouncing there should be. What rolls goes on rolling: nothing
    // in the model stops it, but nothing drives it either.
    const double tick_fall = world.system.gravity * world.system.dt;
    result.outcomes.push_back({"bouncing energy per rod after a tenth [pJ]", found.late_bouncing,
                               world.species.front().mass * tick_fall * tick_fall});
    result.outcomes.push_back(
        {"rise of kinetic energy after a tenth / energy", found.late_energy / found.tenth_energy - 1, 0.01});
  }
  const Counters& counters = world.counters;
  const auto n_impulses =
      static_cast<double>(counters.impulses_rod_rod + counters.impulses_rod_base + counters.impulses_rod_lid +
                          counters.impulses_rod_wall + counters.impulses_rod_post);
  result.outcomes.push_back({"energy unaccounted for / turnover", balance(world).energy_error(),
                             std::max(kLedgerLimit, kLedgerPerImpulse * n_impulses)});
  result.outcomes.push_back({"length of a director, off 1 by", found.longest_director, 1e-14});
  return result;
}

}  // namespace shaken::bench
