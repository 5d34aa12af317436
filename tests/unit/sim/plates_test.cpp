#include "sim/motion/plates.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>

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

/// Plates with a second vibration and, if it is given, a lid that moves by itself.
System with_two_vibrations(double second_frequency, std::optional<LidMotion> lid) {
  System system;
  system.amplitude = 0.05;
  system.frequency = 125.0;  // 2,000 ticks
  system.dt = 4e-6;
  system.second = SecondVibration{0.02, second_frequency, 40.0};
  system.lid_motion = lid;
  return system;
}

TEST(PlateMotion, WasBeforeWhatItWasAtAnEarlierTick) {
  for (const double amplitude : {0.0, 0.05}) {
    const double dt = 1e-6;
    const PlateMotion plates(amplitude, 137.0, 1.2, dt, {.amplitude = 0.07, .phase = 0.8, .angle = 0.4});
    for (const Tick ago : {0, 1, 50}) {
      const PlateState then = plates.at(4321 - ago);
      const PlateState found = plates.before(4321, static_cast<double>(ago) * dt);
      EXPECT_NEAR(found.base, then.base, 1e-12);
      EXPECT_NEAR(found.velocity, then.velocity, 1e-9);
      EXPECT_NEAR(found.shift, then.shift, 1e-12);
      EXPECT_NEAR(found.slide, then.slide, 1e-9);
    }
  }
  const System system = with_two_vibrations(317.0, LidMotion{0.08, 120.0});
  const PlateMotion plates(system);
  for (const Tick ago : {0, 1, 50}) {
    const PlateState then = plates.at(4321 - ago);
    const PlateState found = plates.before(4321, static_cast<double>(ago) * system.dt);
    EXPECT_NEAR(found.base, then.base, 1e-12);
    EXPECT_NEAR(found.velocity, then.velocity, 1e-9);
    EXPECT_NEAR(found.lid, then.lid, 1e-12);
    EXPECT_NEAR(found.lid_velocity, then.lid_velocity, 1e-9);
  }
}

TEST(PlateMotion, PeakSpeedIsThatOfTheFasterPlate) {
  const double w = 2 * kPi * 125;
  EXPECT_NEAR(PlateMotion(with_two_vibrations(250.0, LidMotion{0.3, 120.0})).peak_speed(), 0.3 * w, 1e-9);
  EXPECT_NEAR(PlateMotion(with_two_vibrations(250.0, LidMotion{0.01, 120.0})).peak_speed(), 0.05 * w + 0.02 * 2 * w,
              1e-9);
}

// The law in closed form; 250 Hz has a whole number of ticks, 317 Hz has none.
TEST(PlateMotion, HasASecondVibrationAndALidOfItsOwn) {
  const double degree = kPi / 180;
  for (const double f2 : {250.0, 317.0}) {
    for (const std::optional<LidMotion>& lid :
         {std::optional<LidMotion>{}, std::optional(LidMotion{0.08, 120.0}), std::optional(LidMotion{0.0, 0.0})}) {
      const System system = with_two_vibrations(f2, lid);
      const PlateMotion plates(system);
      double highest = 0, nearest = INFINITY, lowest = INFINITY, fastest = 0;
      for (Tick k = 0; k < 20000; k += 7) {
        const double t = static_cast<double>(k) * system.dt, w = 2 * kPi * 125, w2 = 2 * kPi * f2;
        const double second = 0.02 * std::cos(w2 * t + 40 * degree),
                     rate2 = -0.02 * w2 * std::sin(w2 * t + 40 * degree);
        const double base = 0.05 * (1 + std::cos(w * t)) + 0.02 + second;
        const double velocity = -0.05 * w * std::sin(w * t) + rate2;
        const PlateState now = plates.at(k);
        ASSERT_NEAR(now.base, base, 1e-12) << k;
        ASSERT_NEAR(now.velocity, velocity, 1e-9) << k;
        const double angle = lid ? w * t + lid->phase * degree : 0.0;
        ASSERT_NEAR(now.lid, lid ? 0.05 + 0.02 + system.gap + lid->amplitude * std::cos(angle) : base + system.gap,
                    1e-12);
        ASSERT_NEAR(now.lid_velocity, lid ? -lid->amplitude * w * std::sin(angle) : velocity, 1e-9) << k;
        EXPECT_EQ(plates.lid_velocity(now), Vec3(0, 0, now.lid_velocity));
        const PlateState later = plates.before(k, -3e-6);  // by a chord
        ASSERT_NEAR((later.base - now.base) / 3e-6, 0.5 * (later.velocity + now.velocity), 1e-3);
        ASSERT_NEAR((later.lid - now.lid) / 3e-6, 0.5 * (later.lid_velocity + now.lid_velocity), 1e-3);
        lowest = std::min(lowest, now.base);
        highest = std::max(highest, now.base);
        nearest = std::min(nearest, now.lid - now.base);
        fastest = std::max({fastest, std::abs(now.velocity), std::abs(now.lid_velocity)});
        ASSERT_LE(std::abs(later.velocity - now.velocity) / 3e-6, plates.peak_acceleration());
        ASSERT_LE(std::abs(later.lid_velocity - now.lid_velocity) / 3e-6, plates.peak_lid_acceleration() + 1e-6);
      }
      EXPECT_GE(lowest, 0);
      EXPECT_LE(highest, 2 * (0.05 + 0.02));
      EXPECT_GT(highest, 2 * (0.05 + 0.02) - 0.01);
      EXPECT_GE(nearest, plates.least_gap() - 1e-12);
      EXPECT_LT(nearest, plates.least_gap() + 0.03);  // with 250 Hz the two are not at their worst at once
      EXPECT_LE(fastest, plates.peak_speed());
      const PlatesAtStart start = plates_at_start(system);
      EXPECT_EQ(start.base, plates.at(0).base);
      EXPECT_NEAR(start.gap, plates.at(0).lid - plates.at(0).base, 1e-12);
    }
  }
}

// A lid that is said to move as the base does is no lid of its own.
TEST(PlateMotion, OfALidThatMovesWithTheBaseIsThatOfBoth) {
  System system;
  system.lid_motion = LidMotion{system.amplitude, 0.0};
  EXPECT_FALSE(system.has_lid_motion());
  const PlateMotion plates(system), plain(System{});
  for (const Tick k : {0, 17, 999}) EXPECT_EQ(plates.at(k).lid, plain.at(k).lid);
  // but a second vibration is of the base alone
  system.second = SecondVibration{0.02, 300, 0};
  EXPECT_TRUE(system.has_lid_motion());
  EXPECT_EQ(PlateMotion(system).at(17).lid_velocity, plain.at(17).lid_velocity);
  system.amplitude = 0;
  system.lid_motion = LidMotion{};
  EXPECT_EQ(PlateMotion(system).at(17).lid_velocity, 0.0);
}

TEST(PlateMotion, StandsStillWithoutVibration) {
  for (const PlateMotion& plates : {PlateMotion(0, 200, 1.2, 4e-6), PlateMotion(0.1, 0, 1.2, 4e-6)}) {
    EXPECT_EQ(plates.at(0).base, plates.at(777).base);
    EXPECT_EQ(plates.at(777).velocity, 0.0);
  }
}

}  // namespace
}  // namespace shaken
