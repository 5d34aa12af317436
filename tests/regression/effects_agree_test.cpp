// Both steppers give the same trajectory, bit by bit, with each effect that a scene may call for and with mixes of
// them.
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <functional>

#include "sim/motion/side_walls.h"
#include "sim/simulation.h"
#include "tests/support/compare_steppers.h"

namespace shaken {
namespace {

using test::compare;
using test::compare_threads;
using test::problem;

/// Rods of 2.5 mm at so high an area fraction in a box of 16 mm.
System rods(double area_fraction) {
  System system;
  system.rod = {.length = 2.5, .n_beads = 9};
  system.box_side = 16;
  system.n_rods = static_cast<int>(area_fraction * 256 / make_species(system.rod).area);
  return system;
}

const RodShape kPolarRod{.length = 3.0, .mid_diameter = 0.9, .n_beads = 11, .profile = Profile::kPolar};
const RodShape kSphere{.length = 0.8, .n_beads = 1};
const RodShape kBowlingPin{.length = 2.5, .bead_diameters{0.9, 0.8, 0.6, 0.4, 0.5, 0.7, 0.5, 0.3}};

/// What a scene has besides.
using Change = std::function<void(System&)>;
template <class T>
Change set(T System::*member, const std::type_identity_t<T>& value) {
  return [=](System& s) { s.*member = value; };
}
/// So many of the first species alone.
Change n(int n_rods, const RodShape& rod = rods(0).rod) {
  return [=](System& s) { s.n_rods = n_rods, s.rod = rod; };
}
/// Rods of the other two species.
Change added(int n_polar, int n_spheres) {
  return [=](System& s) { s.added = {AddedRods{kPolarRod, n_polar}, AddedRods{kSphere, n_spheres}}; };
}
Change walls(const SideWalls& walls) { return set(&System::walls, walls); }
Change disc(double size) { return walls({Arena::kDisc, size}); }
Change posts(const Posts& posts) { return set(&System::posts, posts); }
/// The contacts of both plates.
Change plates(const Contacts& contact) {
  return [=](System& s) { s.rod_base = s.rod_lid = contact; };
}
Change slope(double inclination, double angle = 0) {
  return [=](System& s) { s.inclination = inclination, s.inclination_angle = angle; };
}
Change horizontal(double amplitude, double phase, double angle = 0) {
  return [=](System& s) { s.horizontal_amplitude = amplitude, s.horizontal_phase = phase, s.horizontal_angle = angle; };
}
/// Without plates and gravity, in a plane.
Change planar(const Contacts& contact) {
  return [=](System& s) { s.base = s.lid = false, s.gravity = 0, s.rod_rod = contact; };
}
const Change kAtInstant = set(&System::impacts, ImpactTime::kAtInstant),
             kScattered = set(&System::start, Start::kRandom), kEnergetic = set(&System::law, ImpulseLaw::kEnergetic),
             kOblong = set(&System::box_aspect, 0.75);

/// 40 rods of 3 mm in a narrow gap that bounce well, with a tick of 50 us: displaced rods overlap and recede, and are
/// hit by plates that nearly cancel.
void coarse_and_bouncy(System& system) {
  n(40, {.length = 3.0, .n_beads = 11})(system);
  system.box_side = std::sqrt(40 * make_species(system.rod).area / 0.8);
  system.gap = 1.1;
  system.impacts = ImpactTime::kAtInstant;
  system.rod_rod.restitution = 0.9;
  system.rod_base.restitution = system.rod_lid.restitution = 0.8;
  system.dt = 50e-6;
}

/// A trap of posts, in two rows that meet.
Posts trap() {
  Posts trap{.diameter = 1.0, .contact = {0.2, 0.5}};
  for (int k = 0; k < 6; ++k) {
    trap.places.emplace_back(0.2 + 0.8 * k, 8 + 0.6 * k);
    if (k > 0) trap.places.emplace_back(0.2 + 0.8 * k, 8 - 0.6 * k);
  }
  return trap;
}

void polydisperse(System& system) {
  system.n_rods = 50;
  system.rod.spread = {.length = 0.15, .end_diameter = 0.3};
  system.added[0] = AddedRods{kSphere, 20};
  system.added[0]->rod.spread.length = 0.2;
  system.rod_rod.own[Contacts::place(0, 1)].friction = 0.5;
}

void contacts_of_species(System& system) {
  system.rod_rod.own[Contacts::place(0, 1)] = {0.5, 0.9, {}};
  system.rod_rod.own[Contacts::place(2, 2)].friction = 0.0;
  system.rod_base.own[Contacts::place(0, 1)].friction = 0.0;  // the others go by lanes
  system.rod_lid.own[Contacts::place(0, 2)].restitution_speed = 30.0;
  system.walls->contact.own[Contacts::place(0, 2)] = {1.0, 0.0, {}};
}

struct Case {
  const char* name;
  std::vector<Change> changes;
  double area_fraction = 0.5;
  Tick ticks = 12000;

