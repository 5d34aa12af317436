// SPDX-License-Identifier: MIT
// Both steppers give the same trajectory, bit by bit, with each effect that a scene may call for and with mixes of
// them.
#include <gtest/gtest.h>
#include <rapidcheck.h>

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

/// 40 rods of 3 mm in a narrow gap that bounce well, with a tick of 50 us.
void coarse_and_bouncy(System& system) {
  system.rod = {.length = 3.0, .n_beads = 11};
  system.n_rods = 40;
  system.box_side = std::sqrt(40 * make_species(system.rod).area / 0.8);
  system.gap = 1.1;
  system.impacts = ImpactTime::kAtInstant;
  system.rod_rod.restitution = 0.9;
  system.rod_base.restitution = system.rod_lid.restitution = 0.8;
  system.dt = 50e-6;
}

struct Case {
  const char* name;
  void (*set)(System&);
  double area_fraction = 0.5;
  Tick ticks = 12000;

  friend void PrintTo(const Case& one, std::ostream* out) { *out << one.name; }
};

std::string name_of(const testing::TestParamInfo<Case>& info) { return info.param.name; }

class EffectsAgree : public testing::TestWithParam<Case> {};

TEST_P(EffectsAgree, BitForBit) {
  System system = rods(GetParam().area_fraction);
  GetParam().set(system);
  auto started = Simulation::start(system);
  ASSERT_TRUE(static_cast<bool>(started)) << started.error().message;
  ASSERT_FALSE(started->advance_to(500).has_value());
  EXPECT_EQ(problem(compare(system, GetParam().ticks, GetParam().ticks / 3 + 11)), "");
  EXPECT_EQ(problem(compare_threads(system, 1500)), "");
}

