#include "analysis/tilt_switches.h"

#include <gtest/gtest.h>

#include "analysis/errors/jackknife.h"
#include "tests/unit/analysis/analysis_samples.h"

namespace shaken::analysis {
namespace {

Estimate time_of(const TiltSwitches& switches, double t_steady = 0) {
  return jackknife(switches.sums().empty(), switches.sums().parts_after(t_steady, kMostParts),
                   [](const SwitchSums& sums) { return std::vector{TiltSwitches::switching_time(sums)}; })[0];
}

TEST(TiltSwitches, CountWhatCrossesBothThresholds) {
  TiltSwitches switches(0.2);
  // Unknown, up (at 1 s), back between, down (3 s), on the threshold itself, down again, up (6 s).
  const double n_z[] = {0.1, 0.3, -0.1, -0.3, 0.2, -0.25, 0.21};
  for (int i = 0; i < 7; ++i) {
    // The other rod never leaves the middle, which is no side.
    switches.accumulate(i, std::vector<Vec3>{axis(0, n_z[i]), axis(0, 0.19 * (i % 2 == 0 ? 1 : -1))});
  }
  const SwitchSums sums = switches.sums().all();
  EXPECT_EQ(sums.switches, 2);
  EXPECT_EQ(sums.lived, 5);
  EXPECT_EQ(TiltSwitches::switching_time(sums), 2.5);
  EXPECT_TRUE(std::isnan(TiltSwitches::switching_time(SwitchSums{})));
  EXPECT_THROW(switches.accumulate(6, std::vector<Vec3>(2)), std::logic_error);
  EXPECT_THROW(switches.accumulate(7, std::vector<Vec3>(3)), std::logic_error);
}

// A rod that changes sides with probability p a sample stays 1 / p samples on average. 300 experiments: chi^2 / n of
// the errors, good to 8 % itself.
TEST(TiltSwitches, OfATelegraphWithItsError) {
  constexpr double kP = 0.05, kInterval = 0.01;
  constexpr int kRepeats = 300;
  Draw draw(131);
  double chi2 = 0, sum = 0, squares = 0;
  for (int repeat = 0; repeat < kRepeats; ++repeat) {
    TiltSwitches switches(0.2);
    std::vector<double> side(5, 1);
    for (int i = 0; i < 1600; ++i) {
      std::vector<Vec3> directors;
      for (double& s : side) {
        if (draw.uniform(0, 1) < kP) s = -s;
        directors.push_back(axis(0, 0.3 * s));
      }
      switches.accumulate(kInterval * i, directors);
    }
    const Estimate time = time_of(switches);
    const double off = time.value - kInterval / kP;
    chi2 += std::pow(off / time.sem, 2);
    sum += off;
    squares += off * off;
  }
  // A ratio is above its mean by its relative variance: 1 / 400 switches.
  EXPECT_LT(std::abs(sum - kRepeats * kInterval / kP / 400) / std::sqrt(squares), 4.5);
  EXPECT_GT(chi2 / kRepeats, 0.8);
  EXPECT_LT(chi2 / kRepeats, 1.35);
}

// An Ornstein-Uhlenbeck n_z of spread s and memory tau goes from -a to a in tau sqrt(2 pi) times the integral of
// exp(x^2 / 2) Phi(x) from -a/s to a/s (Siegert, Phys. Rev. 81, 617 (1951)), Phi the normal distribution. Seen at
// intervals dt it crosses late, as if the thresholds were 0.5826 s sqrt(2 dt / tau) further out (Broadie, Glasserman &
// Kou 1997).
TEST(TiltSwitches, OfAnOrnsteinUhlenbeckTilt) {
  constexpr double kSpread = 0.1, kThreshold = 0.1, kTau = 1.0, kDt = 0.002;
  Draw draw(132);
  TiltSwitches switches(kThreshold);
  const double keep = std::exp(-kDt / kTau);
  std::vector<double> x(40, 0.0);
  for (int i = 0; i < 100000; ++i) {
    std::vector<Vec3> directors;
    for (double& tilt : x) {
      tilt = keep * tilt + kSpread * std::sqrt(1 - keep * keep) * draw.normal();
      directors.push_back(axis(0, tilt));
    }
    switches.accumulate(kDt * i, directors);
  }
  const double reach = kThreshold / kSpread + 0.5826 * std::sqrt(2 * kDt / kTau);
  double known = 0;
  constexpr int kSteps = 10000;
  for (int k = 0; k < kSteps; ++k) {
    const double u = reach * (2 * (k + 0.5) / kSteps - 1);
    known +=
        kTau * std::sqrt(2 * kPi) * std::exp(u * u / 2) * 0.5 * std::erfc(-u / std::sqrt(2.0)) * 2 * reach / kSteps;
  }
  const Estimate time = time_of(switches);
  EXPECT_LT(time.sem, 0.03 * known);
  EXPECT_LT(std::abs(time.value - known), 4.5 * time.sem + 0.01 * known) << time.value << " +- " << time.sem;
}

}  // namespace
}  // namespace shaken::analysis