  friend void PrintTo(const Case& one, std::ostream* out) { *out << one.name; }
};

const SideWalls kEllipse{.arena = Arena::kEllipse, .size = 10, .contact = {0.3, 0.5}, .length = 14};
const SideWalls kWedge{.arena = Arena::kWedge, .size = 14, .contact = {0.3, 0.5}, .length = 14};
const SideWalls kStadium{.arena = Arena::kStadium, .size = 9, .contact = {0.3, 0.5}, .length = 6};
const SideWalls kChannel{.arena = Arena::kChannel, .size = 11, .contact = {0.3, 0.5}};

std::vector<Case> cases() {
  using S = System;
  const auto own_post = [](S& s) { s.posts->contact.own[Contacts::place(0, 2)] = {0.5, 0.9, {}}; };
  const auto noise_of = [](int added, double noise) { return [=](S& s) { s.added_noise[added] = noise; }; };
  const Change noise = set(&S::rotational_noise, 0.1), smooth_plates = plates({0.0, 0.3}),
               still = set(&S::amplitude, 0);
  const auto falling = [](double rod_rod, double base, double lid) {
    return [=](S& s) {
      s.rod_rod.restitution_speed = rod_rod, s.rod_base.restitution_speed = base, s.rod_lid.restitution_speed = lid;
    };
  };
  return {
      {"AtInstant", {kAtInstant}},
      {"AtInstantDense", {kAtInstant}, 0.85},
      {"AtInstantLongTicks", {kAtInstant, set(&S::dt, 40e-6)}, 0.75, 4000},
      {"AtInstantCoarseBouncy", {coarse_and_bouncy, set(&S::seed, 9)}, 0.8, 5000},
      {"AtInstantCoarseBouncyAgain", {coarse_and_bouncy, set(&S::seed, 11)}, 0.8, 5000},
      {"AtInstantCoarseBouncySweeps", {coarse_and_bouncy, set(&S::seed, 2), set(&S::solver_sweeps, 2)}, 0.8, 7000},
      {"AtInstantFrictionlessSweeps",
       {kAtInstant, smooth_plates, set(&S::rod_rod, {0.0, 0.3}), set(&S::solver_sweeps, 3)},
       0.7},
      {"AtInstantElastic", {kAtInstant, set(&S::rod_rod, {0.0, 1.0}), plates({0.0, 1.0}), set(&S::gap, 3)}, 0.4},
      {"Spheres", {[](S& s) {
         s.added[0] = AddedRods{kSphere, 30};
       }}},
      {"PolarAmongApolar",
       {n(50),
        [](S& s) {
          s.added[0] = AddedRods{kPolarRod, 12};
        }}},
      {"PolarAlone", {n(60, kPolarRod)}},
      {"PolarInAWideGap", {n(40, kPolarRod), set(&S::gap, 4), kScattered}},
      {"FreeProfile", {n(60, kBowlingPin)}},
      {"ThreeKinds", {n(50), added(10, 20)}},
      {"Polydisperse", {polydisperse}},
      {"VeryDifferentSizes",
       {n(8, {.length = 7.0, .mid_diameter = 1.0, .n_beads = 23}),
        [](S& s) {
          s.added[0] = AddedRods{{.length = 0.5, .mid_diameter = 0.5, .n_beads = 1}, 40};
        }}},
      {"Disc", {n(50), disc(14)}},
      {"Square", {n(60), walls({Arena::kSquare, 14.0, 1.0, {0.3, 0.5}})}},
      {"Annulus", {n(30), walls({Arena::kAnnulus, 14.5, 4.0}), kScattered}},
      {"Stadium", {n(40), walls(kStadium)}},
      {"PolarInAStadium",
       {n(20, kPolarRod), walls({.arena = Arena::kStadium, .size = 8, .length = 7}), kScattered, kAtInstant}},
      {"Ellipse", {n(35), walls(kEllipse)}},
      {"PolarInAnEllipse",
       {n(12, kPolarRod), walls({.arena = Arena::kEllipse, .size = 7, .length = 14.5}), kScattered, kAtInstant}},
      {"Wedge", {n(25), walls(kWedge)}},
      {"PolarInABluntWedge",
       {n(12, kPolarRod), walls({.arena = Arena::kWedge, .size = 9, .length = 14, .narrow = 1}), kScattered,
        kAtInstant}},
      {"Channel", {n(70), walls(kChannel), kOblong}},
      {"PinsInANarrowChannel", {n(12, kBowlingPin), walls({.arena = Arena::kChannel, .size = 3.5}), kScattered}},
      {"PolarInAnAnnulus", {n(30, kPolarRod), walls({Arena::kAnnulus, 14.5, 4.0}), kScattered}},
      {"DiscAtInstant", {n(50), disc(14), kAtInstant}},
      {"Posts", {n(50), posts({.diameter = 1.5, .columns = 3, .rows = 3, .contact = {0.3, 0.6}})}},
      {"PolarAmongManyPosts", {n(8, kPolarRod), posts({.diameter = 0.3, .columns = 12, .rows = 9}), kScattered}},
      {"PinsByATrap", {n(40, kBowlingPin), posts(trap()), kScattered, kAtInstant}},
      {"PostsInADisc", {n(20), added(8, 10), disc(14), posts({.diameter = 1.2}), own_post, kScattered}},
      {"PlanarPostsInAChannel",
       {n(30), planar({0.0, 0.95}), walls({.arena = Arena::kChannel, .size = 11, .contact = {0.0, 0.95}}),
        posts({.diameter = 2.0, .columns = 4, .rows = 2, .contact = {0.0, 0.95}}), kOblong}},
      {"Noise", {noise}},
      {"NoiseOfSpecies", {n(20), added(15, 12), noise_of(0, 0.2)}},  // the others go by lanes
      {"NoiseOfAllSpeciesButOneWithSizes",
       {n(25), noise, noise_of(1, 0), set(&S::added, {std::nullopt, AddedRods{kPolarRod, 15}}),
        [](S& s) { s.rod.spread = {.length = 0.15, .end_diameter = 0.1}; }}},
      {"NoiseFrictionlessAtInstant", {noise, smooth_plates, kAtInstant}},
      {"HorizontalVibration", {horizontal(0.05, 70, 30)}},
      {"HorizontalVibrationOfStickyPlatesAtInstant",
       {set(&S::amplitude, 0.02), horizontal(0.1, -90), plates({1.0, 0.3}), kEnergetic, kAtInstant}},
      {"SecondVibration", {set(&S::second, {{0.02, 317.0, 40.0}})}},
      {"SecondVibrationAtInstant", {set(&S::second, {{0.03, 400.0, 90.0}}), kAtInstant}},
      {"LidAtRest", {set(&S::lid_motion, LidMotion{})}},
      {"LidByItselfAtInstant",
       {set(&S::lid_motion, {{0.08, 150.0}}), set(&S::second, {{0.01, 317.0, 0.0}}), noise, kAtInstant}},
      {"LidAloneMoves", {still, set(&S::lid_motion, {{0.1, 0.0}})}, 0.5, 3000},
      {"Inclined", {slope(3, 40)}},
      // steeper than a scene may have it, and so harder
      {"SteepInAChannelWithPosts",
       {n(30), slope(60), walls({.arena = Arena::kChannel, .size = 11, .contact = {0.1, 0.5}}),
        posts({.diameter = 2.0, .columns = 4, .rows = 2, .contact = {0.1, 0.5}}), kOblong}},
      {"SteepInADiscAtInstant", {n(30), slope(90, -70), disc(14), kAtInstant}},
      {"SteepWithoutFriction", {slope(45), smooth_plates}},
      {"RestitutionOfSpeed", {falling(20, 60, 60)}},
      {"RestitutionOfSpeedFrictionlessAtRest", {still, plates({0.0, 0.5}), falling(0, 5, 5)}, 0.5, 3000},
      {"RestitutionOfSpeedByTheEnergeticLaw",
       {kEnergetic, kAtInstant, set(&S::rod_rod, {0.5, 0.6}), falling(10, 10, 0)}},
      {"SpeciesOfTheirOwn", {n(20), added(8, 12), disc(15), contacts_of_species}},
      {"NoLid", {set(&S::lid, false)}},
      {"Planar", {planar({0.0, 1.0})}, 0.6},
      {"PlanarPolarInADisc", {n(30, kPolarRod), planar({0.05, 0.9}), walls({Arena::kDisc, 14.0, 1.0, {0.0, 0.9}})}},
      {"Everything",
       {n(30), added(8, 8), walls({Arena::kSquare, 15.0}), set(&S::rotational_noise, 0.05), noise_of(0, 0.1),
        kAtInstant}},
  };
}

class EffectsAgree : public testing::TestWithParam<Case> {};

TEST_P(EffectsAgree, BitForBit) {
  System system = rods(GetParam().area_fraction);
  for (const Change& change : GetParam().changes) change(system);
  auto started = Simulation::start(system);
  ASSERT_TRUE(static_cast<bool>(started)) << started.error().message;
  ASSERT_FALSE(started->advance_to(500).has_value());
  EXPECT_EQ(problem(compare(system, GetParam().ticks, GetParam().ticks / 3 + 11)), "");
  EXPECT_EQ(problem(compare_threads(system, 1500)), "");
}

INSTANTIATE_TEST_SUITE_P(Scenes, EffectsAgree, testing::ValuesIn(cases()),
                         [](const auto& one) { return std::string(one.param.name); });

/// A random mix of effects.
System draw_mix() {
  System system = rods(0.2 + 0.05 * *rc::gen::inRange(0, 7));
  system.start = *rc::gen::inRange(0, 2) == 1 ? Start::kRandom : Start::kAligned;
  const auto maybe = [] { return *rc::gen::inRange(0, 2) == 1; };
  if (maybe()) system.impacts = ImpactTime::kAtInstant;
  if (maybe()) system.rod = kBowlingPin;
  if (maybe()) {
    system.rod.spread.length = 0.05 * *rc::gen::inRange(1, 5);
    system.n_rods /= 2;
  }
  if (maybe()) system.added[0] = AddedRods{kPolarRod, *rc::gen::inRange(1, 8)};
  if (maybe()) system.added[1] = AddedRods{kSphere, *rc::gen::inRange(1, 12)};
  if (maybe()) {
    system.walls =
        SideWalls{static_cast<Arena>(*rc::gen::inRange(0, 3)), 14.5, 2.0, {0.1 * *rc::gen::inRange(0, 5), 0.3}};
    system.n_rods /= 2;
  }
  if (system.walls && maybe()) {
    system.walls->arena = maybe() ? Arena::kStadium : Arena::kChannel;
    system.walls->length = 0.5 * *rc::gen::inRange(0, 10);
    system.walls->size = 14.5 - system.walls->length;
  }
  if (system.walls && *rc::gen::inRange(0, 3) == 0) {
    system.walls->arena = maybe() ? Arena::kEllipse : Arena::kWedge;
    system.walls->length = 14.5;
    system.walls->size = 0.5 * *rc::gen::inRange(14, 30);
    system.walls->narrow = *rc::gen::inRange(0, 7);
    system.n_rods /= 2;
  }
  if (*rc::gen::inRange(0, 4) == 0) {
    system.posts = Posts{.diameter = 0.3 * *rc::gen::inRange(1, 8), .contact = {0.1 * *rc::gen::inRange(0, 5), 0.5}};
    system.posts->columns = *rc::gen::inRange(1, 6);
    system.posts->rows = *rc::gen::inRange(1, 6);
    system.n_rods /= 2;
  }
  if (!system.walls && !system.posts && maybe()) {
    system.horizontal_amplitude = 0.02 * *rc::gen::inRange(1, 10);
    system.horizontal_phase = *rc::gen::inRange(-180, 180);
    system.horizontal_angle = *rc::gen::inRange(-180, 180);
  }
  if (*rc::gen::inRange(0, 3) == 0) {
    system.second = SecondVibration{0.002 * *rc::gen::inRange(1, 20), 10.0 * *rc::gen::inRange(1, 80),
                                    1.0 * *rc::gen::inRange(-180, 180)};
  }
  if (*rc::gen::inRange(0, 3) == 0)
    system.lid_motion = LidMotion{0.01 * *rc::gen::inRange(0, 10), 1.0 * *rc::gen::inRange(-180, 180)};
  if (*rc::gen::inRange(0, 3) == 0) {
    system.inclination = *rc::gen::inRange(1, 91);
    system.inclination_angle = *rc::gen::inRange(-180, 180);
  }
  if (maybe()) system.rotational_noise = 0.05;
  if (maybe()) system.added_noise[0] = 0.1 * *rc::gen::inRange(0, 3);
  if (maybe()) system.rod_base.friction = system.rod_lid.friction = 0;
  if (maybe()) system.rod_rod.friction = 0;
  if (maybe()) system.rod_rod.restitution_speed = *rc::gen::inRange(1, 100);
  if (maybe()) system.rod_base.restitution_speed = *rc::gen::inRange(1, 100);
  if (maybe()) system.rod_base.own[Contacts::place(0, 1)].friction = 0.1 * *rc::gen::inRange(0, 5);
  if (maybe()) system.rod_rod.own[Contacts::place(1, 2)].restitution = 0.1 * *rc::gen::inRange(0, 11);
  if (maybe()) system.lid = false;
  system.law = *rc::gen::element(ImpulseLaw::kNewton, ImpulseLaw::kPoisson, ImpulseLaw::kEnergetic);
  system.order = *rc::gen::element(ContactOrder::kSorted, ContactOrder::kReversed, ContactOrder::kShuffled);
  system.amplitude *= 0.2 * *rc::gen::inRange(0, 11);
  system.rod_rod.restitution = 0.1 * *rc::gen::inRange(0, 11);
  system.gap = 1.0 + 0.2 * *rc::gen::inRange(0, 10);
  system.dt = 1e-6 * *rc::gen::inRange(1, 41);
  system.seed = static_cast<std::uint64_t>(*rc::gen::inRange(1, 1000));
  return system;
}

TEST(EffectsAgreeProperty, RandomMixes) {
  int n_all = 0, n_in_full = 0;  // those that found no difference because there was little to compare must stay rare
  EXPECT_TRUE(rc::check("both steppers agree", [&] {
    const System system = draw_mix();
    const test::Compared compared = compare(system, 3000, *rc::gen::inRange<Tick>(1, 3000));
    RC_PRE(compared.fits);  // or drawn again
    n_all += 1;
    n_in_full += compared.in_full;
    RC_ASSERT(compared.difference == "");
    RC_ASSERT(compare_threads(system, 300).difference == "");
  }));
  EXPECT_GE(n_all, 90);
  EXPECT_GE(n_in_full, 0.9 * n_all);
}

}  // namespace
}  // namespace shaken
