#include "scene/sweeps/sweep.h"

#include <gmock/gmock.h>

#include <set>

#include "scene/canonical.h"
#include "tests/support/effort.h"
#include "tests/support/good.h"
#include "tests/unit/scene/scene_support.h"

namespace shaken::scene {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

Sweep sweep_of(std::string_view text, const std::vector<std::string>& settings = {}, std::optional<int> replicas = {}) {
  Loaded<Sweep> loaded = load_sweep(text, "configs/tilt-scan.json", settings, replicas);
  EXPECT_TRUE(loaded) << text << "\n" << to_string(loaded.error());
  return loaded ? *loaded : Sweep{};
}

std::vector<std::string> labels(const Sweep& sweep) {
  std::vector<std::string> all;
  for (const SweepPoint& point : sweep.points) all.push_back(point.label);
  return all;
}

std::string sweep_problems(std::string_view text, const std::vector<std::string>& settings = {},
                           std::optional<int> replicas = {}) {
  const Loaded<Sweep> loaded = load_sweep(text, "s.json", settings, replicas);
  EXPECT_FALSE(loaded) << text;
  return to_string(loaded.error());
}

TEST(Sweep, APlainSceneIsASweepOfOnePoint) {
  const Sweep sweep = sweep_of(R"({"rods": {"length": 2.5}})");
  EXPECT_EQ(sweep.name, "tilt-scan");
  ASSERT_EQ(sweep.points.size(), 1u);
  EXPECT_EQ(sweep.points[0].label, "");
  EXPECT_EQ(sweep.points[0].parameters.dump(), "{}");
  EXPECT_EQ(sweep.points[0].replica, 1);
  EXPECT_EQ(sweep.points[0].plan, plan_of(R"({"rods": {"length": 2.5}})"));
}

TEST(Sweep, ValuesOfAllKeysAndSettingsHaveALimitTogether) {
  if (test::kSanitized)
    GTEST_SKIP() << "a million values: half a minute, in code that other tests of this file run too";
  const std::vector<std::string> settings(11, "rods.length=1:100000:1");
  EXPECT_THAT(sweep_problems("{}", settings), HasSubstr("the sweep has more than 1000000 values"));
}

TEST(Sweep, ANameCanBePrintedOnAnyTerminal) {
  const auto named = [](const std::string& name) { return R"({"scene": {}, "name": ")" + name + "\"}"; };
  for (const std::string name : {".", ".."}) {
    EXPECT_THAT(sweep_problems(named(name)), HasSubstr("s.json:1:23: /name: a sweep cannot be named \"" + name + "\""));
  }
  EXPECT_EQ(sweep_of(named("Γ = 7, ⟨S⟩")).name, "Γ = 7, ⟨S⟩");
  EXPECT_EQ(sweep_of(named(std::string(200, 'x'))).name.size(), 200u);
  for (const std::string& name : {std::string(), std::string(201, 'x'), std::string("a/b"),
                                  std::string("\\u001b]0;title\\u0007"), std::string("a\\nb"), std::string("\\u0000"),
                                  std::string("\x7f"), std::string("\u009b2J"), std::string("\u202e")}) {
    EXPECT_THAT(sweep_problems(named(name)), HasSubstr("s.json:1:23: /name: a name has 1 to 200 bytes")) << name;
  }
  for (const std::string& file : {std::string("a\nb.json"), std::string("\x1b]0;x\x07"), std::string()}) {
    EXPECT_THAT(test::refusal(load_sweep("{}", file)), HasSubstr("rename the file"));
  }
  EXPECT_TRUE(load_sweep(named("good"), "a\nb.json"));
}

