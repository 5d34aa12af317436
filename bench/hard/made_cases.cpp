#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "bench/case.h"
#include "bench/hard/hard.h"
#include "sim/balance.h"
#include "sim/simulation.h"

namespace shaken::bench {
namespace {

/// Rods of 2.5 mm in a large box between plates at rest.
System quiet_scene(double end_diameter) {
  System scene;
  scene.rod = {.length = 2.5, .end_diameter = end_diameter, .n_beads = 9};
  scene.box_side = 30;
  scene.gap = 10;
  scene.amplitude = 0;
  return scene;
}

/// The rods in the scene by every law, with little and with much friction and restitution.
std::vector<World> every_contact(const System& scene, const std::vector<Flight>& rods) {
  std::vector<World> worlds;
  for (const ImpulseLaw law : {ImpulseLaw::kNewton, ImpulseLaw::kPoisson, ImpulseLaw::kEnergetic}) {
    for (const double mu : {0.0, 0.05, 1.0}) {
      for (const double e : {0.0, 0.3, 1.0}) {
        // Newton's law may make energy with friction: seen here with mu = 0.05 and e = 1, an upright rod on the base
        if (law == ImpulseLaw::kNewton && (mu > 0.1 || mu * e > 0.02)) continue;
        System varied = scene;
        varied.law = law;
        varied.rod_rod = varied.rod_base = varied.rod_lid = {mu, e};
        worlds.push_back(begin_with(varied, rods).world());
      }
    }
  }
  return worlds;
}

Simulation by_stepper(World world, StepperKind stepper) {
  world.system.stepper = stepper;
  return Simulation::start_from(std::move(world));
}

/// Lets rods meet on both steppers.
std::vector<Outcome> meeting(const std::vector<World>& starts, Tick ticks, bool in_the_air) {
  double overlap = 0, growth = 0, ledger = 0, momentum = 0, fewest = std::numeric_limits<double>::infinity();
  int n_trouble = 0, n_different = 0;
  for (const World& begin : starts) {
    Simulation reference = by_stepper(begin, StepperKind::kReference);
    Simulation scheduled = by_stepper(begin, StepperKind::kScheduled);
    double before = content(scheduled.world()).energy;
    const double start = before;
    const Vec3 push = content(scheduled.world()).momentum;
    for (Tick tick = 100; tick <= ticks; tick += 100) {
      const bool trouble = reference.advance_to(tick).has_value();
      if (trouble != scheduled.advance_to(tick).has_value()) ++n_different;
      n_trouble += trouble;
      if (trouble) break;
      const double energy = content(scheduled.world()).energy;
      growth = std::max(growth, (energy - before) / start);
      before = energy;
    }
    n_different += reference.state_hash() != scheduled.state_hash();
    const World& world = scheduled.world();
    overlap = std::max(overlap, world.counters.max_overlap() / world.species.front().end_radius);
    ledger = std::max(ledger, balance(world).energy_error());
    const double scale = world.species.front().mass * 100.0;
    const Vec3 change = content(world).momentum - push;
    if (in_the_air) momentum = std::max(momentum, std::hypot(change.x(), change.y()) / scale);
    const Counters& counters = world.counters;
    fewest = std::min(fewest, static_cast<double>(counters.impulses_rod_rod + counters.impulses_rod_base));
  }
  std::vector<Outcome> outcomes{{"runs that meet trouble", static_cast<double>(n_trouble), 0},
                                {"runs in which the steppers differ", static_cast<double>(n_different), 0},
                                {"impulses in a run", fewest, 1, true},
                                {"overlap / end bead's radius", overlap, 0.1},
                                {"energy made / energy", growth, in_the_air ? kRounding : kRest},
                                {"energy unaccounted for / turnover", ledger, kRounding}};
  if (in_the_air) {
    outcomes.push_back({"change of momentum in the plane / that of a rod at 100 mm/s", momentum, kRounding});
  }
  return outcomes;
}

/// Rods that meet by every law of contact.
MadeCase meets(const std::string& name, const std::string& what, const System& scene, const std::vector<Flight>& rods,
               Tick ticks, bool in_the_air = true) {
  const auto starts = [=] { return every_contact(scene, rods); };
  return {name, what, [=] { return meeting(starts(), ticks, in_the_air); }, starts};
}

const Vec3 kX = Vec3::UnitX(), kY = Vec3::UnitY(), kZ = Vec3::UnitZ();
const Vec3 kMiddle(15, 15, 5), kNone = Vec3::Zero();

/// A row of ten rods in touch, hit at its end.
std::vector<Flight> row() {
  std::vector<Flight> rods;
  rods.reserve(10);
  for (int i = 0; i < 10; ++i) rods.push_back(thrown(Vec3(15, 8 + 0.8 * i + 1e-3 * (i > 0), 5), kX, Vec3::Zero()));
  rods.front().velocity = 50 * kY;
  return rods;
}

/// Tilted by the taper, above the base.
MadeCase half_rod_flat() {
  const System scene = quiet_scene(0.4);
  const double taper = make_species(scene.rod).taper();
  const Vec3 director(std::sqrt(1 - taper * taper), 0, taper);
  return meets("half-rod-flat", "tilted by the taper: one half of the rod falls flat on the base", scene,
               {thrown(Vec3(15, 15, 0.5), director, -50 * kZ)}, 3000, false);
}

/// A run that must end at once, with words.
std::vector<Outcome> ends(Simulation simulation, Tick within) {
  const auto trouble = simulation.advance_to(within);
  std::vector<Outcome> outcomes;
  outcomes.push_back({fmt::format("ends within {} ticks with a clear word", within),
                      trouble && !trouble->what.empty() ? 1.0 : 0.0, 1, true,
                      trouble ? fmt::format("tick {}: {}", trouble->tick, trouble->what) : "went on"});
  bool finite = true;
  for (const Flight& flight : simulation.world().rods) {
    finite = finite && flight.position.allFinite() && flight.velocity.allFinite() && flight.director.allFinite();
  }
  outcomes.push_back({"rods whose state is not a number", finite ? 0.0 : 1.0, 0});
  return outcomes;
}

MadeCase ends_at_once(const std::string& name, const std::string& what, const std::vector<Flight>& rods) {
  const auto start = [=] { return begin_with(quiet_scene(0.4), rods).world(); };
  return {name, what, [=] { return ends(Simulation::start_from(start()), 1); },
          [=] { return std::vector<World>{start()}; }};
}

/// Rods whose ends move at 4.5 m/s, between sticky plates that vibrate slowly and are just too weak or just strong
/// enough to throw them.
std::vector<World> whirling() {
  std::vector<World> worlds;
  for (const double gamma : {0.95, 1.05}) {
    for (const double frequency : {6.0, 20.0}) {
      for (const ImpulseLaw law : {ImpulseLaw::kPoisson, ImpulseLaw::kEnergetic}) {
        System scene;
        scene.rod = {.length = 2.5, .n_beads = 9};
        scene.box_side = 12;
        scene.gap = 3.2;
        scene.frequency = frequency;
        scene.amplitude = gamma * scene.gravity / std::pow(2 * M_PI * frequency, 2);
        scene.rod_rod = scene.rod_base = scene.rod_lid = {1.0, 0.0};
        scene.law = law;
        World world = begin_with(scene, {}).world();
        const double middle = world.plates.at(0).base + scene.gap / 2;
        std::vector<Flight> rods;
        for (int i = 0; i < 12; ++i) {
          const double angle = 0.5 * i;  // of the director; neighbours turn about other axes
          const int column = i % 3, row = i / 3;
          rods.push_back(thrown(Vec3(2 + 4 * column, 1.5 + 3 * row, middle), Vec3(std::cos(angle), std::sin(angle), 0),
                                Vec3(100 * std::sin(angle), -100 * std::cos(angle), 0),
                                Vec3(-2000 * std::sin(angle), 2000 * std::cos(angle), i % 2 == 0 ? 3000 : -3000)));
        }
        worlds.push_back(begin_with(scene, std::move(rods)).world());
      }
    }
  }
  return worlds;
}

std::vector<Outcome> whirl() {
  constexpr Tick kTicks = 25'000;  // 0.1 s: the turning has stopped long before
  double overlap = 0, ledger = 0, turning = 0, early = std::numeric_limits<double>::infinity();
  int n_trouble = 0;
  for (const World& start : whirling()) {
    early = std::min(early, kinetic_energy(start).rotation);
    Simulation simulation = Simulation::start_from(start);
    n_trouble += simulation.advance_to(kTicks).has_value();
    const World& world = simulation.world();
    overlap = std::max(overlap, world.counters.max_overlap() / world.species.front().end_radius);
    ledger = std::max(ledger, balance(world).energy_error());
    turning = std::max(turning, kinetic_energy(world).rotation);
  }
  return {{"runs that meet trouble", static_cast<double>(n_trouble), 0},
          {"overlap / end bead's radius", overlap, 0.1},
          {"energy unaccounted for / turnover", ledger, kRounding},
          {"energy of turning after 0.1 s / at the start", turning / early, 0.1}};
}

/// So many rods of 2.5 mm in a small box, shaken.
System small_scene(int n_rods) {
  System scene;
  scene.rod = {.length = 2.5, .n_beads = 9};
  scene.box_side = 12;
  scene.n_rods = n_rods;
  return scene;
}

World blow_up() {
  System scene = small_scene(84);
  scene.amplitude *= 100.0 / 7.0;
  scene.dt = 1e-4;
  return Simulation::start(scene).value().world();
}

std::vector<Outcome> does_not_fit() {
  const auto simulation = Simulation::start(small_scene(110));
  return {{"is refused with the most that would fit",
           !simulation && simulation.error().message.find("at most") != std::string::npos ? 1.0 : 0.0, 1, true,
           simulation ? "was not refused" : simulation.error().message}};
}

constexpr Tick kLate = 1'000'000'000;  // a whole number of the 1250 ticks of a period

/// Boxes that are 10^6 mm.
std::int32_t boxes_away(const World& world) { return static_cast<std::int32_t>(1e6 / world.system.box_side); }

/// At tick 10^9, with every rod 10^6 mm away.
World moved_away(World world) {
  const std::int32_t boxes = boxes_away(world);
  world.tick += kLate;
  for (Flight& flight : world.rods) {
    flight.since += kLate;
    flight.image[0] += boxes;
    flight.image[1] -= boxes;
  }
  return world;
}

/// A run that stands there goes on as one that starts now.
std::vector<Outcome> late_and_far() {
  Simulation fresh = std::move(Simulation::start(small_scene(70))).value();
  const std::int32_t boxes = boxes_away(fresh.world());
  Simulation late = Simulation::start_from(moved_away(fresh.world()));
  constexpr Tick kTicks = 20000;
  const bool trouble = fresh.advance_to(kTicks).has_value() || late.advance_to(kLate + kTicks).has_value();
  const Snapshot a = fresh.snapshot();
  const Snapshot b = late.snapshot();
  double apart = 0;
  for (std::size_t i = 0; i < a.position.size(); ++i) {
    apart = std::max({apart, (a.position[i] - b.position[i]).norm(), (a.director[i] - b.director[i]).norm()});
    if (b.image[i][0] - a.image[i][0] != boxes || a.image[i][1] - b.image[i][1] != boxes) apart = 1e6;
  }
  return {{"numerical trouble", trouble ? 1.0 : 0.0, 0},
          {"apart after 20,000 ticks [mm]", apart, 0, false, "the same bits"}};
}

/// Rods and grains with a hundredth of their mass.
System mixed_scene() {
  System scene;
  scene.rod = {.length = 4.5, .n_beads = 15};
  scene.n_rods = 12;
  scene.added[0] = AddedRods{{.length = 0.7, .mid_diameter = 0.25, .end_diameter = 0.25, .n_beads = 3}, 60};
  scene.box_side = 15;
  scene.start = Start::kRandom;
  scene.law = ImpulseLaw::kEnergetic;
  scene.rod_rod.friction = 0.5;
  return scene;
}

std::vector<Outcome> two_sizes() {
  System scene = mixed_scene();
  scene.stepper = StepperKind::kReference;
  auto reference = Simulation::start(scene);
  scene.stepper = StepperKind::kScheduled;
  auto scheduled = Simulation::start(scene);
  if (!reference || !scheduled) {
    return {{"the rods can be placed", 1, 0, false, scheduled.error().message}};
  }
  const bool trouble = scheduled->advance_to(5000).has_value() || reference->advance_to(5000).has_value();
  const bool differ = scheduled->state_hash() != reference->state_hash();
  const bool later = trouble || scheduled->advance_to(50000).has_value();
  const World& world = scheduled->world();
  return {{"runs that meet trouble", later ? 1.0 : 0.0, 0},
          {"runs in which the steppers differ", differ ? 1.0 : 0.0, 0},
          {"overlap / thinnest bead's radius", world.counters.max_overlap() / 0.125, 0.25},
          {"energy unaccounted for / turnover", balance(world).energy_error(), kRounding}};
}

}  // namespace

const std::vector<MadeCase>& made_cases() {
  const auto at = [](const Vec3& place, const Vec3& director, const Vec3& velocity) {
    return thrown(kMiddle + place, director, velocity);
  };
  static const std::vector<MadeCase> cases{
      meets("parallel", "two equal cylinders side by side, exactly parallel: all beads meet at once", quiet_scene(0.8),
            {at(-0.5 * kY, kX, 50 * kY), at(0.5 * kY, kX, -50 * kY)}, 2000),
      meets("collinear", "two rods in one line, end to end", quiet_scene(0.4),
            {at(-1.3 * kX, kX, 50 * kX), at(1.3 * kX, kX, -50 * kX)}, 2000),
      meets("crossing", "two rods crossing at right angles, exactly centre on centre", quiet_scene(0.4),
            {at(-0.5 * kZ, kX, 50 * kZ), at(0.5 * kZ, kY, -50 * kZ)}, 2000),
      meets("simultaneous", "a rod hit from both sides at the same instant", quiet_scene(0.4),
            {at(kNone, kX, kNone), at(-0.9 * kY, kX, 50 * kY), at(0.9 * kY, kX, -50 * kY)}, 4000),
      meets("row", "a row of ten rods in touch, hit at its end", quiet_scene(0.4), row(), 4000),
      half_rod_flat(),
      meets("upright", "rods exactly upright, falling on the base, side by side", quiet_scene(0.4),
            {thrown(Vec3(15, 15, 1.3), kZ, -50 * kZ), thrown(Vec3(15.81, 15, 1.3), kZ, Vec3(-20, 0, -50))}, 4000,
            false),
      {"whirling", "rods that turn 570 times a second between slow sticky plates, Gamma = 0.95 and 1.05", whirl,
       whirling},
      ends_at_once("coincident", "two rods in the same place", {at(kNone, kX, 10 * kY), at(kNone, kX, -10 * kY)}),
      ends_at_once("overlapping", "a start with rods half inside each other",
                   {at(kNone, kX, kNone), at(0.4 * kY, kX, kNone)}),
      ends_at_once("through-base", "a start with a rod in the base", {thrown(Vec3(15, 15, 0.1), kX, kNone)}),
      {"blow-up", "Gamma = 100 with a tick 25 times too long",
       [] { return ends(Simulation::start_from(blow_up()), 2000); }, [] { return std::vector<World>{blow_up()}; }},
      {"does-not-fit", "more rods than can be placed", does_not_fit, [] { return std::vector<World>(); }},
      {"late-and-far", "a thousand million ticks into a run, rods 10^6 mm from where they began", late_and_far,
       [] { return std::vector<World>{moved_away(Simulation::start(small_scene(70)).value().world())}; }},
      {"two-sizes", "rods among grains of a hundredth of their mass", two_sizes,
       [] { return std::vector<World>{Simulation::start(mixed_scene()).value().world()}; }}};
  return cases;
}

}  // namespace shaken::bench
