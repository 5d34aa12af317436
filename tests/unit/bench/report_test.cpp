// SPDX-License-Identifier: MIT
#include "bench/speed/report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/table.h"

namespace shaken::bench {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

EngineSpeed engine(double cpu) {
  EngineSpeed speed;
  speed.ticks = 1250;
  speed.cpu = {cpu * 1.5, cpu, cpu * 1.1};
  speed.wall = speed.cpu;
  speed.rod_seconds = 10;
  speed.plate_impulses = 900;
  speed.rod_impulses = 100;
  return speed;
}

SceneSpeed scene() {
  SceneSpeed speed;
  OptionReader options;
  speed.scene = *make_case(4.5, 0.6, 12, 4e-6, 5, options);
  speed.scheduled = engine(0.1);
  speed.reference = engine(2);
  speed.phases.fill(0.01);
  speed.phases_cpu = 0.1;
  speed.bounds = {1e-5, 2e-5, 1e-6};
  return speed;
}

TEST(Table, ColumnsAreFlushRight) { EXPECT_EQ(aligned({{"a", "bcd"}, {"12", "3"}}), " a  bcd\n12    3\n"); }

TEST(Csv, NamesNestedValuesWithDots) {
  EXPECT_EQ(as_csv(nlohmann::ordered_json::parse(R"([{"a": {"b": 1, "c": "x"}, "d": [1, 2]},
                                                      {"a": {"b": 2, "c": "y"}, "d": [3, 4]}])")),
            "a.b,a.c,d\n1,x,1 2\n2,y,3 4\n");
  EXPECT_EQ(as_csv(nlohmann::ordered_json::parse(R"([{"a": "x, \"y\""}])")), "a\n\"x, \"\"y\"\"\"\n");
}

TEST(Report, OfScenesHasRatesRatioAndBounds) {
  const auto row = as_json({}, std::vector{scene()}).at("rows").at(0);
  EXPECT_DOUBLE_EQ(row.at("scheduled").at("rod_s_per_cpu_s"), 100);
  EXPECT_DOUBLE_EQ(row.at("scheduled").at("spread"), 1.1);
  EXPECT_DOUBLE_EQ(row.at("scheduled").at("ns_per_impulse"), 1e5);
  EXPECT_DOUBLE_EQ(row.at("ratio"), 20);
  EXPECT_DOUBLE_EQ(row.at("phase_shares").at("bounds"), 0.1);
  EXPECT_DOUBLE_EQ(row.at("lower_bounds").at("impulses_alone_share"), (900 * 1e-5 + 100 * 2e-5) / 0.1);
  EXPECT_DOUBLE_EQ(row.at("lower_bounds").at("memory_alone_share"), (900 + 2 * 100) * 1e-6 / 0.1);
}

TEST(Report, SaysWhatIsNotTheSteadyState) {
  Conditions conditions;
  conditions.warm_up = 0.5;
  EXPECT_THAT(as_text(conditions, std::vector{scene()}), HasSubstr("NOT the steady state"));
  conditions.warm_up = Conditions::kSteady;
  EXPECT_THAT(as_text(conditions, std::vector{scene()}), Not(HasSubstr("NOT the steady state")));
}

TEST(Report, SaysIfTheEnginesDiffer) {
  SceneSpeed differs = scene();
  EXPECT_THAT(as_text({}, std::vector{differs}), Not(HasSubstr("NO\n")));
  differs.scheduled_hash = 1;
  EXPECT_THAT(as_text({}, std::vector{differs}), HasSubstr("NO\n"));
}

TEST(Report, OfScalingIsRelativeToTheFirst) {
  Scaling scaling{Scaling::Of::kStep, {{scene().scene, engine(0.1)}, {scene().scene, engine(0.15)}}};
  const auto rows = as_json({}, scaling).at("rows");
  EXPECT_DOUBLE_EQ(rows.at(0).at("relative_cost"), 1);
  EXPECT_DOUBLE_EQ(rows.at(1).at("relative_cost"), 1.5);
}

TEST(Report, OfThreadsNamesTheSpeedUp) {
  ThreadsSpeed threads{scene().scene, {{1, engine(0.2), 7}, {2, engine(0.1), 7}}};
  EXPECT_TRUE(threads.hashes_equal());
  EXPECT_DOUBLE_EQ(as_json({}, std::vector{threads}).at("rows").at(1).at("speed_up"), 2);
  threads.points[1].hash = 8;
  EXPECT_FALSE(threads.hashes_equal());
}

}  // namespace
}  // namespace shaken::bench