TEST(Sweep, AGridIsAllCombinations) {
  const Sweep sweep = sweep_of(R"({"name": "my sweep", "scene": {"box": {"side": 40}},
    "sweep": {"grid": {"rods.length": ["2.5 mm", 4.5], "rods.area_fraction": "0.5:0.7:0.1"}}})");
  EXPECT_EQ(sweep.name, "my sweep");
  EXPECT_THAT(labels(sweep),
              ElementsAre("rods.length=2.5 rods.area_fraction=0.5", "rods.length=2.5 rods.area_fraction=0.6",
                          "rods.length=2.5 rods.area_fraction=0.7", "rods.length=4.5 rods.area_fraction=0.5",
                          "rods.length=4.5 rods.area_fraction=0.6", "rods.length=4.5 rods.area_fraction=0.7"));
  EXPECT_EQ(sweep.points[1].parameters.dump(), R"({"rods.length":2.5,"rods.area_fraction":0.6})");
  EXPECT_EQ(sweep.points[1].plan, plan_of(R"({"box": {"side": 40}, "rods": {"length": 2.5, "area_fraction": 0.6}})"));
}

TEST(Sweep, PathsOfAZipVaryTogether) {
  const Sweep sweep = sweep_of(R"({"sweep": {"zip": {"rods.length": [2.5, 3.5, 4.5], "box.gap": "1.2:1.6:0.2"}}})");
  EXPECT_THAT(labels(sweep),
              ElementsAre("rods.length=2.5 box.gap=1.2", "rods.length=3.5 box.gap=1.4", "rods.length=4.5 box.gap=1.6"));
}

TEST(Sweep, AListNamesItsPointsOneByOne) {
  const Sweep sweep =
      sweep_of(R"({"sweep": {"list": [{"rods.length": 2.5}, {"time.step": "2 us", "rods.start": "aligned"}, {}]}})");
  EXPECT_THAT(labels(sweep), ElementsAre("rods.length=2.5", "time.step=2e-06 rods.start=aligned", ""));
  EXPECT_EQ(sweep.points[1].parameters.dump(), R"({"time.step":2e-06,"rods.start":"aligned"})");
  EXPECT_EQ(sweep.points[2].plan, plan_of("{}"));
}

TEST(Sweep, EverythingTogetherIsAProductWithTheLastVaryingFastest) {
  const Sweep sweep = sweep_of(R"({"sweep": {
    "grid": {"box.gap": [1.2, 1.4]},
    "zip": {"rods.length": [2.5, 4.5], "rods.area_fraction": [0.5, 0.6]},
    "list": [{"plates.gamma": 6}, {"plates.gamma": 7}],
    "replicas": 2}})");
  ASSERT_EQ(sweep.points.size(), 2u * 2 * 2 * 2);
  EXPECT_THAT(sweep.points[0].label, HasSubstr("box.gap=1.2 rods.length=2.5 rods.area_fraction=0.5 plates.gamma=6"));
  EXPECT_THAT(sweep.points[1].label, HasSubstr(" replica=2"));
  EXPECT_THAT(sweep.points[2].label, HasSubstr("plates.gamma=7"));
  EXPECT_THAT(sweep.points[4].label, HasSubstr("rods.length=4.5"));
  EXPECT_THAT(sweep.points[8].label, HasSubstr("box.gap=1.4"));
  std::set<std::string> ids;
  for (const SweepPoint& point : sweep.points) ids.insert(run_id(point.plan));
  EXPECT_EQ(ids.size(), sweep.points.size());
}

TEST(Sweep, PointsThatFillASpaceComeFromPython) {
  for (const std::string kind : {"random", "latin", "sobol"}) {
    EXPECT_THAT(sweep_problems(R"({"sweep": {")" + kind + R"(": {"n": 4, "box.gap": {"from": 1, "to": 2}}}})"),
                HasSubstr("/sweep/" + kind + ": points that fill a space are entries of \"list\""));
  }
}

