#include "scene/length.h"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "scene/canonical.h"
#include "tests/unit/scene/scene_support.h"

namespace shaken::scene {
namespace {

RunPlan random_length() {
  RunPlan plan;
  plan.measure_time = *rc::gen::inRange(1, 5);
  if (*rc::gen::arbitrary<bool>()) plan.until = Until{0.001 * *rc::gen::inRange(1, 4), 1.0 * *rc::gen::inRange(5, 9)};
  return plan;
}

TEST(Length, OfTwoScenesIsTheLongerOfEach) {
  EXPECT_TRUE(rc::check("as_long_as_both is a least upper bound", [] {
    const RunPlan a = random_length(), b = random_length(), c = random_length();
    const RunPlan both = as_long_as_both(a, b);
    RC_ASSERT(both == as_long_as_both(b, a));
    RC_ASSERT(as_long_as_both(both, c) == as_long_as_both(a, as_long_as_both(b, c)));
    RC_ASSERT(!asks_for_more(a, both) && !asks_for_more(b, both));
    RC_ASSERT(as_long_as_both(a, a) == a && !asks_for_more(a, a));
    if (!asks_for_more(a, b)) RC_ASSERT(both == b);
    RC_ASSERT(both.longest_time() == std::max(a.longest_time(), b.longest_time()));
  }));
}

TEST(Length, MustMakeSense) {
  const auto problems = [](const char* text) {
    const Loaded<RunPlan> plan = load_scene(text, "f");
    return plan ? std::string() : to_string(plan.error());
  };
  EXPECT_EQ(problems(R"({"until": {}})"), "");
  EXPECT_NE(problems(R"({"until": {}, "measure": {"order": null}})").find("measure.order"), std::string::npos);
  EXPECT_NE(problems(R"({"until": {"at_most": 5}, "time": {"measure": 6}})").find("shorter than time.measure 6 s"),
            std::string::npos);
}

TEST(Start, FromAnotherRunIsPartOfWhatARunIs) {
  const std::string text = R"({"start": {"run": "0123456789abcdef", "time": "20 s"}})";
  const RunPlan plan = plan_of(text);
  ASSERT_EQ(plan.start, (StartState{"0123456789abcdef", 20}));
  EXPECT_EQ(plan_of(to_json(plan).dump()), plan);
  EXPECT_NE(run_id(plan), run_id(plan_of("{}")));
  EXPECT_NE(run_id(plan), run_id(plan_of(text, {"start.time=21"})));
  EXPECT_EQ(plan_of("{}", {"start.run=1234567890123456", "start.time=20"}).start->run, "1234567890123456")
      << "an id of digits only";
  EXPECT_FALSE(to_json(plan_of("{}")).contains("start")) << "older scenes keep their names";
}

TEST(Start, MustBeWholeAndUnderstood) {
  EXPECT_EQ(problems_of(R"({"start": {}})").size(), 2U);
  EXPECT_NE(problem_of(R"({"start": {"run": "0123456789abcdef"}})").find("start.time is missing"), std::string::npos);
  for (const char* id : {"\"0123456789abcde\"", "\"0123456789ABCDEF\"", "\"s1\"", "true", "[1]"}) {
    const std::string text = std::string(R"({"start": {"time": 1, "run": )") + id + "}}";
    EXPECT_NE(problem_of(text).find("expected the id of a run, 16 hex digits"), std::string::npos) << id;
  }
  const char* both = R"({"rods": {"start": "random"}, "start": {"run": "0123456789abcdef", "time": 1}})";
  EXPECT_NE(problem_of(both).find("remove rods.start or start"), std::string::npos);
  const char* angle = R"({"rods": {"start_angle": 30}, "start": {"run": "0123456789abcdef", "time": 1}})";
  EXPECT_NE(problem_of(angle).find("remove rods.start_angle or start"), std::string::npos);
}

TEST(Start, HasAnAngleWhereThereAreRowsInAPeriodicBox) {
  const RunPlan plan = plan_of("{}", {"rods.start_angle=30"});
  EXPECT_EQ(plan.system.start_angle, 30);
  EXPECT_EQ(to_json(plan)["rods"]["start_angle"], 30.0);
  EXPECT_NE(run_id(plan), run_id(plan_of("{}")));
  EXPECT_EQ(run_id(plan_of("{}", {"rods.start_angle=0"})), run_id(plan_of("{}"))) << "older scenes keep their names";
  EXPECT_FALSE(to_json(plan_of("{}"))["rods"].contains("start_angle"));
  EXPECT_FALSE(load_scene("{}", "s", std::vector<std::string>{"rods.start_angle=91"}));
  EXPECT_NE(problem_of("{}", {"rods.start_angle=30", "rods.start=compressed"}).find("only rods that start in rows"),
            std::string::npos);
  EXPECT_NE(problem_of("{}", {"rods.start_angle=30", "walls={}"}).find("remove rods.start_angle or walls"),
            std::string::npos);
}

TEST(Start, CompressesPeriodicBoxesToAnAreaFractionOf085) {
  const RunPlan plan = plan_of("{}", {"rods.start=compressed", "rods.area_fraction=0.85"});
  EXPECT_EQ(plan.system.start, Start::kCompressed);
  EXPECT_NE(run_id(plan), run_id(plan_of("{}", {"rods.area_fraction=0.85"})));
  EXPECT_NE(problem_of("{}", {"rods.start=compressed", "rods.area_fraction=0.87"}).find("by compression at most 0.86"),
            std::string::npos);
  EXPECT_NE(problem_of("{}", {"rods.start=compressed", "walls={}"}).find("or remove walls"), std::string::npos);
}

TEST(Start, OfDomainsAndOfAPairOfDefectsHasKeysOfItsOwn) {
  const RunPlan domains = plan_of("{}", {"rods.start=polydomain", "rods.start_domains=7"});
  EXPECT_EQ(domains.system.start, Start::kPolydomain);
  EXPECT_EQ(domains.system.start_domains, 7);
  EXPECT_EQ(to_json(domains)["rods"]["start_domains"], 7);
  EXPECT_EQ(to_json(plan_of("{}", {"rods.start=polydomain"}))["rods"]["start_domains"], 4);
  const RunPlan pair = plan_of("{}", {"rods.start=defect_pair", "box.side=30", "box.aspect=2", "rods.start_angle=90"});
  EXPECT_EQ(pair.system.start_separation, 30) << "half the longer side";
  EXPECT_EQ(to_json(pair)["rods"]["start_separation"], 30.0);
  EXPECT_EQ(to_json(pair)["rods"]["start_angle"], 90.0);
  EXPECT_FALSE(to_json(pair)["rods"].contains("start_domains"));
  EXPECT_EQ(run_id(plan_of("{}", {"rods.start=defect_pair", "box.side=30", "rods.start_separation=15"})),
            run_id(plan_of("{}", {"rods.start=defect_pair", "box.side=30"})));
  for (const char* start : {"aligned", "random", "compressed"}) {
    const auto rods = to_json(plan_of("{}", {std::string("rods.start=") + start, "rods.area_fraction=0.3"}))["rods"];
    EXPECT_FALSE(rods.contains("start_domains") || rods.contains("start_separation"))
        << "older scenes keep their names";
  }
}

TEST(Start, OfDomainsAndOfAPairOfDefectsIsRefusedWhereItMakesNoSense) {
  const auto expect_refused = [](const std::vector<std::string>& settings, const char* why) {
    EXPECT_NE(problem_of("{}", settings).find(why), std::string::npos) << problem_of("{}", settings);
  };
  const std::string domains = "rods.start=polydomain", pair = "rods.start=defect_pair", small = "box.side=25";
  expect_refused({"rods.start_domains=3"}, "only a polydomain start has domains");
  expect_refused({"rods.start_separation=9"}, "only a pair of defects has a separation");
  expect_refused({domains, "rods.start_separation=9"}, "only a pair of defects has a separation");
  expect_refused({domains, "rods.start_angle=9"}, "only rods that start in rows, and the director beyond a pair");
  expect_refused({domains, small, "rods.start_domains=50"}, "at most 30 have room");
  EXPECT_EQ(plan_of("{}", {domains, small, "rods.start_domains=30"}).system.start_domains, 30);
  expect_refused({pair, small, "rods.start_separation=13"}, "at most half its longer side, 12.5 mm");
  expect_refused({pair, small, "rods.start_separation=4"}, "at least 4.5 mm");
  for (const std::string& start : {domains, pair}) {
    expect_refused({start, "walls={}"}, "what is compressed is a periodic box");
    expect_refused({start, "rods.beads=1"}, "spheres have no director");
    expect_refused({start, "rods.area_fraction=0.88"}, "by compression at most 0.86");
  }
  EXPECT_NE(problem_of(R"({"rods": {"start_domains": 3}, "start": {"run": "0123456789abcdef", "time": 1}})")
                .find("remove rods.start_domains or start"),
            std::string::npos);
}

}  // namespace
}  // namespace shaken::scene
