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
Scene rods(double area_fraction) {
  Scene scene;
  scene.rod = {.length = 2.5, .n_beads = 9};
  scene.box_side = 16;
  scene.n_rods = static_cast<int>(area_fraction * 256 / make_species(scene.rod).area);
  return scene;
}

const RodShape kPolarRod{.length = 3.0, .mid_diameter = 0.9, .n_beads = 11, .profile = Profile::kPolar};
const RodShape kSphere{.length = 0.8, .n_beads = 1};
const RodShape kBowlingPin{.length = 2.5, .bead_diameters{0.9, 0.8, 0.6, 0.4, 0.5, 0.7, 0.5, 0.3}};

/// 40 rods of 3 mm in a narrow gap that bounce well, with a tick of 50 us.
void coarse_and_bouncy(Scene& scene) {
  scene.rod = {.length = 3.0, .n_beads = 11};
  scene.n_rods = 40;
  scene.box_side = std::sqrt(40 * make_species(scene.rod).area / 0.8);
  scene.gap = 1.1;
  scene.impacts = ImpactTime::kAtInstant;
  scene.rod_rod.restitution = 0.9;
  scene.rod_base.restitution = scene.rod_lid.restitution = 0.8;
  scene.dt = 50e-6;
}

struct Case {
  const char* name;
  void (*set)(Scene&);
  double area_fraction = 0.5;
  Tick ticks = 12000;
};

std::string name_of(const testing::TestParamInfo<Case>& info) { return info.param.name; }

class EffectsAgree : public testing::TestWithParam<Case> {};

TEST_P(EffectsAgree, BitForBit) {
  Scene scene = rods(GetParam().area_fraction);
  GetParam().set(scene);
  auto started = Simulation::start(scene);
  ASSERT_TRUE(static_cast<bool>(started)) << started.error().message;
  ASSERT_FALSE(started->advance_to(500).has_value());
  EXPECT_EQ(problem(compare(scene, GetParam().ticks, GetParam().ticks / 3 + 11)), "");
  EXPECT_EQ(problem(compare_threads(scene, 1500)), "");
}

INSTANTIATE_TEST_SUITE_P(
    Scenes, EffectsAgree,
    testing::Values(Case{"AtInstant", [](Scene& s) { s.impacts = ImpactTime::kAtInstant; }},
                    Case{"AtInstantDense", [](Scene& s) { s.impacts = ImpactTime::kAtInstant; }, 0.85},
                    Case{"AtInstantLongTicks",
                         [](Scene& s) {
                           s.impacts = ImpactTime::kAtInstant;
                           s.dt = 40e-6;
                         },
                         0.75, 4000},
                    // coarse and bouncy: displaced rods overlap and recede, and are hit by plates that nearly cancel
                    Case{"AtInstantCoarseBouncy",
                         [](Scene& s) {
                           coarse_and_bouncy(s);
                           s.seed = 9;
                         },
                         0.8, 5000},
                    Case{"AtInstantCoarseBouncyAgain",
                         [](Scene& s) {
                           coarse_and_bouncy(s);
                           s.seed = 11;
                         },
                         0.8, 5000},
                    Case{"AtInstantCoarseBouncySweeps",
                         [](Scene& s) {
                           coarse_and_bouncy(s);
                           s.seed = 2;
                           s.solver_sweeps = 2;
                         },
                         0.8, 7000},
                    Case{"AtInstantFrictionlessSweeps",
                         [](Scene& s) {
                           s.impacts = ImpactTime::kAtInstant;
                           s.rod_rod.friction = s.rod_base.friction = s.rod_lid.friction = 0;
                           s.solver_sweeps = 3;
                         },
                         0.7},
                    Case{"AtInstantElastic",
                         [](Scene& s) {
                           s.impacts = ImpactTime::kAtInstant;
                           s.rod_rod = s.rod_base = s.rod_lid = {0.0, 1.0};
                           s.gap = 3;
                         },
                         0.4},
                    Case{"Spheres",
                         [](Scene& s) {
                           s.added[0] = AddedRods{kSphere, 30};
                         }},
                    Case{"PolarAmongApolar",
                         [](Scene& s) {
                           s.n_rods = 50;
                           s.added[0] = AddedRods{kPolarRod, 12};
                         },
                         0.5},
                    Case{"PolarAlone", [](Scene& s) { s.rod = kPolarRod, s.n_rods = 60; }},
                    Case{"PolarInAWideGap",
                         [](Scene& s) {
                           s.rod = kPolarRod, s.n_rods = 40, s.gap = 4;
                           s.start = Start::kRandom;
                         }},
                    Case{"FreeProfile", [](Scene& s) { s.rod = kBowlingPin, s.n_rods = 60; }},
                    Case{"ThreeKinds",
                         [](Scene& s) {
                           s.n_rods = 50;
                           s.added = {AddedRods{kPolarRod, 10}, AddedRods{kSphere, 20}};
                         }},
                    Case{"VeryDifferentSizes",
                         [](Scene& s) {
                           s.n_rods = 8;
                           s.rod = {.length = 7.0, .mid_diameter = 1.0, .n_beads = 23};
                           s.added[0] = AddedRods{{.length = 0.5, .mid_diameter = 0.5, .n_beads = 1}, 40};
                         }},
                    Case{"Disc",
                         [](Scene& s) {
                           s.walls = SideWalls{Arena::kDisc, 14.0};
                           s.n_rods = 50;
                         }},
                    Case{"Square",
                         [](Scene& s) {
                           s.walls = SideWalls{Arena::kSquare, 14.0, 1.0, {0.3, 0.5}};
                           s.n_rods = 60;
                         }},
                    Case{"Annulus",
                         [](Scene& s) {
                           s.walls = SideWalls{Arena::kAnnulus, 14.5, 4.0};
                           s.n_rods = 30;
                           s.start = Start::kRandom;
                         }},
                    Case{"DiscAtInstant",
                         [](Scene& s) {
                           s.walls = SideWalls{Arena::kDisc, 14.0};
                           s.impacts = ImpactTime::kAtInstant;
                           s.n_rods = 50;
                         }},
                    Case{"Noise", [](Scene& s) { s.rotational_noise = 0.1; }},
                    Case{"NoiseFrictionlessAtInstant",
                         [](Scene& s) {
                           s.rotational_noise = 0.1;
                           s.rod_base.friction = s.rod_lid.friction = 0;
                           s.impacts = ImpactTime::kAtInstant;
                         }},
                    Case{"NoLid", [](Scene& s) { s.lid = false; }},
                    Case{"Planar",
                         [](Scene& s) {
                           s.base = s.lid = false;
                           s.gravity = 0;
                           s.rod_rod = {0.0, 1.0};
                         },
                         0.6},
                    Case{"PlanarPolarInADisc",
                         [](Scene& s) {
                           s.base = s.lid = false;
                           s.gravity = 0;
                           s.rod_rod = {0.05, 0.9};
                           s.walls = SideWalls{Arena::kDisc, 14.0, 1.0, {0.0, 0.9}};
                           s.rod = kPolarRod;
                           s.n_rods = 30;
                         }},
                    Case{"Everything",
                         [](Scene& s) {
                           s.n_rods = 30;
                           s.added = {AddedRods{kPolarRod, 8}, AddedRods{kSphere, 8}};
                           s.walls = SideWalls{Arena::kSquare, 15.0};
                           s.rotational_noise = 0.05;
                           s.impacts = ImpactTime::kAtInstant;
                         }}),
    name_of);