TEST(Sweep, AnArrayIsOneSweepAfterTheOther) {
  const Sweep sweep = sweep_of(R"({"scene": {"box": {"side": 30}}, "sweep": [
    {"grid": {"rods.length": [2, 3]}},
    {"zip": {"rods.length": [3, 4], "box.gap": [1.2, 1.4]}, "replicas": 2},
    {"list": [{}, {"rods.length": 2}]}]})");
  // rods.length = 3 at a gap of 1.2 mm and the seed 1 is there already, as is 2 mm.
  EXPECT_THAT(labels(sweep),
              ElementsAre("rods.length=2", "rods.length=3", "rods.length=3 box.gap=1.2 replica=2",
                          "rods.length=4 box.gap=1.4 replica=1", "rods.length=4 box.gap=1.4 replica=2", ""));
  EXPECT_EQ(sweep_of(R"({"sweep": [{"replicas": 2}, {"replicas": 3}]})").points.size(), 3u);
  EXPECT_EQ(sweep_of(R"({"sweep": [{"replicas": 2}, {"grid": {"box.gap": [1.2, 1.3]}}]})", {}, 4).points.size(), 8u);
  // The grids may be written apart; the runs are those of the one.
  EXPECT_THAT(labels(sweep_of(R"({"sweep": [{"grid": {"box.gap": [1.2]}}, {"grid": {"box.gap": [1.2, 1.3]}}]})")),
              ElementsAre("box.gap=1.2", "box.gap=1.3"));
}

TEST(Sweep, OfARunInSeveralSweepsOfAnArrayTheLongestIsAsked) {
  const Sweep sweep = sweep_of(R"({"scene": {}, "sweep": [
      {"list": [{"time.measure": 5}, {"rods.length": 2.5}]}, {"list": [{"time.measure": 8}]}, {"list": [{"time.measure": 6}]}]})");
  ASSERT_EQ(sweep.points.size(), 2U);
  EXPECT_EQ(sweep.points[0].plan.measure_time, 8);
  EXPECT_EQ(sweep.points[1].plan.measure_time, 10) << "the default";
}

TEST(Sweep, SettingsHoldForEachSweepOfAnArray) {
  const std::string text =
      R"({"sweep": [{"grid": {"rods.length": [2, 3]}}, {"grid": {"rods.length": [4], "box.gap": [1.2, 1.4]}}]})";
  EXPECT_THAT(labels(sweep_of(text, {"rods.length=5"})), ElementsAre("", "box.gap=1.4"));
  EXPECT_THAT(labels(sweep_of(text, {"box.gap=1.2,1.3"})),
              ElementsAre("rods.length=2 box.gap=1.2", "rods.length=2 box.gap=1.3", "rods.length=3 box.gap=1.2",
                          "rods.length=3 box.gap=1.3", "rods.length=4 box.gap=1.2", "rods.length=4 box.gap=1.3"));
}

TEST(Sweep, MistakesInAnArrayHaveTheirNumber) {
  EXPECT_EQ(sweep_problems(R"({"sweep": [{"gird": {}}, 3, {"zip": [], "replicas": 0, "grid": {"box.gap": [0.7]}}]})"),
            "s.json:1:13: /sweep/0/gird: unknown key; did you mean grid?\n"
            "s.json:1:26: /sweep/1: expected an object, not the number 3\n"
            "s.json:1:37: /sweep/2/zip: expected an object of paths and values, not an array\n"
            "s.json:1:53: /sweep/2/replicas: expected a whole number in [1, 10000], not the number 0\n"
            "s.json:1:77: /box/gap: a gap of 0.7 mm is too small for rods 0.8 mm thick\n");
  EXPECT_EQ(
      sweep_problems(R"({"sweep": [{"grid": {"rods.length": "1:60000:1"}}, {"grid": {"rods.length": "1:50000:1"}}]})"),
      "s.json:1:1: the sweep has more than 100000 points: 60000 (grid) x 1 replicas + 50000 (grid) x 1 replicas\n");
}

