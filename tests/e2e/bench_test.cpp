// The benches as they are called, on a handful of rods.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/e2e/run_command.h"
#include "tests/support/good.h"

namespace shaken::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using Json = nlohmann::json;

class Bench : public ::testing::Test {
 protected:
  /// `shaken bench WORDS`, with a cache of its own where it has one.
  Finished bench(std::vector<std::string> words) const {
    words.insert(words.begin(), {program("shaken"), "bench"});
    if (words[2] != "accuracy") words.insert(words.end(), {"--cache", (folder_.path() / "cache").string()});
    return run_command(words);
  }
  std::string out() const { return (folder_.path() / "out").string(); }
  std::string text_of(const std::string& name) const {
    std::stringstream text;
    text << std::ifstream(folder_.path() / "out" / name, std::ios::binary).rdbuf();
    return text.str();
  }
  Json json_of(const std::string& name) const { return Json::parse(text_of(name)); }

 private:
  ScratchFolder folder_;
};

const std::vector<std::string> kTiny{"--length", "4.5",   "--side", "12",       "--warm-up",
                                     "0.05",     "--cpu", "0.01",   "--repeat", "2"};

std::vector<std::string> tiny(std::vector<std::string> words) {
  words.insert(words.end(), kTiny.begin(), kTiny.end());
  return words;
}

TEST_F(Bench, SpeedWritesWhatItMeasured) {
  EXPECT_THAT(said_with(0, bench(tiny({"speed", "--area-fraction", "0.45,0.6", "--out", out()}))),
              AllOf(HasSubstr("NOT the steady state"), HasSubstr("rod-seconds per CPU-second")));
  const Json report = json_of("speed.json");
  ASSERT_EQ(report.at("rows").size(), 2u);
  for (const Json& row : report.at("rows")) {
    EXPECT_EQ(row.at("scheduled").at("state_hash"), row.at("reference").at("state_hash"));
    EXPECT_TRUE(row.at("hashes_equal").get<bool>());
    EXPECT_GT(row.at("scheduled").at("rod_s_per_cpu_s").get<double>(), 0);
    EXPECT_EQ(row.at("scheduled").at("cpu_s").size(), 2u);
    const Json& counts = row.at("per_rod_second");
    EXPECT_GT(counts.at("rods_visited").get<double>(), 0);
    EXPECT_GE(counts.at("rods_visited").get<double>(), counts.at("rods_hit").get<double>());
    // The time of a phase is what its readings add up to less what the readings themselves cost, so that of a few
    // milliseconds of work it may come out below zero: that it is a number is all that holds on any machine.
    EXPECT_TRUE(row.at("ns").at("rods_visited").is_number()) << row;
  }
  std::istringstream csv(text_of("speed.csv"));
  std::string titles;
  std::getline(csv, titles);
  const auto n_columns = std::count(titles.begin(), titles.end(), ',');
  int rows = 0;
  for (std::string line; std::getline(csv, line); ++rows) {
    line.erase(0, line.rfind('"') + 1);  // the scene, whose name has commas
    EXPECT_EQ(std::count(line.begin(), line.end(), ','), n_columns);
  }
  EXPECT_EQ(rows, 2);
  EXPECT_EQ(text_of("speed.png").substr(1, 3), "PNG");
}

TEST_F(Bench, SpeedByKindOfScene) {
  const Finished finished =
      bench({"speed", "--kinds", "--warm-up", "0.002", "--cpu", "0.001", "--repeat", "1", "--out", out()});
  ASSERT_EQ(finished.code, 0) << finished.output;
  const Json report = json_of("kinds.json");
  ASSERT_GT(report.at("rows").size(), 10u);
  for (const Json& row : report.at("rows")) {
    EXPECT_GT(row.at("scheduled").at("rod_s_per_cpu_s").get<double>(), 0) << row.at("scene");
    EXPECT_GT(row.at("per_rod_second").at("rods_visited").get<double>(), 0) << row.at("scene");
  }
  EXPECT_EQ(report.at("rows").at(0).at("relative_cost").get<double>(), 1);
  EXPECT_EQ(text_of("kinds.png").substr(1, 3), "PNG");
}

