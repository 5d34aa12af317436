#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

#include "base/core/exact_sum.h"
#include "base/core/natural_log.h"
#include "base/core/rng.h"

namespace shaken {
namespace {

// Replicas have neighbouring seeds: what one draws at a tick must not be what another draws at the next one.
TEST(Rng, NoTwoKeysNearEachOtherDrawTheSame) {
  std::set<std::uint64_t> drawn;
  int n = 0;
  for (std::uint64_t seed = 0; seed < 16; ++seed) {
    for (const RngStream stream : {RngStream::kNoise, RngStream::kContacts}) {
      for (Tick tick = 0; tick < 64; ++tick) {
        for (std::uint64_t index = 0; index < 16; ++index) {
          drawn.insert(Rng(seed, stream, tick, index).bits());
          ++n;
        }
      }
    }
  }
  EXPECT_EQ(drawn.size(), static_cast<std::size_t>(n));
}

TEST(NaturalLog, AgreesWithLongDouble) {
  double worst = 0;
  for (std::uint64_t k = 0; k < 200000; ++k) {
    Rng rng(1, RngStream::kVelocity, 0, k);
    const double x = k % 2 ? rng.uniform() + 0x1p-53 : std::ldexp(1 + rng.uniform(), static_cast<int>(k % 100) - 50);
    const auto exact = static_cast<double>(std::log(static_cast<long double>(x)));
    worst = std::max(worst, std::abs(natural_log(x) - exact) / std::max(std::abs(exact), 1e-300));
  }
  EXPECT_LT(worst, 5e-16);
  EXPECT_EQ(natural_log(1.0), 0.0);
}

TEST(Rng, MomentsOfUniformAndNormal) {
  // n = 2e5 draws: standard errors 6.5e-4 (uniform mean), 2.2e-3 (normal mean), 3.2e-3 (normal variance); 5 sigma
  const int n = 200000;
  double sum = 0, normal = 0, normal2 = 0;
  for (int i = 0; i < n; ++i) {
    Rng rng(1, RngStream::kVelocity, 0, static_cast<std::uint64_t>(i));
    const double u = rng.uniform();
    EXPECT_GE(u, 0.0);
    EXPECT_LT(u, 1.0);
    sum += u;
    const double z = rng.normal();
    normal += z;
    normal2 += z * z;
  }
  EXPECT_NEAR(sum / n, 0.5, 5 * 6.5e-4);
  EXPECT_NEAR(normal / n, 0.0, 5 * 2.2e-3);
  EXPECT_NEAR(normal2 / n, 1.0, 5 * 3.2e-3);
}

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