// Every kind of part beside every other: as many points as the product has, each of a part's choices equally often, and
// keys of a zip never apart.
TEST(Sweep, PartsGoTogetherInEveryCombination) {
  struct Part {
    const char* text;
    std::size_t n;
  };
  const Part parts[] = {
      {R"("grid": {"box.gap": [1.2, 1.4, 1.6]})", 3},
      {R"("zip": {"rods.length": "3:4:1", "rods.area_fraction": {"from": 0.3, "to": 0.4, "n": 2}})", 2},
      {R"("list": [{"plates.gamma": 6}, {"plates.gamma": 7, "contacts.sweeps": 2}])", 2},
      {R"("replicas": 2)", 2}};
  for (unsigned chosen = 0; chosen < 16; ++chosen) {
    std::string text;
    std::size_t n = 1;
    for (unsigned k = 0; k < 4; ++k) {
      if (((chosen >> k) & 1) == 0) continue;
      text += (text.empty() ? "" : ", ") + std::string(parts[k].text);
      n *= parts[k].n;
    }
    for (const bool in_array : {false, true}) {
      const Sweep sweep = sweep_of(R"({"scene": {"box": {"side": 30}}, "sweep": )" +
                                   (in_array ? "[{" + text + "}]" : "{" + text + "}") + "}");
      ASSERT_EQ(sweep.points.size(), n) << text;
      std::set<std::string> ids;
      std::size_t n_long = 0;
      for (const SweepPoint& point : sweep.points) {
        ids.insert(run_id(point.plan));
        if (!point.parameters.contains("rods.length")) continue;
        const bool is_long = point.parameters.at("rods.length") == 4;
        n_long += is_long ? 1 : 0;
        EXPECT_EQ(point.parameters.at("rods.area_fraction").get<double>(), is_long ? 0.4 : 0.3);
      }
      EXPECT_EQ(ids.size(), n) << text;
      EXPECT_EQ(2 * n_long, (chosen & 2) != 0 ? n : 0) << text;
    }
  }
}

TEST(Sweep, ReplicasDifferInTheSeedOnly) {
  const Sweep sweep = sweep_of(R"({"scene": {"time": {"seed": 40}}, "sweep": {"replicas": 3}})");
  EXPECT_THAT(labels(sweep), ElementsAre("replica=1", "replica=2", "replica=3"));
  for (int k = 0; k < 3; ++k) {
    RunPlan plan = sweep.points[k].plan;
    EXPECT_EQ(sweep.points[k].replica, k + 1);
    EXPECT_EQ(plan.system.seed, 40u + k);
    EXPECT_EQ(sweep.points[k].parameters.dump(), "{}");
    plan.system.seed = 1;
    EXPECT_EQ(plan, plan_of("{}"));
  }
  EXPECT_EQ(sweep_of(R"({"sweep": {"replicas": 3}})", {}, 1).points.size(), 1u);
  EXPECT_EQ(sweep_of("{}", {}, 4).points.size(), 4u);
}

TEST(Sweep, StagesAreAChainOfRuns) {
  const Sweep sweep = sweep_of(R"({
    "scene": {"rods": {"start": "random", "area_fraction": 0.4}, "time": {"steady": "1 s", "measure": "2 s"}},
    "sweep": {"grid": {"box.gap": [1.2, 1.4]}, "replicas": 2, "stages": [
      {"time.measure": "3 s"}, {"plates.gamma": "6:5:-0.5", "plates.noise": [0, 1, 2]}, {"time.measure": 4}]}})");
  ASSERT_EQ(sweep.points.size(), 2u * 5 * 2);
  const std::vector<std::string> all = labels(sweep);
  EXPECT_THAT(
      std::vector(all.begin(), all.begin() + 5),
      ElementsAre("box.gap=1.2 stage=1 time.measure=3 replica=1", "box.gap=1.2 stage=1 time.measure=3 replica=2",
                  "box.gap=1.2 stage=2 time.measure=3 plates.gamma=6 plates.noise=0 replica=1",
                  "box.gap=1.2 stage=2 time.measure=3 plates.gamma=6 plates.noise=0 replica=2",
                  "box.gap=1.2 stage=3 time.measure=3 plates.gamma=5.5 plates.noise=1 replica=1"));
  EXPECT_EQ(sweep.points[0].parameters.dump(),
            R"({"box.gap":1.2,"stage":1,"time.measure":3.0,"plates.gamma":7.0,"plates.noise":0.0})");
  EXPECT_EQ(sweep.points[8].parameters.dump(),
            R"({"box.gap":1.2,"stage":5,"time.measure":4.0,"plates.gamma":5.0,"plates.noise":2.0})");
  for (std::size_t i = 0; i < sweep.points.size(); ++i) {
    SCOPED_TRACE(sweep.points[i].label);
    const RunPlan& plan = sweep.points[i].plan;
    EXPECT_EQ(plan.system.seed, 1 + i % 2);
    if (i % 10 < 2) {
      EXPECT_FALSE(plan.start);
      EXPECT_EQ(plan.system.start, Start::kRandom);
      continue;
    }
    ASSERT_TRUE(plan.start);
    EXPECT_EQ(plan.start->run, run_id(sweep.points[i - 2].plan)) << "the same replica, one stage before";
    EXPECT_EQ(plan.start->time, 4) << "when that has been steady for a second and measured for three";
    EXPECT_EQ(plan, plan_of(to_json(plan).dump())) << "a scene like any other";
  }
}

