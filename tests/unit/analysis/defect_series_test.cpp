// SPDX-License-Identifier: MIT
#include "analysis/defect_series.h"

#include <gtest/gtest.h>

#include "tests/unit/analysis/state_checks.h"

namespace shaken::analysis {
namespace {

const std::vector<Defect> kPair{{{1, 2}, 0.5, 0.3}, {{3, 4}, -0.5, -0.1}};

TEST(DefectSeries, CountsAndLists) {
  DefectSeries series;
  series.accumulate(0.0, kPair);
  series.accumulate(0.1, {});
  series.accumulate(0.2, std::vector<Defect>{kPair[0], kPair[1], kPair[1]});
  EXPECT_EQ(series.n_plus(), (std::vector<double>{1, 0, 1}));
  EXPECT_EQ(series.n_minus(), (std::vector<double>{1, 0, 2}));
  EXPECT_EQ(series.list().time, (std::vector<double>{0, 0, 0.2, 0.2, 0.2}));
  EXPECT_EQ(series.list().x, (std::vector<double>{1, 3, 1, 3, 3}));
  EXPECT_EQ(series.list().y, (std::vector<double>{2, 4, 2, 4, 4}));
  EXPECT_EQ(series.list().charge, (std::vector<double>{0.5, -0.5, 0.5, -0.5, -0.5}));
  EXPECT_EQ(series.list().direction, (std::vector<double>{0.3, -0.1, 0.3, -0.1, -0.1}));
  EXPECT_DOUBLE_EQ(series.reduce(0.1).n_plus, 0.5);
  EXPECT_DOUBLE_EQ(series.reduce(0.1).n_minus, 1.0);
  EXPECT_EQ(series.reduce(5.0).n_minus, 0.0);
  EXPECT_THROW(series.accumulate(0.2, {}), std::logic_error);
  series.reset();
  EXPECT_TRUE(series.times().empty() && series.list().x.empty());
}

TEST(DefectSeries, SavedStateIsExactAndDamageIsFound) {
  DefectSeries series;
  series.accumulate(0.0, kPair);
  series.accumulate(1.0 / 3, kPair);
  const std::vector<std::byte> before = state(series);
  stop_and_go_on(series);
  EXPECT_EQ(state(series), before);
  expect_every_truncation_found(series);
}

}  // namespace
}  // namespace shaken::analysis
