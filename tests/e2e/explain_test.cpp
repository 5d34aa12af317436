// What `shaken explain` and `shaken submit --dry-run` promise, against what runs then take. Without a daemon.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/e2e/run_command.h"
#include "tests/support/good.h"

namespace shaken::test {
namespace {

using ::testing::AllOf;
using ::testing::AnyOf;
using ::testing::HasSubstr;
using ::testing::Not;
using Json = nlohmann::json;

class Explain : public ::testing::Test {
 protected:
  Finished shaken(std::vector<std::string> words) const {
    words.insert(words.begin(), program("shaken"));
    return run_command(words);
  }
  Json json(std::vector<std::string> words) const {
    words.insert(words.end(), {"--cpu", "0.1", "--json"});
    return Json::parse(said_with(0, shaken(std::move(words))));
  }
  std::string write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_.path() / name) << text;
    return (folder_.path() / name).string();
  }
  std::string path(const std::string& name) const { return (folder_.path() / name).string(); }

  ScratchFolder folder_;
};

constexpr const char* kScene = R"({
  "rods": { "length": "2.5 mm", "area_fraction": 0.6 }, "box": { "side": "15 mm" }, "time": { "measure": "1 s" },
  "measure": { "order": {}, "defects": { "every": "20 ms" } }, "trajectory": { "every": "5 ms" }, "stream": null })";

const Json& level_named(const Json& report, const std::string& name) {
  for (const Json& level : report.at("levels")) {
    if (level.at("name") == name) return level;
  }
  throw std::out_of_range(name);
}

TEST_F(Explain, SaysWhatMeasurementsTakeInMemoryAndTheDiskAtTheEnd) {
  const std::string scene = write("scene.json", kScene);
  const Finished finished = shaken({"explain", scene, "--cpu", "0.1"});
  EXPECT_THAT(finished.output, AllOf(HasSubstr("The measurements take about "),
                                     HasSubstr("room for trajectory.part and trajectory.h5 together")));
  EXPECT_THAT(shaken({"explain", scene, "--cpu", "0.1", "-s", "trajectory=null", "-s", "movie=null"}).output,
              Not(HasSubstr("trajectory.part")));
}

TEST_F(Explain, SaysHowThePlatesMove) {
  const std::string scene = write("scene.json", kScene);
  EXPECT_THAT(shaken({"explain", scene, "--no-probe"}).output,
              Not(AnyOf(HasSubstr("second vibration of"), HasSubstr("under a lid"), HasSubstr("inclined by"))));
  const std::vector<std::string> words{"explain",
                                       scene,
                                       "--no-probe",
                                       "-s",
                                       "plates.second.amplitude=12um",
                                       "-s",
                                       "plates.lid_motion={}",
                                       "-s",
                                       "plates.inclination=0.5"};
  EXPECT_THAT(shaken(words).output, AllOf(HasSubstr("with a second vibration of 0.012 mm at 400 Hz"),
                                          HasSubstr("under a lid at rest"), HasSubstr("inclined by 0.5 degrees")));
}

TEST_F(Explain, SaysTheSizesOfAnArena) {
  const std::string scene = write("scene.json", R"({"rods": {"length": "2.5 mm", "area_fraction": 0.3}})");
  const auto of = [&](const char* walls) {
    return shaken({"explain", scene, "--no-probe", "-s", std::string("walls=") + walls}).output;
  };
  EXPECT_THAT(of(R"({"arena": "ellipse", "size": 20, "length": 50})"), HasSubstr("ellipse of 50 mm by 20 mm between"));
  EXPECT_THAT(of(R"({"arena": "wedge", "size": 20, "narrow": 5, "length": 50})"),
              HasSubstr("wedge of 20 mm to 5 mm over 50 mm between"));
  EXPECT_THAT(of(R"({"arena": "channel", "size": 12})"), HasSubstr("channel of 12 mm, periodic after "));
  EXPECT_THAT(of(R"({"arena": "disc", "size": 20})"), HasSubstr("disc of 20 mm between"));
}

