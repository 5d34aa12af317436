#include "base/core/exact_sum.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "base/core/rng.h"

namespace shaken {
namespace {

TEST(ExactSum, DoesNotDependOnTheOrderOfItsTerms) {
  Rng rng(1, RngStream::kVelocity, 0, 0);
  std::vector<double> terms;
  for (int k = 0; k < 10000; ++k) terms.push_back(rng.normal() * std::pow(10.0, rng.uniform(-8, 6)));
  ExactSum<34> forwards, backwards, halves[2], both;
  for (std::size_t k = 0; k < terms.size(); ++k) {
    forwards.add(terms[k]);
    backwards.add(terms[terms.size() - 1 - k]);
    halves[k % 2].add(terms[k]);
  }
  both.add(halves[0]);
  both.add(halves[1]);
  EXPECT_EQ(forwards.value(), backwards.value());
  EXPECT_EQ(forwards.value(), both.value());
  long double plain = 0;
  for (const double term : terms) plain += term;
  EXPECT_NEAR(forwards.value(), static_cast<double>(plain), 1e-6);
  // a plain sum of doubles does depend on it
  double up = 0;
  for (const double term : terms) up += term;
  std::reverse(terms.begin(), terms.end());
  double down = 0;
  for (const double term : terms) down += term;
  EXPECT_NE(up, down);
}

TEST(ExactSum, AddsLargeTermsToSmallOnesExactly) {
  ExactSum<34> sum;
  for (const double large :
       {3e8, 1e12, -1e12, 1e18, -1e18, 7e19, -7e19, 123456789012345.625, -123456789012345.625, -3e8}) {
    sum.add(large);
    sum.add(0.25);
  }
  EXPECT_EQ(sum.value(), 2.5);
}

TEST(ExactSum, GoesOnBeyond64BitsAndThroughItsParts) {
  ExactSum<44> sum;
  for (int k = 0; k < 1000000; ++k) sum.add(-200000.25);
  EXPECT_EQ(sum.value(), -200000.25e6);
  ExactSum<44> copy;
  copy.restore(sum.low(), sum.high(), sum.overflow());
  copy.add(0.25);
  EXPECT_EQ(copy.value(), -200000.25e6 + 0.25);
}

TEST(ExactSum, SaysSoWhenATermIsTooLarge) {
  ExactSum<44> sum;
  sum.add(1e20);
  EXPECT_TRUE(std::isnan(sum.value()));
  ExactSum<34> other;
  other.add(NAN);
  EXPECT_TRUE(std::isnan(other.value()));
}

}  // namespace
}  // namespace shaken