INSTANTIATE_TEST_SUITE_P(
    Scenes, EffectsAgree,
    testing::Values(Case{"AtInstant", [](System& s) { s.impacts = ImpactTime::kAtInstant; }},
                    Case{"AtInstantDense", [](System& s) { s.impacts = ImpactTime::kAtInstant; }, 0.85},
                    Case{"AtInstantLongTicks",
                         [](System& s) {
                           s.impacts = ImpactTime::kAtInstant;
                           s.dt = 40e-6;
                         },
                         0.75, 4000},
                    // coarse and bouncy: displaced rods overlap and recede, and are hit by plates that nearly cancel
                    Case{"AtInstantCoarseBouncy",
                         [](System& s) {
                           coarse_and_bouncy(s);
                           s.seed = 9;
                         },
                         0.8, 5000},
                    Case{"AtInstantCoarseBouncyAgain",
                         [](System& s) {
                           coarse_and_bouncy(s);
                           s.seed = 11;
                         },
                         0.8, 5000},
                    Case{"AtInstantCoarseBouncySweeps",
                         [](System& s) {
                           coarse_and_bouncy(s);
                           s.seed = 2;
                           s.solver_sweeps = 2;
                         },
                         0.8, 7000},
                    Case{"AtInstantFrictionlessSweeps",
                         [](System& s) {
                           s.impacts = ImpactTime::kAtInstant;
                           s.rod_rod.friction = s.rod_base.friction = s.rod_lid.friction = 0;
                           s.solver_sweeps = 3;
                         },
                         0.7},
                    Case{"AtInstantElastic",
                         [](System& s) {
                           s.impacts = ImpactTime::kAtInstant;
                           s.rod_rod = s.rod_base = s.rod_lid = {0.0, 1.0};
                           s.gap = 3;
                         },
                         0.4},
                    Case{"Spheres",
                         [](System& s) {
                           s.added[0] = AddedRods{kSphere, 30};
                         }},
                    Case{"PolarAmongApolar",
                         [](System& s) {
                           s.n_rods = 50;
                           s.added[0] = AddedRods{kPolarRod, 12};
                         },
                         0.5},
                    Case{"PolarAlone", [](System& s) { s.rod = kPolarRod, s.n_rods = 60; }},
                    Case{"PolarInAWideGap",
                         [](System& s) {
                           s.rod = kPolarRod, s.n_rods = 40, s.gap = 4;
                           s.start = Start::kRandom;
                         }},
                    Case{"FreeProfile", [](System& s) { s.rod = kBowlingPin, s.n_rods = 60; }},
                    Case{"ThreeKinds",
                         [](System& s) {
                           s.n_rods = 50;
                           s.added = {AddedRods{kPolarRod, 10}, AddedRods{kSphere, 20}};
                         }},
                    Case{"Polydisperse",
                         [](System& s) {
                           s.n_rods = 50;
                           s.rod.spread = {.length = 0.15, .end_diameter = 0.3};
                           s.added[0] = AddedRods{kSphere, 20};
                           s.added[0]->rod.spread.length = 0.2;
                           s.rod_rod.own[Contacts::place(0, 1)].friction = 0.5;
                         }},
                    Case{"VeryDifferentSizes",
                         [](System& s) {
                           s.n_rods = 8;
                           s.rod = {.length = 7.0, .mid_diameter = 1.0, .n_beads = 23};
                           s.added[0] = AddedRods{{.length = 0.5, .mid_diameter = 0.5, .n_beads = 1}, 40};
                         }},
                    Case{"Disc",
                         [](System& s) {
                           s.walls = SideWalls{Arena::kDisc, 14.0};
                           s.n_rods = 50;
                         }},
                    Case{"Square",
                         [](System& s) {
                           s.walls = SideWalls{Arena::kSquare, 14.0, 1.0, {0.3, 0.5}};
                           s.n_rods = 60;
                         }},
                    Case{"Annulus",
                         [](System& s) {
                           s.walls = SideWalls{Arena::kAnnulus, 14.5, 4.0};
                           s.n_rods = 30;
                           s.start = Start::kRandom;
                         }},
                    Case{"Stadium",
                         [](System& s) {
                           s.walls = SideWalls{.arena = Arena::kStadium, .size = 9, .contact = {0.3, 0.5}, .length = 6};
                           s.n_rods = 40;
                         }},
                    Case{"PolarInAStadium",
                         [](System& s) {
                           s.walls = SideWalls{.arena = Arena::kStadium, .size = 8, .length = 7};
                           s.rod = kPolarRod;
                           s.n_rods = 20;
                           s.start = Start::kRandom;
                           s.impacts = ImpactTime::kAtInstant;
                         }},
                    Case{"Ellipse",
                         [](System& s) {
                           s.walls = SideWalls{.arena = Arena::kEllipse, .size = 10, .contact = {0.3, 0.5}};
                           s.walls->length = 14;
                           s.n_rods = 35;
                         }},
                    Case{"PolarInAnEllipse",
                         [](System& s) {
                           s.walls = SideWalls{.arena = Arena::kEllipse, .size = 7, .length = 14.5};
                           s.rod = kPolarRod;
                           s.n_rods = 12;
                           s.start = Start::kRandom;
                           s.impacts = ImpactTime::kAtInstant;
                         }},
                    Case{"Wedge",
                         [](System& s) {
                           s.walls = SideWalls{.arena = Arena::kWedge, .size = 14, .contact = {0.3, 0.5}, .length = 14};
                           s.n_rods = 25;
                         }},
                    Case{"PolarInABluntWedge",
                         [](System& s) {
                           s.walls = SideWalls{.arena = Arena::kWedge, .size = 9, .length = 14, .narrow = 1};
                           s.rod = kPolarRod;
                           s.n_rods = 12;
                           s.start = Start::kRandom;
                           s.impacts = ImpactTime::kAtInstant;
                         }},
                    Case{"Channel",
                         [](System& s) {
                           s.walls = SideWalls{.arena = Arena::kChannel, .size = 11, .contact = {0.3, 0.5}};
                           s.box_aspect = 0.75;
                           s.n_rods = 70;
                         }},
                    Case{"PinsInANarrowChannel",
                         [](System& s) {
                           s.walls = SideWalls{.arena = Arena::kChannel, .size = 3.5};
                           s.rod = kBowlingPin;
                           s.n_rods = 12;
                           s.start = Start::kRandom;
                         }},
                    Case{"PolarInAnAnnulus",
                         [](System& s) {
                           s.walls = SideWalls{Arena::kAnnulus, 14.5, 4.0};
                           s.rod = kPolarRod;
                           s.n_rods = 30;
                           s.start = Start::kRandom;
                         }},
                    Case{"DiscAtInstant",
                         [](System& s) {
                           s.walls = SideWalls{Arena::kDisc, 14.0};
                           s.impacts = ImpactTime::kAtInstant;
                           s.n_rods = 50;
                         }},
                    Case{"Posts",
                         [](System& s) {
                           s.posts = Posts{.diameter = 1.5, .columns = 3, .rows = 3, .contact = {0.3, 0.6}};
                           s.n_rods = 50;
                         }},
                    Case{"PolarAmongManyPosts",
                         [](System& s) {
                           s.posts = Posts{.diameter = 0.3, .columns = 12, .rows = 9};
                           s.rod = kPolarRod;
                           s.n_rods = 8;
                           s.start = Start::kRandom;
                         }},
                    Case{"PinsByATrap",
                         [](System& s) {
                           s.posts = Posts{.diameter = 1.0, .contact = {0.2, 0.5}};
                           for (int k = 0; k < 6; ++k) {
                             s.posts->places.emplace_back(0.2 + 0.8 * k, 8 + 0.6 * k);
                             if (k > 0) s.posts->places.emplace_back(0.2 + 0.8 * k, 8 - 0.6 * k);
                           }
                           s.rod = kBowlingPin;
                           s.n_rods = 40;
                           s.start = Start::kRandom;
                           s.impacts = ImpactTime::kAtInstant;
                         }},
                    Case{"PostsInADisc",
                         [](System& s) {
                           s.walls = SideWalls{Arena::kDisc, 14.0};
                           s.posts = Posts{.diameter = 1.2, .columns = 4, .rows = 4};
                           s.n_rods = 20;
                           s.added = {AddedRods{kPolarRod, 8}, AddedRods{kSphere, 10}};
                           s.posts->contact.own[Contacts::place(0, 2)] = {0.5, 0.9, {}};
                           s.start = Start::kRandom;
                         }},
                    Case{"PlanarPostsInAChannel",
                         [](System& s) {
                           s.base = s.lid = false;
                           s.gravity = 0;
                           s.rod_rod = {0.0, 0.95};
                           s.walls = SideWalls{.arena = Arena::kChannel, .size = 11, .contact = {0.0, 0.95}};
                           s.posts = Posts{.diameter = 2.0, .columns = 4, .rows = 2, .contact = {0.0, 0.95}};
                           s.box_aspect = 0.75;
                           s.n_rods = 30;
                         }},
                    Case{"Noise", [](System& s) { s.rotational_noise = 0.1; }},
                    Case{"NoiseOfSpecies",
                         [](System& s) {
                           s.n_rods = 20;
                           s.added = {AddedRods{kPolarRod, 15}, AddedRods{kSphere, 12}};
                           s.added_noise[0] = 0.2;  // the others go by lanes
                         }},
                    Case{"NoiseOfAllSpeciesButOneWithSizes",
                         [](System& s) {
                           s.n_rods = 25;
                           s.rod.spread = {.length = 0.15, .end_diameter = 0.1};
                           s.added = {std::nullopt, AddedRods{kPolarRod, 15}};
                           s.rotational_noise = 0.1;
                           s.added_noise[1] = 0.0;
                         }},
                    Case{"NoiseFrictionlessAtInstant",
                         [](System& s) {
                           s.rotational_noise = 0.1;
                           s.rod_base.friction = s.rod_lid.friction = 0;
                           s.impacts = ImpactTime::kAtInstant;
                         }},
                    Case{"HorizontalVibration",
                         [](System& s) {
                           s.horizontal_amplitude = 0.05;
                           s.horizontal_phase = 70;
                           s.horizontal_angle = 30;
                         }},
                    Case{"HorizontalVibrationOfStickyPlatesAtInstant",
                         [](System& s) {
                           s.amplitude = 0.02;
                           s.horizontal_amplitude = 0.1;
                           s.horizontal_phase = -90;
                           s.rod_base.friction = s.rod_lid.friction = 1;
                           s.law = ImpulseLaw::kEnergetic;
                           s.impacts = ImpactTime::kAtInstant;
                         }},
                    Case{"SecondVibration",
                         [](System& s) {
                           s.second = SecondVibration{0.02, 317.0, 40.0};
                         }},
                    Case{"SecondVibrationAtInstant",
                         [](System& s) {
                           s.second = SecondVibration{0.03, 400.0, 90.0};
                           s.impacts = ImpactTime::kAtInstant;
                         }},
                    Case{"LidAtRest", [](System& s) { s.lid_motion = LidMotion{}; }},
                    Case{"LidByItselfAtInstant",
                         [](System& s) {
                           s.lid_motion = LidMotion{0.08, 150.0};
                           s.second = SecondVibration{0.01, 317.0, 0.0};
                           s.rotational_noise = 0.1;
                           s.impacts = ImpactTime::kAtInstant;
                         }},
                    Case{"LidAloneMoves",
                         [](System& s) {
                           s.amplitude = 0;
                           s.lid_motion = LidMotion{0.1, 0.0};
                         },
                         0.5, 3000},
                    Case{"Inclined",
                         [](System& s) {
                           s.inclination = 3;
                           s.inclination_angle = 40;
                         }},
                    Case{"SteepInAChannelWithPosts",
                         [](System& s) {
                           s.inclination = 60;  // steeper than a scene may have it, and so harder
                           s.walls = SideWalls{.arena = Arena::kChannel, .size = 11, .contact = {0.1, 0.5}};
                           s.posts = Posts{.diameter = 2.0, .columns = 4, .rows = 2, .contact = {0.1, 0.5}};
                           s.box_aspect = 0.75;
                           s.n_rods = 30;
                         }},
                    Case{"SteepInADiscAtInstant",
                         [](System& s) {
                           s.inclination = 90;
                           s.inclination_angle = -70;
                           s.walls = SideWalls{Arena::kDisc, 14.0};
                           s.n_rods = 30;
                           s.impacts = ImpactTime::kAtInstant;
                         }},
                    Case{"SteepWithoutFriction",
                         [](System& s) {
                           s.inclination = 45;
                           s.rod_base.friction = s.rod_lid.friction = 0;
                         }},
                    Case{"RestitutionOfSpeed",
                         [](System& s) {
                           s.rod_rod.restitution_speed = 20;
                           s.rod_base.restitution_speed = s.rod_lid.restitution_speed = 60;
                         }},
                    Case{"RestitutionOfSpeedFrictionlessAtRest",
                         [](System& s) {
                           s.amplitude = 0;
                           s.rod_base = s.rod_lid = {0.0, 0.5};
                           s.rod_base.restitution_speed = s.rod_lid.restitution_speed = 5;
                         },
                         0.5, 3000},
                    Case{"RestitutionOfSpeedByTheEnergeticLaw",
                         [](System& s) {
                           s.law = ImpulseLaw::kEnergetic;
                           s.impacts = ImpactTime::kAtInstant;
                           s.rod_rod = {0.5, 0.6};
                           s.rod_rod.restitution_speed = s.rod_base.restitution_speed = 10;
                         }},
                    Case{"SpeciesOfTheirOwn",
                         [](System& s) {
                           s.n_rods = 20;
                           s.added = {AddedRods{kPolarRod, 8}, AddedRods{kSphere, 12}};
                           s.walls = SideWalls{Arena::kDisc, 15.0};
                           s.rod_rod.own[Contacts::place(0, 1)] = {0.5, 0.9, {}};
                           s.rod_rod.own[Contacts::place(2, 2)].friction = 0.0;
                           s.rod_base.own[Contacts::place(0, 1)].friction = 0.0;  // the others go by lanes
                           s.rod_lid.own[Contacts::place(0, 2)].restitution_speed = 30.0;
                           s.walls->contact.own[Contacts::place(0, 2)] = {1.0, 0.0, {}};
                         }},
                    Case{"NoLid", [](System& s) { s.lid = false; }},
                    Case{"Planar",
                         [](System& s) {
                           s.base = s.lid = false;
                           s.gravity = 0;
                           s.rod_rod = {0.0, 1.0};
                         },
                         0.6},
                    Case{"PlanarPolarInADisc",
                         [](System& s) {
                           s.base = s.lid = false;
                           s.gravity = 0;
                           s.rod_rod = {0.05, 0.9};
                           s.walls = SideWalls{Arena::kDisc, 14.0, 1.0, {0.0, 0.9}};
                           s.rod = kPolarRod;
                           s.n_rods = 30;
                         }},
                    Case{"Everything",
                         [](System& s) {
                           s.n_rods = 30;
                           s.added = {AddedRods{kPolarRod, 8}, AddedRods{kSphere, 8}};
                           s.walls = SideWalls{Arena::kSquare, 15.0};
                           s.rotational_noise = 0.05;
                           s.added_noise[0] = 0.1;
                           s.impacts = ImpactTime::kAtInstant;
                         }}),
    name_of);

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
  system.gap = 1.0 + 0.2 * *rc::gen::inRange(0, 10);
  system.dt = 1e-6 * *rc::gen::inRange(1, 41);
  system.seed = static_cast<std::uint64_t>(*rc::gen::inRange(1, 1000));
  return system;
}

TEST(EffectsAgreeProperty, RandomMixes) {
  test::Tally tally;
  EXPECT_TRUE(rc::check("both steppers agree", [&] {
    const System system = draw_mix();
    const test::Compared compared = compare(system, 3000, *rc::gen::inRange<Tick>(1, 3000));
    RC_PRE(compared.fits);  // or drawn again
    tally.add(compared);
    RC_ASSERT(compared.difference == "");
    RC_ASSERT(compare_threads(system, 300).difference == "");
  }));
  EXPECT_GE(tally.n_all(), 90);
  EXPECT_GE(tally.part_in_full(), 0.9);
}

}  // namespace
}  // namespace shaken
