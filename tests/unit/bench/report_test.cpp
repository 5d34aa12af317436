// SPDX-License-Identifier: MIT
#include "bench/report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "bench/bench.h"
#include "bench/speed.h"

namespace shaken::bench {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

Contender contender(double cpu) {
  Contender of{.scene = make_case(4.5, 0.6, 12, kPaperStep, 5), .state = {}};
  of.speed.ticks = 1250;
  of.speed.cpu = {cpu * 1.5, cpu, cpu * 1.1};
  of.speed.wall = of.speed.cpu;
  of.speed.rod_seconds = 10;
  of.speed.plate_impulses = 900;
  of.speed.rod_impulses = 100;
  return of;
}

SceneSpeed scene() {
  SceneSpeed speed{contender(0.1), contender(2)};
  speed.phases.fill(0.01);
  speed.phases_cpu = 0.1;
  speed.bounds = {1e-5, 2e-5, 1e-6};
  return speed;
}

TEST(Table, ShowsMembersOfRowsInTheirFormats) {
  const Json rows = Json::parse(R"([{"n": 12, "of": {"mean": 0.12345, "sem": 0.002}, "same": true, "why": "so"},
                                    {"n": 3, "of": {"mean": -1, "sem": 0.5}, "same": false}])");
  EXPECT_EQ(table(rows, {{"N", "n"},
                         {"%", "of/mean", "{:.1f}", 100},
                         {"mean", "of/mean", "{:.2f} +- {:.1g}", 1, "of/sem"},
                         {"same", "same"},
                         {"why", "why"}}),
            " N       %           mean  same  why\n"
            "12    12.3  0.12 +- 0.002   yes  so\n"
            " 3  -100.0   -1.00 +- 0.5    NO  -\n");
}

TEST(Csv, NamesNestedValuesWithDots) {
  EXPECT_EQ(csv(Json::parse(R"([{"a": {"b": 1, "c": "x"}, "d": [1, 2]}, {"a": {"b": 2, "c": "y"}, "d": [3, 4]}])")),
            "a.b,a.c,d\n1,x,1 2\n2,y,3 4\n");
  EXPECT_EQ(csv(Json::parse(R"([{"a": "x, \"y\""}])")), "a\n\"x, \"\"y\"\"\"\n");
}

/// What the options of a bench read, or the words of the error.
struct Asked {
  double side = 20;
  int repeat = 5;
  std::vector<double> lengths;
  std::string problem;
};
Asked asked(std::vector<std::string> words) {
  Asked asked;
  CLI::App app;
  add_number(app, "--side", asked.side, "MM", {9, 500}, "");
  add_number(app, "--repeat", asked.repeat, "N", {1, 10}, "");
  add_number(app, "--length", asked.lengths, "LIST", {0, 50}, "");
  try {
    std::reverse(words.begin(), words.end());
    app.parse(words);
  } catch (const CLI::ParseError& error) {
    asked.problem = error.what();
  }
  return asked;
}

TEST(Options, AreNumbersWithinTheirRanges) {
  EXPECT_EQ(asked({}).side, 20);
  EXPECT_EQ(asked({"--side", "12.5"}).side, 12.5);
  EXPECT_EQ(asked({"--length", "4.5,2.5"}).lengths, (std::vector{4.5, 2.5}));
  EXPECT_THAT(asked({"--side", "5"}).problem, HasSubstr("--side: 5 is outside [9, 500]"));
  EXPECT_THAT(asked({"--side", "long"}).problem, HasSubstr("--side: 'long' is not a number"));
  EXPECT_THAT(asked({"--length", "4.5,60"}).problem, HasSubstr("--length: 60 is outside [0, 50]"));
  EXPECT_THAT(asked({"--repeat", "2.5"}).problem, HasSubstr("--repeat = 2.5"));
}