TEST(Sweep, AStageKeepsItsRodsAndMayChangeTheirPacking) {
  const std::string stages = R"("sweep": {"stages": [{}, {"rods.area_fraction": "0.5:0.6:0.1"}]}})";
  const Sweep sweep = sweep_of(R"({"scene": {"rods": {"count": 300, "area_fraction": 0.4}}, )" + stages);
  ASSERT_EQ(sweep.points.size(), 3u);
  for (const SweepPoint& point : sweep.points) EXPECT_EQ(point.plan.system.n_rods, 300);
  EXPECT_GT(sweep.points[0].plan.system.box_side, sweep.points[1].plan.system.box_side);
  EXPECT_GT(sweep.points[1].plan.system.box_side, sweep.points[2].plan.system.box_side);
  EXPECT_EQ(
      sweep_problems(R"({"scene": {"box": {"side": 40}}, )" + stages),
      "s.json:1:60: /stages: stage 2 cannot follow stage 1: not the same in both: their number (a stage that names "
      "rods.area_fraction keeps the rods and changes the box if the scene gives rods.count and not box.side)\n");
}

TEST(Sweep, MistakesInStages) {
  const auto problem = [](const std::string& stages, const std::vector<std::string>& settings = {}) {
    return sweep_problems(R"({"sweep": {"grid": {"box.gap": [1.2]}, "stages": )" + stages + "}}", settings);
  };
  EXPECT_THAT(problem("[]"), HasSubstr("/sweep/stages: names no stage"));
  EXPECT_THAT(problem("{}"), HasSubstr("/sweep/stages: expected an array of objects, not an object"));
  EXPECT_THAT(problem(R"([{}, {"box.gap": 1.3}])"), HasSubstr("/box/gap: swept twice, in \"grid\" at 1:21 too"));
  EXPECT_THAT(problem(R"([{"time.seed": 2}])"), HasSubstr("/time/seed: a stage begins where the one before ends"));
  EXPECT_THAT(problem(R"([{"rods.start": "random"}])"), HasSubstr("/rods/start: a stage begins where"));
  EXPECT_THAT(problem(R"([{"plates.gamma": [5, 6], "plates.noise": [0, 1, 2]}])"),
              HasSubstr("3 values, but another key of this stage has 2; keys of a stage vary together"));
  EXPECT_THAT(problem(R"([{"plates.gamma": "5:7:0.001"}])"), HasSubstr("2001 stages; at most 1000 are allowed"));
  EXPECT_THAT(
      problem(R"([{"time.measure": "1.001 s"}, {"plates.gamma": 6}])"),
      HasSubstr("stage 2 cannot follow stage 1: that ends in the middle of a vibration, at 1.001 s, and the plates "
                "would jump; the nearest whole one is at 1 s"));
  EXPECT_THAT(problem(R"([{"until.order_sem": 0.01}, {}])"), HasSubstr("with `until`, the time at which that ends"));
  EXPECT_THAT(problem(R"([{}, {"walls.arena": "disc"}])"), HasSubstr("the walls"));
  EXPECT_THAT(problem(R"([{"plates.gamma": 6}])", {"plates.gamma=5,6"}), HasSubstr("the file's stages set it"));
  const Sweep overridden =
      sweep_of(R"({"sweep": {"stages": [{"time.measure": 3}, {"time.measure": 4}]}})", {"time.measure=1"});
  for (const SweepPoint& point : overridden.points) EXPECT_EQ(point.plan.measure_time, 1);
}