TEST_F(Explain, WhatNoMachineHasMemoryForIsRefusedByEveryVerb) {
  const std::string scene = write("fine.json", R"({"rods": {"count": 100}, "box": {"side": 2000},
                                                   "measure": {"defects": {"grid": "0.01 mm"}}, "stream": null})");
  for (const std::vector<std::string>& words : std::vector<std::vector<std::string>>{
           {"validate", scene}, {"explain", scene}, {"run", scene, "--out", path("never")}}) {
    EXPECT_THAT(said_with(2, shaken(words)),
                AllOf(HasSubstr("fine.json: /measure/defects: the measurements of this run would take"),
                      HasSubstr("smaller with a coarser `grid`")))
        << words.front();
  }
  EXPECT_FALSE(std::filesystem::exists(path("never")));
}

TEST_F(Explain, PromisesWhatTheRunThenTakes) {
  const std::string scene = write("scene.json", kScene);
  const Json report = json({"explain", scene});
  expect_end(0, shaken({"run", scene, "--out", path("run")}));
  const Json summary = Json::parse(std::ifstream(path("run/summary.json")));

  EXPECT_EQ(report.at("shown").at("id"), summary.at("run_id"));
  for (const Json& effect : report.at("effects")) {
    const Json& did = summary.at("effects").at(effect.at("name").get<std::string>());
    EXPECT_EQ(effect.at("on"), did.at("on")) << effect;
    EXPECT_FALSE(effect.at("why").get<std::string>().empty());
  }
  EXPECT_EQ(report.at("effects").size(), summary.at("effects").size());

  const Json& written = level_named(report, "as written");
  double bytes = 0;
  for (const char* name : {"trajectory.h5", "observables.h5", "checkpoint.bin"}) {
    bytes += static_cast<double>(std::filesystem::file_size(path("run/") + name));
  }
  EXPECT_NEAR(written.at("disk_bytes").get<double>() / bytes, 1, 0.15);
  // trajectory.part: 24 bytes a frame and 52 a rod, until trajectory.h5 is there
  const Json& disk = report.at("disk_bytes");
  const double part = report.at("shown").at("trajectory_frames").get<double>() *
                      (24 + 52 * report.at("shown").at("n_rods").get<double>());
  EXPECT_NEAR((disk.at("most").get<double>() - disk.at("total").get<double>()) / part, 1, 0.1);
  // other programs may slow down either
  const double cpu = written.at("cpu_seconds").get<double>() / summary.at("cpu_seconds").get<double>();
  EXPECT_GT(cpu, 0.33);
  EXPECT_LT(cpu, 3);

  const double rod_seconds = report.at("shown").at("n_rods").get<double>() * summary.at("sim_seconds").get<double>();
  EXPECT_NEAR(written.at("rod_seconds_per_cpu_second").get<double>() * written.at("cpu_seconds").get<double>(),
              rod_seconds, 0.01 * rod_seconds);

  // the scene is at the level "paper", and a finer step costs more
  EXPECT_EQ(level_named(report, "paper").at("cpu_seconds"), written.at("cpu_seconds"));
  EXPECT_GT(level_named(report, "fine").at("cpu_seconds"), level_named(report, "draft").at("cpu_seconds"));

  // from the state of that run, and not from that of another
  EXPECT_GT(json({"explain", scene, "--from", path("run")}).at("cpu_seconds").get<double>(), 0);
  EXPECT_THAT(said_with(2, shaken({"explain", scene, "--from", path("run"), "-s", "box.gap=1.3"})),
              HasSubstr("another scene"));
}

TEST_F(Explain, AddsUpASweep) {
  const std::string sweep = write("sweep.json", std::string(R"({"scene": )") + kScene +
                                                    R"(, "sweep": {"grid": {"rods.area_fraction": "0.30:0.65:0.05"},
                                                       "replicas": 2}})");
  const Json report = json({"explain", sweep});
  EXPECT_EQ(report.at("n_runs"), 16);
  const Json single = json({"explain", write("scene.json", kScene)});
  const double ratio = level_named(report, "as written").at("cpu_seconds").get<double>() /
                       level_named(single, "as written").at("cpu_seconds").get<double>();
  EXPECT_GT(ratio, 4);  // 16 runs with 12.7 times the rods; those of sparse rods cost less each
  EXPECT_LT(ratio, 25);
  const Finished text = shaken({"explain", sweep, "--cpu", "0.05"});
  EXPECT_THAT(text.output, AllOf(HasSubstr("16 runs"), HasSubstr("as written"), HasSubstr("One of them was probed")));
}

