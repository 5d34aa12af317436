// What users get to see when something is wrong: each kind of mistake, with its place and its remedy.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include "scene/keys/observables.h"
#include "scene/sweeps/sweep.h"
#include "tests/unit/scene/scene_support.h"

namespace shaken::scene {
namespace {

using testing::ElementsAre;

TEST(Problems, UnknownKeysComeWithTheNearestName) {
  EXPECT_EQ(problem_of("{\n  \"rods\": {\n    \"lenght\": 4.5 } }"),
            "run.json:3:5: /rods/lenght: unknown key; did you mean rods.length?");
  EXPECT_EQ(problem_of(R"({"length": 4.5})"), "run.json:1:2: /length: unknown key; did you mean rods.length?");
  EXPECT_EQ(problem_of(R"({"meassure": {}})"), "run.json:1:2: /meassure: unknown key; did you mean measure?");
  EXPECT_EQ(problem_of(R"({"measure": {"tilt": {"evry": 1}}})"),
            "run.json:1:23: /measure/tilt/evry: unknown key; did you mean measure.tilt.every?");
  EXPECT_EQ(problem_of(R"({"colour": 1})"), "run.json:1:2: /colour: unknown key");
  EXPECT_EQ(problem_of(R"({"rods.length": 3})"),
            "run.json:1:2: /rods/length: unknown key \"rods.length\"; use objects in objects");
  EXPECT_EQ(problem_of(R"({"": 3})"), "run.json:1:2: unknown key \"\"");
}

TEST(Problems, DuplicateKeys) {
  EXPECT_EQ(problem_of("{\"box\": {\"gap\": 1.2,\n\"gap\": 1.4}}"),
            "run.json:2:1: /box/gap: duplicate key, first given at 1:10");
}

TEST(Problems, ContactsOfRodsThatAreNotThere) {
  EXPECT_EQ(problem_of(R"({"contacts": {"rod_base": {"rods_2": {"friction": 0.3}}}})"),
            "run.json:1:51: /contacts/rod_base/rods_2/friction: contacts.rod_base.rods_2.friction is about rods_2, "
            "which the scene does not have; add rods_2 or remove the key");
  EXPECT_EQ(problem_of(R"({"rods_2": {"count": 5}, "contacts": {"rod_rod": {"rods_2_rods_3": {"restitution": 0.3}}}})"),
            "run.json:1:84: /contacts/rod_rod/rods_2_rods_3/restitution: contacts.rod_rod.rods_2_rods_3.restitution is "
            "about rods_3, which the scene does not have; add rods_3 or remove the key");
  for (const char* contact : {"rod_rod.rods_rods_2", "rod_rod.rods_2_rods_2", "rod_lid.rods_2", "rod_base.rods_2"}) {
    EXPECT_THAT(problem_of("{}", {fmt::format("contacts.{}.friction=0.3", contact)}),
                testing::HasSubstr("is about rods_2, which the scene does not have"));
  }
}

TEST(Problems, NoiseOfRodsThatAreNotThere) {
  EXPECT_EQ(problem_of(R"({"rods_3": {"count": 5}, "plates": {"rods_2": {"noise": 0.3}}})"),
            "run.json:1:57: /plates/rods_2/noise: plates.rods_2.noise is about rods_2, which the scene does not have; "
            "add rods_2 or remove the key");
  EXPECT_EQ(problem_of(R"({"rods_2": {"count": 5}, "plates": {"rods_2": {"noise": -0.3}}})"),
            "run.json:1:57: /plates/rods_2/noise: -0.3 is outside [0, 10]");
}

TEST(Problems, WallsAndPostsOnPlatesThatVibrateInThePlane) {
  EXPECT_EQ(problem_of(R"({"plates": {"horizontal_amplitude": 0.05}, "walls": {}})"),
            "run.json:1:37: /plates/horizontal_amplitude: side walls would move through the plane with the plates, and "
            "the simulator knows side walls that only rise and fall: remove walls, or set plates.horizontal_amplitude "
            "to 0");
  EXPECT_THAT(problem_of(R"({"plates": {"horizontal_amplitude": 0.05}, "posts": {"columns": 2, "rows": 2}})"),
              testing::HasSubstr("posts would move through the plane with the plates"));
  EXPECT_EQ(plan_of(R"({"plates": {"horizontal_amplitude": "50 um"}})").system.horizontal_amplitude, 0.05);
}

TEST(Problems, SlopesOnWhichRodsWouldPileUp) {
  EXPECT_EQ(
      problem_of(R"({"plates": {"inclination": 5}, "walls": {}})"),
      "run.json:1:28: /plates/inclination: on a slope of 5 degrees rods would lie on side walls and on each other, "
      "and impacts alone do not keep those apart: at most 1 degree with side walls, or none of these");
  EXPECT_THAT(problem_of(R"({"plates": {"inclination": 5}, "posts": {"columns": 2, "rows": 2}})"),
              testing::HasSubstr("rods would lie on posts"));
  EXPECT_EQ(plan_of(R"({"plates": {"inclination": 1}, "walls": {}})").system.inclination, 1);
  EXPECT_EQ(plan_of(R"({"plates": {"inclination": 90}})").system.inclination, 90);
}

TEST(Problems, PlatesThatMoveApart) {
  EXPECT_EQ(problem_of(R"({"plates": {"lid": false, "lid_motion": {}}})"),
            "run.json:1:41: /plates/lid_motion: there is no lid that could move: remove plates.lid_motion, or set "
            "plates.lid to true");
  EXPECT_EQ(
      problem_of(R"({"box": {"gap": 0.9}, "plates": {"lid_motion": {"amplitude": "60 um", "phase": 180}}})"),
      "run.json:1:17: /box/gap: a gap of 0.9 mm, of which the plates leave 0.7965142145 mm where they are nearest, is "
      "too small for rods 0.8 mm thick");
  EXPECT_EQ(
      problem_of(R"({"plates": {"second": {"frequency": "20 kHz"}}})"),
      "run.json:1:37: /plates/second/frequency: a step of 4 us is too long for plates at 20000 Hz: at most 2.5 us");
  EXPECT_THAT(problem_of(R"({"plates": {"second": {"amplitude": "10 mm", "frequency": "2 kHz"}}})"),
              testing::HasSubstr("plates as fast as 1.257e+05 mm/s move further in a step"));
  const System system =
      plan_of(R"({"plates": {"second": {"phase": 90}, "lid_motion": {"amplitude": "20 um"}}})").system;
  EXPECT_EQ(system.second, (SecondVibration{0.01, 400, 90}));
  EXPECT_EQ(system.lid_motion, (LidMotion{0.02, 0}));
}

TEST(Problems, NeighboursBeyondHalfTheBox) {
  EXPECT_EQ(problem_of(R"({"box": {"side": 20}, "measure": {"mixing": {"distance": 10.1}}})"),
            "run.json:1:58: /measure/mixing/distance: neighbours at 10.1 mm are farther than half the box, 10 mm: "
            "distances have no nearest image there");
  EXPECT_EQ(plan_of(R"({"measure": {"mixing": {}}})").mixing->distance, 4.5);
}

TEST(Problems, DensityMapsShorterThanASample) {
  EXPECT_EQ(problem_of(R"({"measure": {"density": {"duration": "50 ms"}}})"),
            "run.json:1:38: /measure/density/duration: measure.density.duration 50 ms is shorter than "
            "measure.density.every 100 ms");
}

TEST(Problems, MapsBeyondHalfTheBox) {
  EXPECT_EQ(problem_of(R"({"box": {"side": 20}, "measure": {"defect_maps": {"range": 10.1}}})"),
            "run.json:1:60: /measure/defect_maps/range: a map of 10.1 mm each way reaches beyond half the box, 10 mm: "
            "rods have no nearest image there");
  EXPECT_EQ(problem_of(R"({"box": {"side": 20}, "measure": {"pairs": {"range": 10.1}}})"),
            "run.json:1:54: /measure/pairs/range: a map of 10.1 mm each way reaches beyond half the box, 10 mm: "
            "distances have no nearest image there");
}

TEST(Problems, ValuesOutOfRangeComeWithTheRangeAndWhatMayHaveBeenMeant) {
  EXPECT_EQ(problem_of(R"({"rods": {"length": "450 mm"}})"),
            "run.json:1:21: /rods/length: 450 mm is outside [0.05, 50] mm; did you mean 4.5 mm?");
  EXPECT_EQ(problem_of(R"({"time": {"step": 4}})"),
            "run.json:1:19: /time/step: 4 s is outside [0.1, 100] us; did you mean 4 us?");
  EXPECT_EQ(problem_of(R"({"gravity": 9.81})"),
            "run.json:1:13: /gravity: 9.81 mm/s^2 is outside 0 or [0.1, 100] m/s^2; did you mean 9.81 m/s^2?");
  EXPECT_EQ(problem_of(R"({"rods": {"area_fraction": 75}})"),
            "run.json:1:28: /rods/area_fraction: 75 is outside [1e-06, 0.92]; did you mean 0.75?");
  EXPECT_EQ(problem_of(R"({"rods": {"area_fraction": 0.99}})"),
            "run.json:1:28: /rods/area_fraction: 0.99 is outside [1e-06, 0.92]");
  EXPECT_EQ(problem_of(R"({"contacts": {"rod_rod": {"restitution": -0.1}}})"),
            "run.json:1:42: /contacts/rod_rod/restitution: -0.1 is outside [0, 1]");
  EXPECT_EQ(problem_of(R"({"measure": {"g2": {"bins": 1}}})"),
            "run.json:1:29: /measure/g2/bins: 1 is outside [2, 10000]");
  // a double would round it to a number that is allowed
  for (const char* seed : {"9007199254740993", "9007199254740993.0", "900719925474099.3e1", "\"9007199254740993\""}) {
    EXPECT_THAT(problem_of(R"({"time": {"seed": )" + std::string(seed) + "}}"),
                testing::HasSubstr("is outside [0, 9007199254740992]"))
        << seed;
  }
  EXPECT_EQ(problem_of(R"({"time": {"seed": -1}})"), "run.json:1:19: /time/seed: -1 is outside [0, 9007199254740992]");
}

TEST(Problems, WrongKindsOfValues) {
  EXPECT_EQ(problem_of(R"({"rods": {"length": true}})"),
            "run.json:1:21: /rods/length: expected a number in mm or a text with a unit, not true");
  EXPECT_EQ(problem_of(R"({"rods": {"length": [1]}})"),
            "run.json:1:21: /rods/length: expected a number in mm or a text with a unit, not an array");
  EXPECT_EQ(problem_of(R"({"rods": {"count": 10.5}})"), "run.json:1:20: /rods/count: 10.5 is not a whole number");
  EXPECT_EQ(problem_of(R"({"rods": {"count": {}}})"),
            "run.json:1:20: /rods/count: expected a whole number, not an object");
  EXPECT_EQ(problem_of(R"({"rods": {"start": 1}})"),
            "run.json:1:20: /rods/start: expected one of \"aligned\", \"random\", \"compressed\", \"polydomain\", "
            "\"defect_pair\", not the number 1");
  EXPECT_EQ(problem_of(R"({"rods": {"start": "randm"}})"),
            "run.json:1:20: /rods/start: \"randm\" is not one of \"aligned\", \"random\", \"compressed\", "
            "\"polydomain\", \"defect_pair\"; did you mean random?");
  EXPECT_EQ(problem_of(R"({"time": {"steady": "aut"}})"),
            "run.json:1:21: /time/steady: \"aut\" is neither \"auto\" nor a number in s or a text with a unit; "
            "did you mean auto?");
  EXPECT_EQ(problem_of(R"({"rods": 3})"), "run.json:1:10: /rods: expected an object, not the number 3");
  EXPECT_EQ(problem_of(R"({"movie": 30})"), "run.json:1:11: /movie: expected an object, not the number 30");
  EXPECT_EQ(problem_of("[]"), "run.json:1:1: expected an object, not an array");
  EXPECT_EQ(problem_of("3"), "run.json:1:1: expected an object, not the number 3");
}

TEST(Problems, WrongUnits) {
  EXPECT_EQ(problem_of(R"({"box": {"side": "83 Hz"}})"),
            "run.json:1:18: /box/side: \"Hz\" is a unit of frequency, not of length; use mm, m, cm, um");
  EXPECT_EQ(problem_of(R"({"time": {"measure": "6 sec"}})"),
            "run.json:1:22: /time/measure: \"sec\" is not a unit of time; use s, h, min, ms, us, ns");
  EXPECT_EQ(problem_of(R"({"rods": {"length": "four"}})"), "run.json:1:21: /rods/length: \"four\" is not a number");
}

TEST(Problems, NumbersThatAreNone) {
  EXPECT_EQ(problem_of(R"({"rods": {"length": NaN}})"), "run.json:1:21: syntax error: NaN is not a number");
  EXPECT_EQ(problem_of(R"({"rods": {"length": -Infinity}})"), "run.json:1:21: syntax error: -Infinity is not a number");
  EXPECT_EQ(problem_of(R"({"rods": {"length": "nan"}})"), "run.json:1:21: /rods/length: \"nan\" is not a number");
  EXPECT_EQ(problem_of(R"({"rods": {"length": "1e999 mm"}})"), "run.json:1:21: /rods/length: 1e999 is too large");
}

TEST(Problems, MovieSizes) {
  EXPECT_EQ(problem_of(R"({"movie": {"size": [1281, 720]}})"),
            "run.json:1:21: /movie/size: 1281 is odd; video needs even numbers of pixels; did you mean 1282?");
  EXPECT_EQ(problem_of(R"({"movie": {"size": [1280]}})"),
            "run.json:1:20: /movie/size: expected [width, height], not an array");
  EXPECT_EQ(problem_of(R"({"movie": {"size": [1280, 20]}})"), "run.json:1:27: /movie/size: 20 is outside [64, 7680]");
}

TEST(Problems, ImpossibleGeometry) {
  EXPECT_EQ(problem_of(R"({"box": {"side": 9.8}})"),
            "run.json:1:18: /box/side: a periodic box of 9.8 mm is too small for rods of 4.5 mm: at least 9.9 mm");
  EXPECT_EQ(problem_of(R"({"box": {"gap": "0.8 mm"}})"),
            "run.json:1:17: /box/gap: a gap of 0.8 mm is too small for rods 0.8 mm thick");
  EXPECT_EQ(problem_of(R"({"rods": {"end_diameter": 1.3}})"),
            "run.json:1:27: /rods/end_diameter: a gap of 1.2 mm is too small for rods 1.3 mm thick");
  EXPECT_EQ(problem_of(R"({"rods": {"length": 0.7}})"),
            "run.json:1:21: /rods/length: a rod of length 0.7 mm is not longer than its thickest bead (0.8 mm)");
  EXPECT_EQ(
      problem_of(R"({"rods": {"length": "4.5 mm", "beads": 1}})"),
      "run.json:1:21: /rods/length: one bead is a sphere: rods.length (4.5 mm) must be rods.mid_diameter (0.8 mm)");
}

TEST(Problems, OfSeveralKindsOfRods) {
  EXPECT_EQ(problem_of(R"({"rods": {"area_fraction": 0.3}, "rods_2": {"beads": 1}})"),
            "run.json:1:44: /rods_2: how many rods? Give rods_2.count or rods_2.area_fraction");
  EXPECT_EQ(
      problem_of(R"({"rods_3": {"area_fraction": 0.3}})"),
      "run.json:1:30: /rods_3/area_fraction: 2954 rods in a box of 83.73 mm are an area fraction of 1.05; in rows at "
      "most 0.92 can be placed");
  EXPECT_EQ(
      problem_of(R"({"rods": {"bead_diameters": [0.4, 0.3, 0.8], "length": 4.5}})"),
      "run.json:1:29: /rods/bead_diameters: 3 beads of these diameters leave holes between them on a rod of 4.5 mm; "
      "give more");
  EXPECT_EQ(problem_of(R"({"rods": {"bead_diameters": [0.8, 0.6], "length": 1, "beads": 3}})"),
            "run.json:1:63: /rods/beads: rods.beads follows from rods.bead_diameters, which makes it 2; remove it");
}

TEST(Problems, MapsThatTakeTooMuchMemory) {
  EXPECT_EQ(plan_of(R"({"measure": {"pairs": {"bins": 201}}})").pairs->bins, 201);
  EXPECT_EQ(problem_of(R"({"measure": {"pairs": {"bins": 1000}}})"),
            "run.json:1:32: /measure/pairs/bins: 1000 is outside [2, 201]");
}

TEST(Problems, OfWallsAndPlates) {
  EXPECT_EQ(problem_of(R"({"walls": {}, "measure": {"frank": {}}})"),
            "run.json:1:36: /measure/frank: measure.frank is of the waves of a periodic box: walls leave none");
  EXPECT_THAT(
      problems_of(R"({"walls": {}, "measure": {"g2": {}, "lattice": {}, "layers": {}, "pairs": {}, "frank": {}}})"),
      ElementsAre("run.json:1:48: /measure/lattice: measure.lattice is of the nearest images and waves of a periodic "
                  "box: walls leave none",
                  "run.json:1:62: /measure/layers: measure.layers is of the waves of a periodic box: walls leave none",
                  "run.json:1:75: /measure/pairs: measure.pairs is of the nearest images of a periodic box: walls "
                  "leave none",
                  "run.json:1:88: /measure/frank: measure.frank is of the waves of a periodic box: walls leave none"));
  plan_of(R"({"walls": {}, "measure": {"defects": {}, "g2": {}, "pairs": null, "layers": false}})");
  EXPECT_EQ(problem_of(R"({"walls": {"size": "50 mm"}, "box": {"side": "50 mm"}})"),
            "run.json:1:20: /walls/size: an arena of 50 mm does not fit into a box of 50 mm: at most 49 mm; or leave "
            "box.side out");
  EXPECT_EQ(problem_of(R"({"plates": {"base": false}})"),
            "run.json:1:21: /plates/base: without a base rods fall out of sight: set gravity to 0");
  EXPECT_EQ(problem_of(R"({"plates": {"lid": 1}})"),
            "run.json:1:20: /plates/lid: expected true or false, not the number 1");
}

TEST(Problems, OnlyWhatNeedsAPeriodicBoxIsRefusedWithinWalls) {
  for (const Observable& observable : observables()) {
    const std::string text = R"({"walls": {}, "measure": {")" + observable.name + R"(": {}}})";
    EXPECT_EQ(static_cast<bool>(load_scene(text, "run.json")), observable.within_walls()) << observable.name;
  }
}

TEST(Problems, OfTheInnerWall) {
  EXPECT_EQ(
      problem_of(R"({"walls": {"arena": "annulus", "inner": "90 mm"}})"),
      "run.json:1:41: /walls/inner: an inner wall of 90 mm does not fit into an outer one of 82.73 mm, as large as "
      "box.side allows");
  EXPECT_EQ(problem_of(R"({"walls": {"arena": "annulus", "size": 50, "inner": 50}})"),
            "run.json:1:53: /walls/inner: an inner wall of 50 mm does not fit into an outer one of 50 mm, walls.size");
  EXPECT_EQ(
      problem_of(R"({"walls": {"arena": "annulus", "size": 50, "inner": 45}})"),
      "run.json:1:53: /walls/inner: an annulus from 45 mm to 50 mm leaves no room for rods of 4.5 mm to turn: its "
      "walls must be a rod length apart");
  EXPECT_EQ(problem_of(R"({"walls": {"inner": "10 mm"}})"),
            "run.json:1:21: /walls/inner: only an annulus has an inner wall, and walls.arena is \"disc\"; remove "
            "walls.inner, or set walls.arena to \"annulus\"");
  EXPECT_EQ(problems_of(R"({"walls": {"arena": "square"}})", {"walls.inner=3"}).size(), 1u);
}

TEST(Problems, PlatesTooFastForTheStep) {
  const char* wild = R"({"plates": {"gamma": 150, "frequency": 100}})";
  const std::string problem = problem_of(wild, {"time.step=100 us"});
  const std::string expected =
      "-s time.step=100 us: /time/step: plates as fast as 2342 mm/s move further in a step of 100 us than half the "
      "radius of the thinnest bead, 0.1 mm, the deepest overlap there may be: the run would end in numerical trouble; "
      "take a step of at most 42.699";
  EXPECT_EQ(problem.substr(0, expected.size()), expected);
  plan_of(wild, {"time.step=42 us"});
  plan_of(wild);
}

TEST(Problems, SmallNumbersReadWell) {
  EXPECT_EQ(problem_of(R"({"rods": {"area_fraction": 5.454153912e-7}})"),
            "run.json:1:28: /rods/area_fraction: 5.454153912e-7 is outside [1e-06, 0.92]; did you mean "
            "0.0005454153912?");
}

TEST(Problems, TimesThatDoNotFitTogether) {
  EXPECT_EQ(problem_of(R"({"measure": {"velocity": {"window": "50 ms"}}})"),
            "run.json:1:37: /measure/velocity/window: measure.velocity.window 50 ms is shorter than "
            "measure.velocity.every 100 ms");
  EXPECT_EQ(problem_of(R"({"measure": {"van_hove": {"lag": "5 ms"}}})"),
            "run.json:1:34: /measure/van_hove/lag: measure.van_hove.lag 5 ms is shorter than measure.van_hove.every "
            "10 ms");
  EXPECT_EQ(problem_of(R"({"measure": {"tilt": {"every": "3 us"}}})"),
            "run.json:1:32: /measure/tilt/every: measure.tilt.every 3 us is shorter than time.step 4 us");
  EXPECT_EQ(
      problem_of(R"({"time": {"measure": "1 us"}})"),
      "run.json:1:22: /time/measure: time.measure 1 us is shorter than time.step 4 us: nothing would be simulated");
  EXPECT_EQ(problem_of(R"({"plates": {"frequency": "20 kHz"}})"),
            "run.json:1:26: /plates/frequency: a step of 4 us is too long for plates at 20000 Hz: at most 2.5 us");
  // twenty ticks in a period are just enough
  EXPECT_EQ(plan_of(R"({"plates": {"frequency": 500}, "time": {"step": "100 us"}})").system.dt, 100e-6);
  EXPECT_THAT(problem_of(R"({"plates": {"frequency": 501}, "time": {"step": "100 us"}})"),
              testing::HasSubstr("a step of 100 us is too long for plates at 501 Hz"));
}

TEST(Problems, AreListedAllAtOnceInTheOrderOfTheText) {
  EXPECT_THAT(
      problems_of(R"({
  "rods": { "lenght": 4.5, "start": "randm" },
  "box": { "gap": "0.7 mm", "side": "83 Hz" },
  "time": { "step": 4, "seed": 1, "seed": 2 },
  "movie": { "size": [1281, 719] } })",
                  {"plates.gama=3", "time.measure=0 s"}),
      ElementsAre("run.json:2:13: /rods/lenght: unknown key; did you mean rods.length?",
                  "run.json:2:37: /rods/start: \"randm\" is not one of \"aligned\", \"random\", \"compressed\", "
                  "\"polydomain\", \"defect_pair\"; did you mean random?",
                  "run.json:3:19: /box/gap: a gap of 0.7 mm is too small for rods 0.8 mm thick",
                  "run.json:3:37: /box/side: \"Hz\" is a unit of frequency, not of length; use mm, m, cm, um",
                  "run.json:4:21: /time/step: 4 s is outside [0.1, 100] us; did you mean 4 us?",
                  "run.json:4:35: /time/seed: duplicate key, first given at 4:24",
                  "run.json:5:23: /movie/size: 1281 is odd; video needs even numbers of pixels; did you mean 1282?",
                  "run.json:5:29: /movie/size: 719 is odd; video needs even numbers of pixels; did you mean 720?",
                  "-s plates.gama=3: /plates/gama: unknown key; did you mean plates.gamma?",
                  "-s time.measure=0 s: /time/measure: 0 s is outside [1e-06, 10000000] s"));
  EXPECT_THAT(problems_of(R"({"box": {"side": 5}})", {"contacts.rod_rod.friction=-1"}),
              ElementsAre(testing::HasSubstr("run.json:1:18: "), testing::HasSubstr("friction")));
}