TEST_F(Bench, SpeedByKindOfSceneHasItsOwnScenes) {
  for (const std::vector<std::string>& more : {std::vector<std::string>{"--length", "2.5"},
                                               {"--area-fraction", "0.5"},
                                               {"--side", "20"},
                                               {"--full"},
                                               {"--scaling", "n"},
                                               {"--threads", "1"}}) {
    std::vector<std::string> words{"speed", "--kinds"};
    words.insert(words.end(), more.begin(), more.end());
    EXPECT_EQ(bench(words).code, 2) << more.front();
  }
}

TEST_F(Bench, SpeedOfThreadsAndStepsToo) {
  Finished finished = bench(tiny({"speed", "--area-fraction", "0.6", "--threads", "1,2", "--out", out()}));
  ASSERT_EQ(finished.code, 0) << finished.output;
  EXPECT_TRUE(json_of("threads.json").at("rows").at(1).at("hashes_equal").get<bool>());
  finished = bench(tiny({"speed", "--scaling", "dt", "--out", out()}));
  ASSERT_EQ(finished.code, 0) << finished.output;
  EXPECT_EQ(json_of("scaling_dt.json").at("rows").size(), 6u);
}

TEST_F(Bench, AccuracyWritesErrorsAndOrders) {
  const Finished finished =
      bench({"accuracy", "--cases", "head-on,dozen", "--steps", "64,32,16,8", "--members", "4", "--out", out()});
  ASSERT_EQ(finished.code, 0) << finished.output;
  EXPECT_THAT(finished.output, AllOf(HasSubstr("Order of convergence"), HasSubstr("Converged solutions")));
  const Json report = json_of("accuracy.json");
  ASSERT_EQ(report.at("converged").size() % 2, 0u);
  ASSERT_EQ(report.at("rows").size(), 4 * report.at("converged").size());
  EXPECT_EQ(report.at("converged").at(0).at("dt_s"), 125e-9);
  for (const Json& row : report.at("rows")) {
    EXPECT_GT(row.at("error").at("position").at("median").get<double>(), 0);
    EXPECT_TRUE(row.at("states_equal").get<bool>());
  }
  EXPECT_EQ(text_of("convergence.png").substr(1, 3), "PNG");
  EXPECT_EQ(text_of("work_precision.png").substr(1, 3), "PNG");
}

TEST_F(Bench, AccuracyShowsItsRowsWhereNothingCanTellWhatTheyComeTo) {
  ::setenv("SHAKEN_PYTHON", "/bin/false", 1);
  const Finished finished = bench({"accuracy", "--cases", "head-on", "--steps", "64,32", "--members", "2"});
  ::unsetenv("SHAKEN_PYTHON");
  ASSERT_EQ(finished.code, 0) << finished.output;
  EXPECT_THAT(finished.output, AllOf(HasSubstr("no verdict: "), HasSubstr("\nhead-on,newton,0.004096,2,3.2e-05,")));
}

TEST_F(Bench, AccuracyRefusesWhatItDoesNotKnow) {
  const auto refused = [&](std::vector<std::string> words) {
    words.insert(words.begin(), "accuracy");
    return said_with(2, bench(std::move(words)));
  };
  EXPECT_THAT(refused({"--cases", "head-on,sideways"}), HasSubstr("--cases: sideways not in {rattling,"));
  EXPECT_THAT(refused({"--steps", "64,3"}), HasSubstr("--steps: 3 is not 64 us halved"));
}

TEST_F(Bench, ExportGivesAState) {
  const Finished finished =
      bench({"export", "--side", "12", "--warm-up", "0.005", "--frames", "2", "--out", out() + ".json"});
  ASSERT_EQ(finished.code, 0) << finished.output;
  const Json state = Json::parse(std::ifstream(out() + ".json"));
  const auto n = state.at("n_rods").get<std::size_t>();
  EXPECT_EQ(state.at("start").at("position").size(), n);
  EXPECT_EQ(state.at("frames").size(), 2u);
  EXPECT_EQ(state.at("frames").at(1).at("angular_velocity").size(), n);
  EXPECT_NEAR(state.at("frames").at(1).at("time").get<double>(), 0.007, 1e-9);
}

