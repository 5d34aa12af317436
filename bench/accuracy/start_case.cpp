#include <cmath>

#include "base/core/rng.h"
#include "base/failure.h"
#include "bench/accuracy/errors.h"

namespace shaken::bench {
namespace {

constexpr std::uint64_t kSeed = 20240908;

Vec3 jitter(Rng& rng, double size) {
  const double x = rng.uniform(-size, size);
  const double y = rng.uniform(-size, size);
  return {x, y, rng.uniform(-size, size)};
}

/// The paper's rods between the paper's plates, placed with a member's own random numbers, for so many of the longest
/// steps.
StartCase between_plates(const char* name, const char* what, int n_rods, double side, int steps,
                         std::vector<Flight> (*place)(Rng& rng)) {
  StartCase start{name, what, steps * kLongestStep, 64, {}, {}};
  start.scene.n_rods = n_rods;
  start.scene.box_side = side;
  start.scene.seed = kSeed;
  start.rods = [place](int member) {
    Rng rng(kSeed, RngStream::kVelocity, 0, static_cast<std::uint64_t>(member));
    return place(rng);
  };
  return start;
}

/// Two rods that fall freely side by side, far from any plate: only they can hit each other.
StartCase in_free_fall(const char* name, const char* what, std::vector<Flight> (*place)(Rng& rng)) {
  StartCase start = between_plates(name, what, 2, 30, 64, place);
  start.scene.gap = 20;
  return start;
}

std::vector<Flight> rattling(Rng& rng) {
  const double z = 0.687 + rng.uniform(-0.1, 0.1);
  const Vec3 velocity = Vec3(20, 10, 150) + jitter(rng, 20);
  return {thrown({15, 15, z}, Vec3(1, 0.3, 0.02), velocity, Vec3(0, 3, 0) + jitter(rng, 3))};
}

std::vector<Flight> wedged(Rng& rng) {
  // both ends 0.01 mm from their plates, and turning towards them
  const double n_z = 0.39 / (0.5 * 4.5 - 0.2);
  const double z = 2 * 0.043486 + 0.6 + rng.uniform(-0.005, 0.005);
  const Vec3 velocity = Vec3(20, 0, -20) + jitter(rng, 10);
  return {thrown({15, 15, z}, {std::sqrt(1 - n_z * n_z), 0, n_z}, velocity, Vec3(0, -20, 2) + jitter(rng, 5))};
}

/// One along x at `place`, one at `apart` from it, at such velocities.
std::vector<Flight> two_rods(Rng& rng, const Vec3& place, const Vec3& apart, const Vec3& other_director,
                             const Vec3& velocity) {
  return {thrown(place, {1, 0, 0}, velocity + jitter(rng, 5), jitter(rng, 3)),
          thrown(place + apart, other_director, -velocity + jitter(rng, 5), jitter(rng, 3))};
}

std::vector<Flight> head_on(Rng& rng) {
  const double gap = rng.uniform(0.10, 0.16);
  const Vec3 apart(4.5 + gap, rng.uniform(-0.1, 0.1), rng.uniform(-0.1, 0.1));
  return two_rods(rng, {13, 15, 10}, apart, {1, 0, 0}, {50, 0, 0});
}

std::vector<Flight> glancing(Rng& rng) {
  const Vec3 apart(rng.uniform(0.5, 1.5), 0.83 + rng.uniform(-0.03, 0.01), rng.uniform(-0.1, 0.1));
  return two_rods(rng, {13, 15, 10}, apart, {1, 0.05, 0}, {50, 20, 0});
}

std::vector<Flight> crossing(Rng& rng) {
  const Vec3 apart(rng.uniform(-1.5, 1.5), 2.25 + 0.4 + rng.uniform(0.10, 0.16), rng.uniform(-0.1, 0.1));
  return two_rods(rng, {15, 13, 10}, apart, {0, 1, 0}, {0, 50, 0});
}

/// Two columns of six rods, close together, that jostle.
std::vector<Flight> dozen(Rng& rng) {
  std::vector<Flight> rods;
  for (int k = 0; k < 12; ++k) {
    const int row = k / 2;
    const Vec3 place(8 + 4.52 * (k % 2) + 2.25 * (row % 2), 8 + 0.64 * row, 0.687);
    rods.push_back(thrown(place + jitter(rng, 0.004), {1, 0, 0}, jitter(rng, 40), jitter(rng, 8)));
  }
  return rods;
}

/// A dense box in the middle of its motion.
StartCase hundred() {
  StartCase start = between_plates("hundred", "a hundred rods at area fraction 0.75, shaken for 0.2 s before", 100,
                                   18.235, 32, nullptr);
  start.members = 32;
  start.rods = [scene = start.scene](int member) {
    System before = scene;
    before.seed = kSeed + static_cast<std::uint64_t>(member);
    Simulation simulation = value_or_fail(Simulation::start(before));
    advance(simulation, Tick{40} * 1250);  // whole vibrations: the plates stand as at tick 0
    const Snapshot rods = simulation.snapshot();
    std::vector<Flight> flights;
    for (std::size_t i = 0; i < rods.n_rods(); ++i) {
      flights.push_back(thrown(rods.position[i], rods.director[i], rods.velocity[i], rods.angular_velocity[i]));
    }
    return flights;
  };
  return start;
}

}  // namespace

const std::vector<Variant>& variants() {
  static const std::vector<Variant> all{
      {"newton", [](System& scene) { scene.law = ImpulseLaw::kNewton; }},
      {"instant", [](System& scene) { scene.impacts = ImpactTime::kAtInstant; }},
      {"poisson", [](System& scene) { scene.law = ImpulseLaw::kPoisson; }},
      {"energetic", [](System& scene) { scene.law = ImpulseLaw::kEnergetic; }},
  };
  return all;
}

const std::vector<StartCase>& start_cases() {
  static const std::vector<StartCase> all{
      between_plates("rattling", "one rod hits lid and base in turn", 1, 30, 128, rattling),
      between_plates("wedged", "one rod, tilted, touches base and lid", 1, 30, 64, wedged),
      in_free_fall("head-on", "two rods in line, tip to tip", head_on),
      in_free_fall("glancing", "two rods side by side that slide along each other", glancing),
      in_free_fall("crossing", "the end of one rod hits the flank of the other", crossing),
      between_plates("dozen", "twelve rods packed side by side", 12, 20, 64, dozen),
      hundred()};
  return all;
}

Simulation begin(const StartCase& start, const std::vector<Flight>& rods, const Variant& variant, StepperKind stepper,
                 double dt) {
  System scene = start.scene;
  variant.apply(scene);
  scene.stepper = stepper;
  scene.dt = dt;
  return begin_with(scene, rods);
}

}  // namespace shaken::bench
