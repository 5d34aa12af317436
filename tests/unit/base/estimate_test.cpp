#include "base/estimate.h"

#include <gtest/gtest.h>

#include <vector>

namespace shaken {
namespace {

TEST(MeanOfSamples, HasAnErrorFromTheirScatter) {
  const Estimate mean = mean_of_samples(std::vector<double>{1, 2, 6});
  EXPECT_DOUBLE_EQ(mean.value, 3);
  EXPECT_DOUBLE_EQ(mean.sem, std::sqrt((4 + 1 + 9) / 2.0 / 3.0));
  const Estimate of_four = mean_of_samples(std::vector<double>{1, 2, 3, 4});
  EXPECT_DOUBLE_EQ(of_four.value, 2.5);
  EXPECT_DOUBLE_EQ(of_four.sem, std::sqrt(5.0 / 3.0) / 2.0);
}

TEST(MeanOfSamples, OneSampleTellsNoError) {
  const Estimate mean = mean_of_samples(std::vector<double>{0.5});
  EXPECT_DOUBLE_EQ(mean.value, 0.5);
  EXPECT_TRUE(std::isnan(mean.sem));
}

TEST(StudentQuantile, TabulatedValues) {
  EXPECT_NEAR(student_quantile(1.959964, 4), 2.776, 0.01);
  EXPECT_NEAR(student_quantile(1.959964, 10), 2.228, 0.001);
  EXPECT_NEAR(student_quantile(1.959964, 30), 2.042, 0.001);
  EXPECT_NEAR(student_quantile(1.959964, 1e9), 1.959964, 1e-6);
}

}  // namespace
}  // namespace shaken
