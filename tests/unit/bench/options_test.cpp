// SPDX-License-Identifier: MIT
#include "bench/options.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/failure.h"
#include "bench/case.h"

namespace shaken::bench {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

TEST(Options, ListsAreSplitAtCommas) {
  OptionReader options;
  EXPECT_THAT(options.numbers("--length", "4.5, 2.5", 0, 10), ElementsAre(4.5, 2.5));
  EXPECT_THAT(options.wholes("--threads", "1,2,16", 1, 64), ElementsAre(1, 2, 16));
  EXPECT_NO_THROW(options.finish());
}

TEST(Options, EveryProblemIsListed) {
  OptionReader options;
  EXPECT_THAT(options.numbers("--length", "4.5,long,60", 0, 50), ElementsAre(4.5));
  EXPECT_EQ(options.whole("--repeat", "2.5", 1, 10), 1);
  EXPECT_EQ(options.number("--cpu", "", 0.001, 10), 0.001);
  try {
    options.finish();
    FAIL() << "not refused";
  } catch (const Failure& failure) {
    EXPECT_EQ(failure.code, ExitCode::kBadInput);
    EXPECT_THAT(failure.what(),
                AllOf(HasSubstr("4 problems"), HasSubstr("--length: 'long' is not a number"),
                      HasSubstr("--length: 60 is outside [0, 50]"), HasSubstr("--repeat: 2.5 is not a whole number"),
                      HasSubstr("--cpu: '' is not a number")));
  }
}

TEST(Case, HasTheScenesDefaults) {
  OptionReader options;
  const auto made = make_case(4.5, 0.75, 41.865, 4e-6, 0.5, options);
  options.finish();
  EXPECT_EQ(made->system().n_rods, 527);
  EXPECT_EQ(made->system().rod.n_beads, 15);
  EXPECT_EQ(made->warm_up_ticks(), 125'000);
  EXPECT_EQ(made->period_ticks(), 1250);
  EXPECT_DOUBLE_EQ(made->rod_seconds(1250), 527 * 0.005);
}

TEST(Case, WhatASceneRefusesIsAProblemOfTheOptions) {
  OptionReader options;
  EXPECT_FALSE(make_case(4.5, 0.75, 5, 4e-6, 0.5, options));
  EXPECT_THROW(options.finish(), Failure);
}

}  // namespace
}  // namespace shaken::bench