TEST(Sweep, SettingsOfSeveralValuesAreAxes) {
  EXPECT_THAT(labels(sweep_of("{}", {"rods.length=2.5,3.5 mm", "box.gap=1.2:1.4:0.2", "plates.gamma=6"})),
              ElementsAre("rods.length=2.5 box.gap=1.2", "rods.length=2.5 box.gap=1.4", "rods.length=3.5 box.gap=1.2",
                          "rods.length=3.5 box.gap=1.4"));
  EXPECT_THAT(labels(sweep_of("{}", {"box.gap=[1.2,1.4]"})), ElementsAre("box.gap=1.2", "box.gap=1.4"));
  EXPECT_THAT(labels(sweep_of("{}", {"movie.size=[640,480],[1280,720]"})),
              ElementsAre("movie.size=[640,480]", "movie.size=[1280,720]"));
  // an array as deep as a value of its key is one value
  const std::string bead = R"({"rods": {"length": 1}})";
  EXPECT_EQ(sweep_of(bead, {"rods.bead_diameters=[0.8,0.6]"}).points[0].plan.system.rod.bead_diameters.size(), 2U);
  EXPECT_EQ(sweep_of(bead, {"rods.bead_diameters=[[0.8,0.6],[0.8,0.8]]"}).points.size(), 2U);
  EXPECT_EQ(sweep_of(bead, {"rods.bead_diameters=[[0.8,0.6],null]"}).points.size(), 2U);
  EXPECT_EQ(sweep_of(bead, {"rods.bead_diameters=[null,[0.8,0.6]]"}).points.size(), 2U);
  EXPECT_EQ(sweep_of("{}", {"box.side=20", "posts.places=[[5,5],[10,10]]"}).points.size(), 1U);
  EXPECT_EQ(sweep_of("{}", {"box.side=20", "posts.places=[[[5,5]],[[10,10],[5,15]]]"}).points.size(), 2U);
}

TEST(Sweep, SettingsTakeThePlaceOfGridAxes) {
  const std::string text = R"({"sweep": {"grid": {"rods.length": [2.5, 3.5], "box.gap": [1.2, 1.4]}}})";
  EXPECT_THAT(labels(sweep_of(text, {"rods.length=4.5"})), ElementsAre("box.gap=1.2", "box.gap=1.4"));
  EXPECT_EQ(sweep_of(text, {"rods.length=4.5"}).points[0].plan.system.rod.length, 4.5);
  EXPECT_THAT(labels(sweep_of(text, {"rods.length=4,5", "box.gap=1.5"})),
              ElementsAre("rods.length=4", "rods.length=5"));
  EXPECT_EQ(sweep_problems(R"({"sweep": {"zip": {"rods.length": [2.5, 3.5]}}})", {"rods.length=3"}),
            "-s rods.length=3: /rods/length: the file's \"zip\" sweeps it; a setting cannot take its place\n");
}

TEST(Sweep, ProblemsOfAllPointsAreListedOnce) {
  EXPECT_EQ(sweep_problems(R"({"scene": {"rods": {"lenght": 3}},
 "sweep": {"grid": {"box.gap": [0.7, 1.2, "3 Hz"], "rods.area_fraction": [0.5, 0.6], "plates.gama": [1]},
           "zip": {"rods.length": [2.5, 3.5], "time.seed": [1]}, "replica": 3 }, "names": 1, "box": {} })"),
            "s.json:1:21: /rods/lenght: unknown key; did you mean rods.length?\n"
            "s.json:2:33: /box/gap: a gap of 0.7 mm is too small for rods 0.8 mm thick\n"
            "s.json:2:43: /box/gap: \"Hz\" is a unit of frequency, not of length; use mm, m, cm, um\n"
            "s.json:2:86: /plates/gama: unknown key; did you mean plates.gamma?\n"
            "s.json:3:47: /time/seed: 1 values, but rods.length has 2; paths of a zip vary together\n"
            "s.json:3:66: /sweep/replica: unknown key; did you mean replicas?\n"
            "s.json:3:82: /names: unknown key; did you mean name?\n"
            "s.json:3:94: /box: in a sweep file this belongs into \"scene\"\n");
  EXPECT_EQ(sweep_problems(R"({"sweep": {"product": {}}})"),
            "s.json:1:12: /sweep/product: unknown key; a sweep has replicas, stages, grid, zip, list\n");
}