TEST(Report, OfScenesHasRatesRatioAndBounds) {
  const auto row = speed_report({}, {scene()}).rows().at(0);
  EXPECT_DOUBLE_EQ(row.at("scheduled").at("rod_s_per_cpu_s"), 100);
  EXPECT_DOUBLE_EQ(row.at("scheduled").at("spread"), 1.1);
  EXPECT_DOUBLE_EQ(row.at("scheduled").at("ns_per_impulse"), 1e5);
  EXPECT_DOUBLE_EQ(row.at("ratio"), 20);
  EXPECT_DOUBLE_EQ(row.at("phase_shares").at("pair_bounds"), 0.1);
  EXPECT_DOUBLE_EQ(row.at("lower_bounds").at("impulses_alone_share"), (900 * 1e-5 + 100 * 2e-5) / 0.1);
  EXPECT_DOUBLE_EQ(row.at("lower_bounds").at("memory_alone_share"), (900 + 2 * 100) * 1e-6 / 0.1);
}

TEST(Report, SaysWhatIsNotTheSteadyState) {
  Conditions conditions;
  conditions.warm_up = 0.5;
  EXPECT_THAT(speed_report(conditions, {scene()}).text, HasSubstr("NOT the steady state"));
  conditions.warm_up = Conditions::kSteady;
  EXPECT_THAT(speed_report(conditions, {scene()}).text, Not(HasSubstr("NOT the steady state")));
}

TEST(Report, SaysIfTheSteppersDiffer) {
  SceneSpeed differs = scene();
  EXPECT_THAT(speed_report({}, {differs}).text, Not(HasSubstr("NO\n")));
  check_states(speed_report({}, {differs}), "they differ");
  differs.scheduled_hash = 1;
  differs.compared_ticks = 9;
  const Report report = speed_report({}, {differs});
  EXPECT_THAT(report.text, HasSubstr("NO\n"));
  EXPECT_THAT([&] { check_states(report, "they differ"); },
              testing::ThrowsMessage<Failure>("l = 4.5 mm, phi = 0.6, L = 12 mm: they differ after 9 ticks"));
}

TEST(Report, OfWorkIsPerRodSecondAndPerPiece) {
  CountedWork counted;
  counted.of = contender(0.1);
  counted.of.ticks = 1000;
  counted.counts.fill(500);
  counted.phases.fill(1e-3);
  counted.bounds.hulls = {.of_true_time = {0.5, 0.25, 1, 0.5, 0.75, 0.5, 0.25, 0.5}, .of_no_tick = 1};
  const Report report = count_report({}, {counted});
  const Json& row = report.rows().at(0);
  EXPECT_DOUBLE_EQ(row.at("per_rod_second").at("pairs_bounded"), 500 / counted.of.scene.rod_seconds(1000));
  EXPECT_DOUBLE_EQ(row.at("ns").at("rods_visited"), 2000);
  EXPECT_DOUBLE_EQ(row.at("hulls").at("median"), 0.5);
  EXPECT_TRUE(row.at("beads").is_null());
  EXPECT_THAT(report.text, HasSubstr("12.5"));
}

TEST(Report, OfScalingIsRelativeToTheFirst) {
  const Report report = scaling_report({}, Scaling::kStep, {contender(0.1), contender(0.15)});
  EXPECT_DOUBLE_EQ(report.rows().at(0).at("relative_cost"), 1);
  EXPECT_DOUBLE_EQ(report.rows().at(1).at("relative_cost"), 1.5);
}

TEST(Report, OfThreadsNamesTheSpeedUpAndItsLimit) {
  ThreadsSpeed speed{.by = {contender(0.2), contender(0.1)}, .serial = 0.25};
  speed.by[1].threads = 4;
  const Report report = threads_report({}, {speed});
  EXPECT_DOUBLE_EQ(report.rows().at(1).at("speed_up"), 2);
  EXPECT_DOUBLE_EQ(report.rows().at(0).at("limit"), 1);
  EXPECT_DOUBLE_EQ(report.rows().at(1).at("limit"), 1 / (0.25 + 0.75 / 4));
  check_states(report, "");
  speed.by[1].hash = 8;
  EXPECT_FALSE(threads_report({}, {speed}).rows().at(1).at("hashes_equal"));
}

}  // namespace
}  // namespace shaken::bench
