// Quantities that follow from each other: any sufficient set may be given, too many must agree.
#include <cmath>

#include "scene/keys/derived.h"
#include "sim/rod/species.h"
#include "tests/unit/scene/scene_support.h"

namespace shaken::scene {
namespace {

constexpr double kAmplitudeOf7 = 7 * 9810 / (4 * kPi * kPi * 200 * 200);  // [mm]

TEST(Shaking, AnyTwoOfGammaAmplitudeAndFrequencyGiveTheThird) {
  EXPECT_DOUBLE_EQ(plan_of(R"({"plates": {"gamma": 3.5}})").system.amplitude, kAmplitudeOf7 / 2);
  EXPECT_DOUBLE_EQ(plan_of(R"({"plates": {"gamma": 7, "frequency": 100}})").system.amplitude, kAmplitudeOf7 * 4);
  EXPECT_DOUBLE_EQ(plan_of(R"({"plates": {"frequency": 100}})").system.amplitude, kAmplitudeOf7 * 4);
  EXPECT_DOUBLE_EQ(plan_of(R"({"gravity": "19.62 m/s^2"})").system.amplitude, kAmplitudeOf7 * 2);
  EXPECT_DOUBLE_EQ(*gamma_of(plan_of(R"({"plates": {"amplitude": "0.1 mm"}})").system), 0.7 / kAmplitudeOf7);

  const System by_both = plan_of(R"({"plates": {"gamma": 14, "amplitude": 0.1}})").system;
  EXPECT_DOUBLE_EQ(by_both.frequency, 200 * std::sqrt(2 * kAmplitudeOf7 / 0.1));
  EXPECT_DOUBLE_EQ(*gamma_of(by_both), 14);

  EXPECT_EQ(plan_of(R"({"plates": {"gamma": 0}})").system.amplitude, 0);
}

TEST(Shaking, AllThreeMustAgree) {
  plan_of(R"({"plates": {"gamma": 7, "amplitude": 0.04348578, "frequency": 200}})");
  EXPECT_EQ(problem_of(R"({"plates": {"gamma": 7, "amplitude": "43.49 um", "frequency": 200}})"),
            "run.json:1:22: /plates/gamma: plates.gamma 7 contradicts plates.amplitude 0.04349 mm at plates.frequency "
            "200 Hz and gravity 9.81 m/s^2, which make 7.000678416; remove one");
  EXPECT_EQ(problem_of(R"({"plates": {"gamma": 0, "amplitude": 0.1}})").substr(0, 64),
            "run.json:1:22: /plates/gamma: plates.gamma 0 contradicts plates.");
}

TEST(Shaking, WhatFollowsMustBePossible) {
  EXPECT_EQ(problem_of(R"({"plates": {"gamma": 200, "frequency": 0.5}})"),
            "run.json:1:22: /plates/gamma: plates.gamma 200 and plates.frequency 0.5 Hz make plates.amplitude "
            "198792.1623 mm, outside [0, 10] mm");
}

TEST(Shaking, WithoutGravityIsByAmplitudeAndFrequency) {
  const System shaken = plan_of(R"({"gravity": 0, "plates": {"amplitude": 0.05, "frequency": 100}})").system;
  EXPECT_EQ(shaken.gravity, 0);
  EXPECT_EQ(shaken.amplitude, 0.05);
  EXPECT_FALSE(gamma_of(shaken).has_value());
  EXPECT_EQ(plan_of(R"({"gravity": 0, "plates": {"amplitude": 0}})").system.amplitude, 0);
  EXPECT_EQ(plan_of(R"({"gravity": "0 m/s^2", "plates": {"gamma": 0}})").system.amplitude, 0);

  EXPECT_EQ(problem_of(R"({"gravity": 0})"),
            "run.json:1:13: /gravity: without gravity plates.gamma has no meaning; give plates.amplitude (0: plates at "
            "rest) and plates.frequency");
  EXPECT_EQ(problem_of(R"({"gravity": 0, "plates": {"gamma": 7}})"),
            "run.json:1:36: /plates/gamma: plates.gamma compares the plates with gravity, which is 0; give "
            "plates.amplitude and plates.frequency instead");
  EXPECT_EQ(problem_of(R"({"gravity": 0, "plates": {"amplitude": 0.05}})"),
            "run.json:1:13: /gravity: without gravity plates.amplitude 0.05 mm does not tell plates.frequency; give "
            "that too");
  EXPECT_EQ(problem_of(R"({"gravity": 0, "plates": {"amplitude": 0.05, "gamma": 0, "frequency": 100}})"),
            "run.json:1:55: /plates/gamma: plates.gamma 0 contradicts plates.amplitude 0.05 mm; remove one");
}

TEST(Packing, AnyTwoOfFractionCountAndSideGiveTheThird) {
  const Species rod = make_species(plan_of("{}").system.rod);
  const System by_fraction = plan_of(R"({"rods": {"area_fraction": 0.5}, "box": {"side": 40}})").system;
  EXPECT_EQ(by_fraction.n_rods, std::round(0.5 * 1600 / rod.area));

  const System by_count = plan_of(R"({"rods": {"count": 300}, "box": {"side": 40}})").system;
  EXPECT_EQ(by_count.n_rods, 300);
  EXPECT_EQ(by_count.box_side, 40);
  EXPECT_DOUBLE_EQ(area_fraction_of(by_count), 300 * rod.area / 1600);

  const System by_both = plan_of(R"({"rods": {"count": 300, "area_fraction": 0.6}})").system;
  EXPECT_DOUBLE_EQ(by_both.box_side, std::sqrt(300 * rod.area / 0.6));
  EXPECT_EQ(plan_of(R"({"rods": {"count": 300}})").system.box_side, 83.73);
}

TEST(Packing, OfARectangle) {
  const Species rod = make_species(plan_of("{}").system.rod);
  const System strip = plan_of(R"({"rods": {"area_fraction": 0.5}, "box": {"side": 21, "aspect": 6}})").system;
  EXPECT_EQ(strip.box(), Box(21, 126));
  EXPECT_EQ(strip.n_rods, std::round(0.5 * 21 * 126 / rod.area));
  const System by_both = plan_of(R"({"rods": {"count": 300, "area_fraction": 0.6}, "box": {"aspect": 0.25}})").system;
  EXPECT_NEAR(by_both.box().area(), 300 * rod.area / 0.6, 1e-9);
  EXPECT_DOUBLE_EQ(by_both.box().y(), by_both.box().x() / 4);
  EXPECT_EQ(problem_of(R"({"box": {"side": 21, "aspect": 0.4}})"),
            "run.json:1:18: /box/side: a periodic box of 21 mm by 8.4 mm is too small for rods of 4.5 mm: at least "
            "9.9 mm");
  EXPECT_EQ(problem_of(R"({"box": {"side": 100, "aspect": 30}})"),
            "run.json:1:33: /box/aspect: a box of 100 mm by 3000 mm: sides are 1 mm to 2000 mm long");
  EXPECT_EQ(problem_of(R"({"box": {"aspect": 2}, "walls": {}})"),
            "run.json:1:20: /box/aspect: an arena lies in the middle of a square box, unless it is a "
            "channel: remove box.aspect or walls");
  EXPECT_EQ(problem_of(R"({"box": {"aspect": 2}, "measure": {"frank": {}}})"),
            "run.json:1:45: /measure/frank: measure.frank is of square boxes only; remove it or box.aspect");
}

TEST(Packing, AllThreeMustAgree) {
  const int count = plan_of(R"({"rods": {"area_fraction": 0.5}, "box": {"side": 40}})").system.n_rods;
  const std::string counted = "rods.count=" + std::to_string(count);
  plan_of(R"({"rods": {"area_fraction": 0.5}, "box": {"side": 40}})", {counted});
  EXPECT_EQ(problem_of(R"({"rods": {"area_fraction": 0.5, "count": 300}, "box": {"side": 40}})"),
            "run.json:1:28: /rods/area_fraction: rods.area_fraction 0.5 contradicts rods.count 300 in box.side 40 mm, "
            "which make 0.4673192449; remove one");
}

TEST(Packing, FractionAndCountMakeTheArena) {
  const double area = 300 * make_species(plan_of("{}").system.rod).area / 0.5;
  const System disc = plan_of(R"({"rods": {"count": 300, "area_fraction": 0.5}, "walls": {}})").system;
  EXPECT_EQ(disc.n_rods, 300);
  EXPECT_DOUBLE_EQ(disc.walls->size, std::sqrt(4 * area / kPi));
  EXPECT_DOUBLE_EQ(disc.box_side, disc.walls->size + 1.0);
  EXPECT_NEAR(area_fraction_of(disc), 0.5, 1e-12);
  const System square =
      plan_of(R"({"rods": {"count": 300, "area_fraction": 0.5}, "walls": {"arena": "square"}})").system;
  EXPECT_DOUBLE_EQ(square.walls->size, std::sqrt(area));
  const System annulus =
      plan_of(R"({"rods": {"count": 300, "area_fraction": 0.5}, "walls": {"arena": "annulus", "inner": 15}})").system;
  EXPECT_NEAR(area_fraction_of(annulus), 0.5, 1e-12);
  EXPECT_EQ(annulus.walls->inner, 15);
  // of several species it is the first that says so
  const System mixed =
      plan_of(R"({"rods": {"count": 300, "area_fraction": 0.5}, "rods_2": {"count": 20}, "walls": {}})").system;
  EXPECT_EQ(mixed.walls->size, disc.walls->size);
}

TEST(Packing, AStadiumIsTwiceAsLongAsWideUnlessItsLengthIsGiven) {
  const auto stadium = [](const std::string& walls, const std::string& rest = "") {
    return plan_of(R"({"walls": {"arena": "stadium")" + walls + "}" + rest + "}").system;
  };
  const System whole = stadium("");
  EXPECT_EQ(whole.box_side, 83.73);
  EXPECT_DOUBLE_EQ(whole.walls->size, 82.73 / 2);
  EXPECT_EQ(whole.walls->length, whole.walls->size);
  const System by_size = stadium(R"(, "size": 20)");
  EXPECT_EQ(by_size.walls->length, 20);
  EXPECT_DOUBLE_EQ(by_size.box_side, 41);
  const System by_both = stadium(R"(, "size": 20, "length": 5)");
  EXPECT_EQ(by_both.walls->length, 5);
  EXPECT_DOUBLE_EQ(by_both.box_side, 26);
  EXPECT_DOUBLE_EQ(stadium(R"(, "length": 12.73)").walls->size, 70);
  EXPECT_EQ(stadium(R"(, "length": 0)").walls->length, 0) << "a disc";
  for (const char* length : {"", R"(, "length": 30)"}) {
    const System by_count = stadium(length, R"(, "rods": {"count": 300, "area_fraction": 0.5})");
    EXPECT_NEAR(area_fraction_of(by_count), 0.5, 1e-12);
    EXPECT_EQ(by_count.walls->length, *length ? 30 : by_count.walls->size);
  }
  EXPECT_EQ(
      problem_of(R"({"walls": {"arena": "stadium", "size": 30, "length": 30}, "box": {"side": 60}})"),
      "run.json:1:40: /walls/size: a stadium of 30 mm and 30 mm does not fit into a box of 60 mm: at most 59 mm in "
      "all; or leave box.side out");
  EXPECT_EQ(problem_of(R"({"walls": {"length": 30}})"),
            "run.json:1:22: /walls/length: only a stadium, an ellipse and a wedge have a length, and walls.arena is "
            "\"disc\"; remove walls.length, or set walls.arena to one of them");
}

TEST(Packing, AnEllipseOrAWedgeIsTwiceAsLongAsWideUnlessItsLengthIsGiven) {
  for (const std::string arena : {"ellipse", "wedge"}) {
    const auto plan = [&](const std::string& walls, const std::string& rest = "") {
      return plan_of(R"({"walls": {"arena": ")" + arena + "\"" + walls + "}" + rest + "}").system;
    };
    const System whole = plan("");
    EXPECT_EQ(whole.box_side, 83.73);
    EXPECT_DOUBLE_EQ(whole.walls->size, 82.73 / 2);
    EXPECT_DOUBLE_EQ(whole.walls->length, 82.73);
    EXPECT_EQ(whole.walls->narrow, 0);
    const System by_size = plan(R"(, "size": 20)");
    EXPECT_EQ(by_size.walls->length, 40);
    EXPECT_DOUBLE_EQ(by_size.box_side, 41);
    const System by_both = plan(R"(, "size": 20, "length": 25)");
    EXPECT_EQ(by_both.walls->length, 25);
    EXPECT_DOUBLE_EQ(by_both.box_side, 26);
    EXPECT_DOUBLE_EQ(plan(R"(, "length": 60)").walls->size, arena == "ellipse" ? 60 : 82.73);
    for (const char* length : {"", R"(, "length": 50)"}) {
      const System by_count = plan(length, R"(, "rods": {"count": 300, "area_fraction": 0.5})");
      EXPECT_NEAR(area_fraction_of(by_count), 0.5, 1e-12);
      EXPECT_EQ(by_count.walls->length, *length ? 50 : 2 * by_count.walls->size);
    }
  }
  for (const char* length : {"", R"(, "length": 30)"}) {
    const System blunt = plan_of(std::string(R"({"walls": {"arena": "wedge", "narrow": 5)") + length +
                                 R"(}, "rods": {"count": 300, "area_fraction": 0.5}})")
                             .system;
    EXPECT_EQ(blunt.walls->narrow, 5);
    EXPECT_NEAR(area_fraction_of(blunt), 0.5, 1e-12);
  }
  EXPECT_EQ(plan_of(R"({"walls": {"arena": "wedge", "size": 30, "length": 8}})").system.box_side, 31)
      << "wider than long";
}

TEST(Packing, ImpossibleEllipsesAndWedgesAreRefused) {
  EXPECT_EQ(problem_of(R"({"walls": {"arena": "ellipse", "size": 30, "length": 70}, "box": {"side": 60}})"),
            "run.json:1:40: /walls/size: an ellipse of 70 mm by 30 mm does not fit into a box of 60 mm: at most 59 mm; "
            "or leave box.side out");
  EXPECT_EQ(
      problem_of(R"({"walls": {"arena": "ellipse", "size": 30, "length": 20}})"),
      "run.json:1:54: /walls/length: an ellipse of 20 mm by 30 mm is wider than long: its long axis lies along x, so "
      "give the greater of the two lengths to walls.length");
  EXPECT_EQ(
      problem_of(R"({"walls": {"arena": "ellipse", "size": 6, "length": 72}})"),
      "run.json:1:40: /walls/size: the ends of an ellipse of 72 mm by 6 mm have a radius of curvature of 0.25 mm, "
      "and rods 0.8 mm thick do not fit into them: make walls.size at least 7.589466384 mm, or walls.length at "
      "most 45 mm");
  EXPECT_EQ(problem_of(R"({"walls": {"arena": "wedge", "size": 30, "length": 0.5}})"),
            "run.json:1:52: /walls/length: a wedge of 0.5 mm is too short: at least 1 mm");
  EXPECT_EQ(problem_of(R"({"walls": {"arena": "wedge", "size": 30, "narrow": 31}})"),
            "run.json:1:52: /walls/narrow: a narrow end of 31 mm is wider than the wide end of 30 mm, walls.size");
  EXPECT_EQ(problem_of(R"({"walls": {"arena": "ellipse", "narrow": 3}})"),
            "run.json:1:42: /walls/narrow: only a wedge has a narrow end, and walls.arena is \"ellipse\"; remove "
            "walls.narrow, or set walls.arena to \"wedge\"");
}

TEST(Packing, AChannelLiesAlongABoxOfAnyShape) {
  const auto channel = [](const std::string& rest) {
    return plan_of(R"({"walls": {"arena": "channel"}, )" + rest + "}").system;
  };
  EXPECT_DOUBLE_EQ(channel(R"("box": {"side": 40})").walls->size, 39);
  EXPECT_DOUBLE_EQ(channel(R"("box": {"side": 40, "aspect": 0.5})").walls->size, 19);
  const System by_size = plan_of(R"({"walls": {"arena": "channel", "size": 24}, "box": {"side": 50}})").system;
  EXPECT_EQ(by_size.box(), Box(50, 25));
  EXPECT_EQ(by_size.area(), 50 * 24);
  const System by_aspect = plan_of(R"({"walls": {"arena": "channel", "size": 24}, "box": {"aspect": 0.5}})").system;
  EXPECT_EQ(by_aspect.box(), Box(50, 25));
  const System square = plan_of(R"({"walls": {"arena": "channel", "size": 48.3}, "box": {"side": 49.3}})").system;
  EXPECT_EQ(square.box_aspect, 1) << "whatever rounding says";
  const std::string both = R"("rods": {"count": 300, "area_fraction": 0.5})";
  const System free = channel(both), long_one = channel(both + R"(, "box": {"aspect": 0.25})"),
               of_side = channel(both + R"(, "box": {"side": 60})");
  for (const System& system : {free, long_one, of_side}) EXPECT_NEAR(area_fraction_of(system), 0.5, 1e-12);
  EXPECT_EQ(free.box_aspect, 1);
  EXPECT_DOUBLE_EQ(long_one.box().y(), long_one.box().x() / 4);
  EXPECT_DOUBLE_EQ(long_one.walls->size, long_one.box().y() - 1);
  EXPECT_DOUBLE_EQ(of_side.box().y(), of_side.walls->size + 1);
  EXPECT_EQ(problem_of(R"({"walls": {"arena": "channel", "size": 30}, "box": {"side": 60, "aspect": 0.5}})"),
            "run.json:1:40: /walls/size: a channel of 30 mm does not fit into a box of 30 mm: at most 29 mm; or leave "
            "box.aspect out");
}

TEST(Packing, OfTooMuchTheKeyThatWasGivenIsNamed) {
  EXPECT_EQ(
      problem_of(R"({"rods": {"count": 300, "area_fraction": 0.5}, "walls": {}, "box": {"side": 50}})").substr(0, 121),
      "run.json:1:42: /rods/area_fraction: rods.area_fraction 0.5 contradicts rods.count 300 in box.side 50 mm "
      "(an arena of 49 m");
  EXPECT_NE(
      problem_of(R"({"rods": {"count": 300, "area_fraction": 0.5}, "walls": {"size": 50}})").find("walls.size 50"),
      std::string::npos);
}

TEST(Packing, ImpossibleOnesAreRefused) {
  EXPECT_EQ(problem_of(R"({"rods": {"count": 2000}, "box": {"side": 40}})").substr(0, 58),
            "run.json:1:20: /rods/count: 2000 rods in a box of 40 mm ar");
  EXPECT_NE(problem_of(R"({"rods": {"area_fraction": 0.6, "start": "random"}})").find("at random at most 0.45"),
            std::string::npos);
  EXPECT_EQ(problem_of(R"({"rods": {"area_fraction": 1e-5}, "box": {"side": 10}})"),
            "run.json:1:28: /rods/area_fraction: rods.area_fraction 1e-05 and box.side 10 mm make 0 rods, outside "
            "[1, 1000000]");
}

TEST(Beads, FollowThePitchOrAreGiven) {
  EXPECT_EQ(plan_of(R"({"rods": {"bead_pitch": "0.5 mm"}})").system.rod.n_beads,
            11);  // 4.1 / 0.5 = 8.2 -> 10 intervals
  EXPECT_EQ(plan_of(R"({"rods": {"beads": 21}})").system.rod.n_beads, 21);
  EXPECT_EQ(problem_of(R"({"rods": {"beads": 21, "bead_pitch": 0.2}})"),
            "run.json:1:20: /rods/beads: rods.beads and rods.bead_pitch are both given; remove one");
  EXPECT_EQ(problem_of(R"({"rods": {"beads": 14}})"),
            "run.json:1:20: /rods/beads: 14 is even; a rod has a centre bead, so an odd number; did you mean 15?");
  EXPECT_EQ(problem_of(R"({"rods": {"beads": 5}})"),
            "run.json:1:20: /rods/beads: 5 beads leave holes between them on a rod of 4.5 mm; take at least 11");
  EXPECT_EQ(problem_of(R"({"rods": {"bead_pitch": 0.01}})"),
            "run.json:1:25: /rods/bead_pitch: beads every 0.01 mm make more than 101 on a rod of 4.5 mm");
}

}  // namespace
}  // namespace shaken::scene