TEST_F(Bench, EffectsAreSwitchedOffOneByOne) {
  EXPECT_THAT(said_with(0, bench({"effects", "--side", "12", "--area-fraction", "0.5", "--warm-up", "0.02", "--cpu",
                                  "0.01", "--repeat", "2", "--out", out()})),
              AllOf(HasSubstr("rod_rod_friction"), HasSubstr("contacts.rod_rod.friction = 0")));
  const Json report = json_of("effects.json");
  EXPECT_GE(report.at("rows").size(), 10u);
  for (const Json& row : report.at("rows")) {
    EXPECT_GT(row.at("own_state").at("cpu_ratio").get<double>(), 0) << row;
    EXPECT_EQ(row.at("own_state").at("cpu_s").size(), 2u);
    const bool is_of_contacts = row.at("neutral").get<std::string>().starts_with("contacts.");
    if (is_of_contacts) {
      EXPECT_GT(row.at("same_state").at("cpu_ratio").get<double>(), 0) << row;
    }
    EXPECT_EQ(row.at("without") == "(nothing)", row.at("neutral") == "") << row;
  }
  EXPECT_EQ(text_of("effects.png").substr(1, 3), "PNG");
  EXPECT_THAT(text_of("effects.csv"), HasSubstr("cpu_ratio"));
  EXPECT_EQ(bench({"effects", "--length", "0", "--repeat", "x"}).code, 2);
}

TEST_F(Bench, HardScenesHaveAHistory) {
  const auto history = [&](std::vector<std::string> words) {
    words.insert(words.begin(), {program("shaken"), "bench", "hard", "--history", "0.02"});
    return run_command(words);
  };
  EXPECT_THAT(said_with(0, history({"three-beads", "sticky-below", "--out", out()})),
              HasSubstr("sticky-below, after 0.02 s: overlap"));
  const Json rows = json_of("hard_history.json").at("rows");
  ASSERT_EQ(rows.size(), 400u);
  EXPECT_EQ(rows.at(399).at("case"), "sticky-below");
  EXPECT_LT(rows.at(399).at("energy_unaccounted").get<double>(), 1e-10);
  EXPECT_EQ(text_of("hard_history.png").substr(1, 3), "PNG");
  EXPECT_EQ(history({}).code, 2);
  EXPECT_THAT(said_with(2, history({"rest", "row", "upright"})),
              AllOf(HasSubstr("'row'"), HasSubstr("'upright'"), Not(HasSubstr("'rest'"))))
      << "no scenes, but rods placed by hand";
  EXPECT_EQ(history({"rest", "--seconds", "1"}).code, 2);
}

TEST_F(Bench, BadArgumentsAreRefused) {
  const auto refused = [&](std::vector<std::string> words) {
    words.insert(words.begin(), "speed");
    return said_with(2, bench(std::move(words)));
  };
  EXPECT_THAT(refused({"--length", "x"}), HasSubstr("--length: 'x' is not a number"));
  EXPECT_THAT(refused({"--area-fraction", "0.99"}), HasSubstr("--area-fraction: 0.99 is outside"));
  EXPECT_THAT(refused({"--repeat", "0"}), HasSubstr("--repeat: 0 is outside"));
  EXPECT_THAT(refused({"--scaling", "z"}), HasSubstr("--scaling: z not in {n,dt}"));
  EXPECT_THAT(refused({"--scaling", "n", "--length", "4,5"}), HasSubstr("one value each"));
  EXPECT_THAT(refused({"--side", "5"}), HasSubstr("too small for rods of 4.5 mm"));
  EXPECT_EQ(bench({"sped"}).code, 2);
  EXPECT_EQ(bench({"speed", "--side"}).code, 2);
}

}  // namespace
}  // namespace shaken::test