/// A random mix of effects.
Scene draw_mix() {
  Scene scene = rods(0.2 + 0.05 * *rc::gen::inRange(0, 7));
  scene.start = *rc::gen::inRange(0, 2) == 1 ? Start::kRandom : Start::kAligned;
  const auto maybe = [] { return *rc::gen::inRange(0, 2) == 1; };
  if (maybe()) scene.impacts = ImpactTime::kAtInstant;
  if (maybe()) scene.rod = kBowlingPin;
  if (maybe()) scene.added[0] = AddedRods{kPolarRod, *rc::gen::inRange(1, 8)};
  if (maybe()) scene.added[1] = AddedRods{kSphere, *rc::gen::inRange(1, 12)};
  if (maybe()) {
    scene.walls =
        SideWalls{static_cast<Arena>(*rc::gen::inRange(0, 3)), 14.5, 2.0, {0.1 * *rc::gen::inRange(0, 5), 0.3}};
    scene.n_rods /= 2;
  }
  if (maybe()) scene.rotational_noise = 0.05;
  if (maybe()) scene.rod_base.friction = scene.rod_lid.friction = 0;
  if (maybe()) scene.rod_rod.friction = 0;
  if (maybe()) scene.lid = false;
  scene.gap = 1.0 + 0.2 * *rc::gen::inRange(0, 10);
  scene.dt = 1e-6 * *rc::gen::inRange(1, 41);
  scene.seed = static_cast<std::uint64_t>(*rc::gen::inRange(1, 1000));
  return scene;
}

TEST(EffectsAgreeProperty, RandomMixes) {
  test::Tally tally;
  EXPECT_TRUE(rc::check("both steppers agree", [&] {
    const Scene scene = draw_mix();
    const test::Compared compared = compare(scene, 3000, *rc::gen::inRange<Tick>(1, 3000));
    RC_PRE(compared.fits);  // or drawn again
    tally.add(compared);
    RC_ASSERT(compared.difference == "");
    RC_ASSERT(compare_threads(scene, 300).difference == "");
  }));
  EXPECT_GE(tally.n_all(), 90);
  EXPECT_GE(tally.part_in_full(), 0.9);
}

}  // namespace
}  // namespace shaken
