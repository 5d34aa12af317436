#include "analysis/defect_series.h"

#include <gtest/gtest.h>

namespace shaken::analysis {
namespace {

const std::vector<Defect> kPair{{{1, 2}, 0.5, 0.3}, {{3, 4}, -0.5, -0.1}};
const std::vector<std::int64_t> kIds{0, 1};

TEST(DefectSeries, CountsAndLists) {
  DefectSeries series(true);
  series.accumulate(0.0, kPair, kIds);
  series.accumulate(0.1, {}, {});
  series.accumulate(0.2, std::vector<Defect>{kPair[0], kPair[1], kPair[1]}, std::vector<std::int64_t>{3, 2, 4});
  EXPECT_EQ(series.n_plus(), (std::vector<double>{1, 0, 1}));
  EXPECT_EQ(series.n_minus(), (std::vector<double>{1, 0, 2}));
  EXPECT_EQ(series.list().time, (std::vector<double>{0, 0, 0.2, 0.2, 0.2}));
  EXPECT_EQ(series.list().x, (std::vector<double>{1, 3, 1, 3, 3}));
  EXPECT_EQ(series.list().y, (std::vector<double>{2, 4, 2, 4, 4}));
  EXPECT_EQ(series.list().charge, (std::vector<double>{0.5, -0.5, 0.5, -0.5, -0.5}));
  EXPECT_EQ(series.list().direction, (std::vector<double>{0.3, -0.1, 0.3, -0.1, -0.1}));
  EXPECT_EQ(series.list().track, (std::vector<double>{0, 1, 3, 2, 4}));
  EXPECT_DOUBLE_EQ(series.reduce(0.1).n_plus, 0.5);
  EXPECT_DOUBLE_EQ(series.reduce(0.1).n_minus, 1.0);
  EXPECT_EQ(series.reduce(5.0).n_minus, 0.0);
  EXPECT_THROW(series.accumulate(0.2, {}, {}), std::logic_error);
}

TEST(DefectSeries, MemoryIsBoundedWithoutTheList) {
  DefectSeries series;
  for (int i = 0; i < 70000; ++i) series.accumulate(0.1 * i, kPair, kIds);
  EXPECT_LT(series.times().size(), 65536U);
  EXPECT_EQ(series.n_minus().back(), 1);
  EXPECT_TRUE(series.list().x.empty());
}

}  // namespace
}  // namespace shaken::analysis
