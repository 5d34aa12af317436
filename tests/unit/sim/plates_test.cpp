// SPDX-License-Identifier: MIT
#include "sim/motion/plates.h"

#include <gtest/gtest.h>

#include <cmath>

namespace shaken {
namespace {

__extension__ using Int128 = __int128;

TEST(PlateMotion, PaperIsPeriodicWith1250Ticks) {
  const PlateMotion plates(0.0435, 200, 1.2, 4e-6);
  EXPECT_EQ(plates.period_ticks(), 1250);
  EXPECT_DOUBLE_EQ(plates.at(0).base, 0.087);
  EXPECT_DOUBLE_EQ(plates.at(0).lid, 0.087 + 1.2);
  EXPECT_EQ(plates.at(0).velocity, 0.0);
  EXPECT_NEAR(plates.at(625).base, 0.0, 1e-17);
  EXPECT_NEAR(plates.at(312).velocity, -0.0435 * 2 * kPi * 200, 1e-3);
  for (const Tick k : {1, 77, 1249}) {
    EXPECT_EQ(plates.at(k).base, plates.at(k + 1250 * 800000).base) << "digits lost after 1e9 ticks";
    EXPECT_EQ(plates.at(k).velocity, plates.at(k + 1250 * 800000).velocity);
  }
}

TEST(PlateMotion, VelocityIsTheDerivativeOfPosition) {
  const PlateMotion plates(0.05, 137.0, 1.2, 1e-6);
  EXPECT_EQ(plates.period_ticks(), 0);  // no whole number of ticks
  for (const Tick k : {10, 1234, 54321}) {
    const double slope = (plates.at(k + 1).base - plates.at(k - 1).base) / 2e-6;
    EXPECT_NEAR(plates.at(k).velocity, slope, 1e-4);
  }
}

TEST(PlateMotion, IrrationalPeriodKeepsItsDigitsAfterABillionTicks) {
  const double f = 137.0;
  const double dt = 3.7e-6;
  const PlateMotion plates(1.0, f, 1.2, dt);
  ASSERT_EQ(plates.period_ticks(), 0);
  for (const Tick k : {Tick{999999937}, Tick{1600000001}, Tick{123456789012}}) {
    // exact phase by integer arithmetic: f dt = m * 2^e with the product of the two 53-bit mantissas
    int ef = 0, ed = 0;
    const auto mf = static_cast<Int128>(std::ldexp(std::frexp(f, &ef), 53));
    const auto md = static_cast<Int128>(std::ldexp(std::frexp(dt, &ed), 53));
    const int e = ef + ed - 106;  // f dt = mf * md * 2^e, e < 0
    // (mf * md * k) mod 2^-e, in three limbs to stay below 2^128
    const int bits = -e;
    ASSERT_LT(bits, 126);
    const Int128 modulus = static_cast<Int128>(1) << bits;
    Int128 step = mf * md % modulus;
    Int128 phase = 0;
    for (Tick rest = k; rest > 0; rest >>= 1) {
      if (rest & 1) phase = (phase + step) % modulus;
      step = (step * 2) % modulus;
    }
    const long double cycles = static_cast<long double>(phase) / static_cast<long double>(modulus);
    const double expected = static_cast<double>(std::cos(2 * std::numbers::pi_v<long double> * cycles)) + 1.0;
    EXPECT_NEAR(plates.at(k).base, expected, 2e-15);
  }
}

TEST(PlateMotion, MovesAlongOneDirectionOfThePlaneAheadOfItsRise) {
  const double b = 0.07, f = 137.0, dt = 1e-6;
  for (const double phase : {0.0, 1.1, -0.5 * kPi}) {
    const PlateMotion plates(0.05, f, 1.2, dt, {.amplitude = b, .phase = phase, .angle = 0.4});
    for (const Tick k : {0, 10, 1234, 54321}) {
      const double omega = 2 * kPi * f;
      const double angle = omega * static_cast<double>(k) * dt + phase;
      const PlateState now = plates.at(k);
      EXPECT_NEAR(now.shift, b * std::cos(angle), 1e-12);
      EXPECT_NEAR(now.slide, -b * omega * std::sin(angle), 1e-9);
      const Vec3 expected(std::cos(0.4) * now.slide, std::sin(0.4) * now.slide, now.velocity);
      EXPECT_LT((plates.velocity(now) - expected).norm(), 1e-12);
      EXPECT_EQ(now.base, PlateMotion(0.05, f, 1.2, dt).at(k).base);
    }
    EXPECT_DOUBLE_EQ(plates.peak_slide(), b * 2 * kPi * f);
  }
}

TEST(PlateMotion, WasBeforeWhatItWasAtAnEarlierTick) {
  for (const double amplitude : {0.0, 0.05}) {
    const double dt = 1e-6;
    const PlateMotion plates(amplitude, 137.0, 1.2, dt, {.amplitude = 0.07, .phase = 0.8, .angle = 0.4});
    for (const Tick ago : {0, 1, 50}) {
      const PlateState then = plates.at(4321 - ago);
      const PlateState found = plates.before(plates.at(4321), static_cast<double>(ago) * dt);
      EXPECT_NEAR(found.base, then.base, 1e-12);
      EXPECT_NEAR(found.velocity, then.velocity, 1e-9);
      EXPECT_NEAR(found.shift, then.shift, 1e-12);
      EXPECT_NEAR(found.slide, then.slide, 1e-9);
    }
  }
}

TEST(PlateMotion, StandsStillWithoutVibration) {
  for (const PlateMotion& plates : {PlateMotion(0, 200, 1.2, 4e-6), PlateMotion(0.1, 0, 1.2, 4e-6)}) {
    EXPECT_EQ(plates.at(0).base, plates.at(777).base);
    EXPECT_EQ(plates.at(777).velocity, 0.0);
  }
}

}  // namespace
}  // namespace shaken