TEST(Sweep, CombinationsThatCannotBeAreFound) {
  EXPECT_EQ(sweep_problems(R"({"sweep": {"grid": {"rods.length": [4.5, 12], "box.side": [20, 40]}}})"),
            "s.json:1:60: /box/side: a periodic box of 20 mm is too small for rods of 12 mm: at least 26.4 mm\n");
}

TEST(Sweep, StructuralMistakes) {
  EXPECT_EQ(sweep_problems(R"({"sweep": {"grid": {"measure": [1]}}})"),
            "s.json:1:21: /measure: this is an object; sweep the keys in it\n");
  EXPECT_EQ(sweep_problems(R"({"sweep": {"grid": {"box.gap": [1.2]}, "list": [{"box.gap": 1.3}]}})"),
            "s.json:1:50: /box/gap: swept twice, in \"grid\" at 1:21 too\n");
  EXPECT_EQ(sweep_problems(R"({"sweep": [], "name": 3})"),
            "s.json:1:11: /sweep: an array of sweeps needs at least one\ns.json:1:23: /name: expected a text, not the "
            "number 3\n");
  EXPECT_EQ(sweep_problems(R"({"sweep": {"grid": 3, "zip": 4, "list": {}}})"),
            "s.json:1:20: /sweep/grid: expected an object of paths and values, not the number 3\n"
            "s.json:1:30: /sweep/zip: expected an object of paths and values, not the number 4\n"
            "s.json:1:41: /sweep/list: expected an array of objects, not an object\n");
  EXPECT_EQ(sweep_problems(R"({"sweep": {"replicas": 0}})"),
            "s.json:1:24: /sweep/replicas: expected a whole number in [1, 10000], not the number 0\n");
  EXPECT_EQ(sweep_problems("{}", {}, 0), "--replicas 0: 0 is outside [1, 10000]\n");
  EXPECT_EQ(sweep_problems(R"({"sweep": {"grid": {"time.seed": [1, 2]}, "replicas": 2}})"),
            "s.json:1:1: /time/seed: time.seed is swept and there are replicas, which vary it too; remove one\n");
  EXPECT_EQ(sweep_problems(R"({"scene": {"time": {"seed": 9007199254740992}}, "sweep": {"replicas": 2}})"),
            "s.json:1:29: /time/seed: 2 replicas lead past the largest seed, 9007199254740992\n");
  EXPECT_EQ(problem_of(R"({"scene": {}, "sweep": {}})"),
            "run.json:1:15: /sweep: this is a sweep file, for `shaken submit`; a single scene is wanted here");
}

TEST(Sweep, TooManyPointsAreRefused) {
  EXPECT_EQ(sweep_problems(R"({"sweep": {"grid": {"rods.length": "2:4:0.002", "box.gap": "1:2:0.01"}}})"),
            "s.json:1:1: the sweep has more than 100000 points: 1001 (grid) x 101 (grid) x 1 replicas\n");
  std::string grid;
  for (const char* path :
       {"rods.length", "box.gap", "box.side", "plates.gamma", "contacts.rod_rod.friction", "time.step"}) {
    grid += std::string(grid.empty() ? "" : ", ") + "\"" + path + "\": \"1:90000:1\"";
  }
  EXPECT_THAT(sweep_problems(R"({"sweep": {"grid": {)" + grid + "}}}"), HasSubstr("more than 100000 points"));
}

}  // namespace
}  // namespace shaken::scene
