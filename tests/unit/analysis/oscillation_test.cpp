#include "analysis/oscillation.h"

#include <gtest/gtest.h>

#include "tests/unit/analysis/analysis_samples.h"

namespace shaken::analysis {
namespace {

struct Curve {
  std::vector<double> r, y;
};
template <class F>
Curve curve(const F& f) {
  Curve result;
  for (int i = 0; i < 120; ++i) {
    result.r.push_back(0.25 * (i + 0.5));
    result.y.push_back(f(result.r.back()));
  }
  return result;
}

TEST(FirstPeriod, OfACosine) {
  for (const double wavelength : {6.0, 9.3, 17.1}) {
    const Curve c = curve([&](double r) { return 0.3 + 0.2 * std::cos(2 * kPi * r / wavelength); });
    ASSERT_TRUE(first_period(c.r, c.y, 1.0));
    EXPECT_NEAR(*first_period(c.r, c.y, 1.0), wavelength, 0.01);
  }
}

// What a cut of G2 looks like: no pairs at contact, a ripple of the rods' own width, noise. The noise of 0.01 in y
// moves the top of a cosine of amplitude 0.1 by about a tenth of the wavelength's 2 pi-th part, 0.15 mm.
TEST(FirstPeriod, OfANoisyOneWithARippleOfTheSmoothing) {
  Draw draw(131);
  constexpr double kWavelength = 10;
  double sum = 0;
  for (int repeat = 0; repeat < 50; ++repeat) {
    const Curve c = curve([&](double r) {
      if (r < 0.9) return std::nan("");
      return 0.5 + 0.1 * std::cos(2 * kPi * r / kWavelength) + 0.3 * std::exp(-r / 3) * std::cos(2 * kPi * r) +
             0.01 * draw.normal();
    });
    const std::optional<double> found = first_period(c.r, c.y, 1.0);
    ASSERT_TRUE(found);
    EXPECT_NEAR(*found, kWavelength, 1.0);
    sum += *found / 50;
  }
  EXPECT_NEAR(sum, kWavelength, 0.15);
}

// Rods of 4.5 mm side by side, 1.15 mm apart as in a crystal, in layers of a period of 14 mm: the period is that of the
// layers, and without these there is none.
TEST(FirstPeriod, IsNotTheDistanceOfRodsSideBySide) {
  constexpr double kRodLength = 4.5;
  for (const double apart : {0.83, 1.15, 2.3, 2.9}) {  // of 2.9 mm the average leaves a fifth
    const auto ripple = [&](double r) { return 0.2 * std::exp(-r / 8) * std::cos(2 * kPi * r / apart); };
    const Curve both = curve([&](double r) { return 0.5 + 0.1 * std::cos(2 * kPi * r / 14) + ripple(r); });
    ASSERT_TRUE(first_period(both.r, both.y, kRodLength));
    EXPECT_NEAR(*first_period(both.r, both.y, kRodLength), 14, apart < 2.5 ? 0.3 : 1) << apart;
    if (apart > 2.5) continue;
    const Curve crystal = curve([&](double r) { return 0.5 + 0.3 * std::exp(-r / 20) + ripple(r); });
    EXPECT_FALSE(first_period(crystal.r, crystal.y, kRodLength)) << apart;
  }
}

TEST(FirstPeriod, OfACurveWithoutOne) {
  Draw draw(132);
  const auto none = [](const Curve& c) { return !first_period(c.r, c.y, 1.0); };
  EXPECT_TRUE(none(curve([](double r) { return std::exp(-r); })));
  EXPECT_TRUE(none(curve([](double) { return 1.0; })));
  EXPECT_TRUE(none(curve([](double) { return std::nan(""); })));
  EXPECT_TRUE(none(curve([](double r) { return std::cos(2 * kPi * r / 50); })));  // its maximum lies beyond the end
  for (int i = 0; i < 100; ++i) {
    EXPECT_TRUE(none(curve([&](double r) { return std::exp(-r / 5) + 0.02 * draw.normal(); }))) << i;
  }
  EXPECT_FALSE(first_period({}, {}, 1.0));
  EXPECT_FALSE(first_period(std::vector<double>{1}, std::vector<double>{1}, 1.0));
}

}  // namespace
}  // namespace shaken::analysis
