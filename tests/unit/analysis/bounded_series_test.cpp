#include "analysis/errors/bounded_series.h"

#include <gtest/gtest.h>

namespace shaken::analysis {
namespace {

// Up to seven samples as they are; then, with room for eight, ever wider means.
TEST(BoundedSeries, AveragesPairsWhenItIsFull) {
  BoundedSeries<2> series(8);
  for (int i = 0; i < 7; ++i) series.accumulate(i, {10.0 * i, 1.0});
  EXPECT_EQ(series.times(), (std::vector<double>{0, 1, 2, 3, 4, 5, 6}));
  for (int i = 7; i < 1000; ++i) series.accumulate(i, {10.0 * i, 1.0});
  ASSERT_EQ(series.times().size(), 7U);  // of 128 samples each: 999 / 128 = 7.8
  for (std::size_t i = 0; i < 7; ++i) {
    EXPECT_DOUBLE_EQ(series.times()[i], 128.0 * static_cast<double>(i) + 63.5);
    EXPECT_DOUBLE_EQ(series.column(0)[i], 10 * series.times()[i]);
    EXPECT_DOUBLE_EQ(series.column(1)[i], 1);
  }
  EXPECT_THROW(series.accumulate(999, {0, 0}), std::logic_error);
}

}  // namespace
}  // namespace shaken::analysis
