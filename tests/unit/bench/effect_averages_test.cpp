// SPDX-License-Identifier: MIT
#include "bench/effect_averages.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "base/failure.h"

namespace shaken::bench {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

Averages all_of(const Estimate& one) {
  Averages averages;
  averages.fill(one);
  return averages;
}

TEST(EffectAverages, TheErrorOfARatioIsThatOfBothNumbers) {
  const Estimate ratio = ratio_of({6, 0.6}, {2, 0.1});
  EXPECT_DOUBLE_EQ(ratio.value, 3);
  EXPECT_DOUBLE_EQ(ratio.sem, std::hypot(0.6, 3 * 0.1) / 2);
  EXPECT_DOUBLE_EQ(ratio_of({0, 0.4}, {-2, 0.1}).sem, 0.2) << "a drift that vanished has an error still";
  EXPECT_DOUBLE_EQ(ratio_of({1, 0.4}, {-2, 0}).value, -0.5);
  EXPECT_TRUE(std::isnan(ratio_of({1, 0.4}, {0, 0.1}).value));
  EXPECT_TRUE(std::isnan(ratio_of({}, {2, 0.1}).value));
}

TEST(EffectAverages, ARowIsRelativeToEverything) {
  const Json row = averages_row("tilt", "no base", all_of({1, 0.3}), all_of({2, 0}));
  EXPECT_EQ(row.at("without"), "tilt");
  EXPECT_EQ(row.at("averages").at("S").at("value"), 1);
  EXPECT_EQ(row.at("relative").at("drift").at("value"), 0.5);
  EXPECT_EQ(row.at("relative").at("drift").at("sem"), 0.15);
  EXPECT_TRUE(averages_row("tilt", "", all_of({}), all_of({2, 0})).at("relative").at("S").at("value").is_null());
}

TEST(EffectAverages, TextNamesWhatIsNotSteady) {
  const auto text = [](std::optional<bool> steady) {
    Averages averages = all_of({1, 0.1});
    averages[3].steady = steady;
    return averages_text({{"everything", json_of(all_of({2, 0.1}))},
                          {"rows", Json::array({averages_row("gravity", "g = 0", averages, all_of({2, 0.1}))})}});
  };
  EXPECT_THAT(text(false), HasSubstr("Not steady without gravity: S\n"));
  EXPECT_THAT(text(false), HasSubstr("50.0"));
  EXPECT_THAT(text(true), Not(HasSubstr("Not steady")));
  EXPECT_THAT(text(std::nullopt), Not(HasSubstr("Not steady")));
}

/// A rod in free flight without gravity and plates: all of its averages are known.
TEST(EffectAverages, OfARodInFreeFlight) {
  System scene;
  scene.n_rods = 1;
  scene.box_side = 30;
  scene.gravity = 0;
  scene.base = scene.lid = false;
  scene.amplitude = 0;
  Simulation simulation = begin_with(scene, {thrown(Vec3(15, 15, 1), Vec3::UnitX(), Vec3(3, 4, 0))});
  ObservableSeries series;
  for (int k = 0; k < 40; ++k) {
    advance(simulation, std::llround(ObservableSeries::kEvery / scene.dt));
    series.sample(simulation);
  }
  const Averages averages = averages_of(series);
  EXPECT_DOUBLE_EQ(averages[0].value, 12.5) << "T_xy: the mean square of a component";
  EXPECT_EQ(averages[1].value, 0) << "T_z";
  EXPECT_EQ(averages[1].sem, 0) << "nothing scatters";
  EXPECT_NEAR(averages[3].value, 1, 1e-12) << "S";
  EXPECT_TRUE(std::isnan(averages[5].value)) << "no rod was tilted";
  EXPECT_NEAR(averages[6].value, std::pow(5 * ObservableSeries::kLag, 2), 1e-9) << "msd";
}

TEST(EffectAverages, RodsThatCannotBePlacedFail) {
  Case scene = make_case(4.5, 0.5, 12, kPaperStep, 0.01);
  scene.plan.system.n_rods = 1000;
  EXPECT_THROW(measure_averages(scene, {.folder = testing::TempDir()}, 0.1), Failure);
}

}  // namespace
}  // namespace shaken::bench