TEST(Problems, OneMistakeIsReportedOnce) {
  // A length that is no length says nothing about box, beads or packing.
  EXPECT_EQ(problems_of(R"({"rods": {"length": "xy"}, "measure": {"defects": {}}})").size(), 1u);
  EXPECT_EQ(problems_of(R"({"rods": {"count": -3}})").size(), 1u);
  EXPECT_EQ(problems_of(R"({"plates": {"frequency": -200}})").size(), 1u);
}

/// A search through all keys for each of them would take minutes, and end by the test's time limit.
TEST(Problems, ManyAreFoundOneByOne) {
  std::string unknown = "{", twice = "{", wrong = "{\"rods\": {\"bead_diameters\": [";
  for (int i = 0; i < 30'000; ++i) {
    const std::string key = "\"rods_lenght_" + std::to_string(i) + "\": 1, ";
    unknown += key;
    twice += key + "\"x\": 1, ";
    wrong += "\"450 mm\", ";
  }
  for (const std::string& text :
       {unknown + "\"y\": 1}", twice + "\"y\": 1}", wrong + "1]}}", "{\"sweep\": {\"grid\": " + unknown + "\"y\": 1}}}",
        "{\"scene\": {}, " + unknown.substr(1) + "\"y\": 1}"}) {
    const Loaded<Sweep> loaded = load_sweep(text, "many.json");
    ASSERT_FALSE(loaded);
    ASSERT_EQ(loaded.error().size(), 101u);
    EXPECT_THAT(loaded.error().back().message, testing::MatchesRegex("and [0-9]+ more problems"));
  }
}

// Each takes its time, and of a hundred thousand a hundred are told.
TEST(Problems, PointsAreNotLookedAtAfterAThousandProblems) {
  const Loaded<Sweep> loaded = load_sweep(R"({"sweep": {"grid": {"box.gap": "101:5000:0.1"}}})", "many.json");
  ASSERT_FALSE(loaded);
  ASSERT_EQ(loaded.error().size(), 101u);
  EXPECT_EQ(loaded.error().back().message, "and 900 more problems");
}

TEST(Problems, ListsAreCut) {
  std::string text = "{";
  for (int i = 0; i < 150; ++i) text += "\"x" + std::to_string(i) + "\": 1,\n";
  const std::vector<std::string> lines = problems_of(text + "\"y\": 1}");
  ASSERT_EQ(lines.size(), 101u);
  EXPECT_EQ(lines.back(), "run.json: and 51 more problems");
}

}  // namespace
}  // namespace shaken::scene