TEST_F(Explain, SaysWhatTheRunsOfEachStepCostWherePointsHaveSeveral) {
  const Json report = json({"explain", write("scene.json", kScene), "-s", "accuracy=draft,paper"});
  const Json& levels = report.at("levels");
  ASSERT_EQ(levels.size(), 3u);
  EXPECT_TRUE(levels[0].at("step_s").is_null()) << "several";
  EXPECT_EQ(levels[1].at("step_s"), 32e-6);
  EXPECT_EQ(levels[2].at("step_s"), 4e-6);
  const auto cpu = [&](int k) { return levels[k].at("cpu_seconds").get<double>(); };
  EXPECT_GT(cpu(1), 0);
  EXPECT_NEAR(cpu(1) + cpu(2), cpu(0), 1e-9 * cpu(0));
}

TEST_F(Explain, LevelsSetWhenImpactsTakePlace) {
  const std::string scene = write("scene.json", kScene);
  const Json report = json({"explain", scene, "-s", "accuracy=fine"});
  EXPECT_EQ(level_named(report, "as written").at("impacts"), "at_instant");
  EXPECT_EQ(level_named(report, "fine").at("impacts"), "at_instant");
  EXPECT_EQ(level_named(report, "fine").at("cpu_seconds"), level_named(report, "as written").at("cpu_seconds"));
  EXPECT_EQ(level_named(report, "desk").at("impacts"), "tick_end");
  EXPECT_EQ(level_named(report, "desk").at("averages_within_percent"), 1);
  // the step of a level with impacts treated in the other way is at no level
  const Finished text = shaken({"explain", scene, "--cpu", "0.05", "-s", "time.impacts=at_instant"});
  EXPECT_THAT(text.output, AllOf(HasSubstr("4 us, at_instant"), HasSubstr("2 us, at_instant"),
                                 HasSubstr("averages within 1 %"), Not(HasSubstr("(\"paper\")"))));
}

TEST_F(Explain, WithoutProbeTellsWhatIsOn) {
  EXPECT_THAT(said_with(0, shaken({"explain", write("scene.json", kScene), "--no-probe", "-s", "gravity=0", "-s",
                                   "plates.amplitude=0", "-s", "accuracy=draft"})),
              AllOf(HasSubstr("gravity = 0 m/s^2"), HasSubstr("measure.msd is absent"), HasSubstr("32 us (\"draft\")"),
                    Not(HasSubstr("CPU"))));
}

TEST_F(Explain, DryRunTellsTheSameAndQueuesNothing) {
  const std::string scene = write("scene.json", kScene);
  // no daemon is there: nothing can be submitted
  const Json report =
      Json::parse(said_with(0, shaken({"submit", scene, "--dry-run", "--json", "--root", path("nowhere")})));
  EXPECT_EQ(report.at("points").size(), 1u);
  const Json& estimate = report.at("estimate");
  const Json explained = json({"explain", scene});
  ASSERT_EQ(estimate.at("levels").size(), explained.at("levels").size());
  for (std::size_t k = 0; k < estimate.at("levels").size(); ++k) {
    EXPECT_EQ(estimate.at("levels")[k].at("step_s"), explained.at("levels")[k].at("step_s"));
    EXPECT_GT(estimate.at("levels")[k].at("cpu_seconds").get<double>(), 0);
  }
  EXPECT_FALSE(std::filesystem::exists(path("nowhere")));
}

TEST_F(Explain, RefusesWhatCannotBe) {
  EXPECT_EQ(shaken({"explain", path("missing.json")}).code, 2);
  EXPECT_EQ(shaken({"explain"}).code, 2);
  const std::string scene = write("scene.json", kScene);
  EXPECT_THAT(said_with(2, shaken({"explain", scene, "--no-probe", "--cpu", "-1", "--from", "x"})),
              AllOf(HasSubstr("--cpu must be"), HasSubstr("--from has no meaning")));
  EXPECT_THAT(said_with(2, shaken({"explain", scene, "-s", "rods.area_fraction=0.92"})), HasSubstr("do not fit"));
  EXPECT_THAT(said_with(2, shaken({"explain", scene, "-s", "accuracy=fine", "-s", "time.step=\"1 us\""})),
              HasSubstr("remove one"));
}

}  // namespace
}  // namespace shaken::test
