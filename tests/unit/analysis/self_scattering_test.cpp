#include "analysis/self_scattering.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/unit/analysis/walks.h"

namespace shaken::analysis {
namespace {

SelfScattering scattering_of(const Frames& frames, double director, double wavelength, double interval = 1.0,
                             int n_levels = 16) {
  SelfScattering scattering(interval, wavelength, n_levels);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    scattering.accumulate(static_cast<double>(i) * interval, frames[i], director);
  }
  return scattering;
}

// The slow twin keeps all frames and averages over the origins 0, 2^k, 2 * 2^k, ... that level k uses.
TEST(SelfScattering, EqualsTheSumOverAllFrames) {
  constexpr double kTheta = -1.1, kWavelength = 7.3;
  Draw draw(311);
  const Frames frames = walks(draw, 5, 150, kTheta, 1.0, 0.3);
  const SelfScattering scattering = scattering_of(frames, kTheta, kWavelength, 1.0, 4);
  const ScatteringCurve curve = scattering.reduce();
  const Vec3 n(std::cos(kTheta), std::sin(kTheta), 0), m(-std::sin(kTheta), std::cos(kTheta), 0);
  ASSERT_EQ(curve.lag.size(), 8u + 3 * 4);
  for (std::size_t i = 0; i < curve.lag.size(); ++i) {
    const auto lag = static_cast<std::size_t>(curve.lag[i]);
    std::vector<Vec2> moved;  // along and across
    for (std::size_t origin = 0; origin + lag < frames.size(); origin += origin_spacing(lag)) {
      for (std::size_t rod = 0; rod < 5; ++rod) {
        const Vec3 d = frames[origin + lag][rod] - frames[origin][rod];
        moved.push_back({d.dot(n), d.dot(m)});
      }
    }
    const auto mean = [&](auto function) {
      double sum = 0;
      for (const Vec2& d : moved) sum += function(d.x(), d.y());
      return sum / static_cast<double>(moved.size());
    };
    for (std::size_t wave = 0; wave < kScatteringWaves; ++wave) {
      const double q = 2 * kPi / kWavelength * std::exp2(wave);
      EXPECT_NEAR(scattering.wave_numbers()[wave], q, 1e-14 * q);
      const double along = mean([&](double x, double) { return std::cos(q * x); });
      const double across = mean([&](double, double y) { return std::cos(q * y); });
      EXPECT_NEAR(curve.along[wave].value[i], along, 1e-10);
      EXPECT_NEAR(curve.across[wave].value[i], across, 1e-10);
      EXPECT_NEAR(curve.mean[wave].value[i], (along + across) / 2, 1e-10);
    }
    const auto ratio = [&](double dimensions, auto square) {
      const double second = mean(square);
      const double fourth = mean([&](double x, double y) { return square(x, y) * square(x, y); });
      return fourth / second / second / (1 + 2 / dimensions) - 1;
    };
    EXPECT_NEAR(curve.alpha_2.value[i], ratio(2, [](double x, double y) { return x * x + y * y; }), 1e-12);
    EXPECT_NEAR(curve.alpha_2_along.value[i], ratio(1, [](double x, double) { return x * x; }), 1e-12);
    EXPECT_NEAR(curve.alpha_2_across.value[i], ratio(1, [](double, double y) { return y * y; }), 1e-12);
  }
}

// Diffusion by 2 D = step^2 per sample, along and across by different ones.
TEST(SelfScattering, OfDiffusionIsExponential) {
  constexpr std::size_t kRods = 4000;
  constexpr double kTheta = 0.8, kWavelength = 12, kAlong = 1.0, kAcross = 0.5;
  Draw draw(312);
  const SelfScattering scattering =
      scattering_of(walks(draw, kRods, 100, kTheta, kAlong, kAcross), kTheta, kWavelength, 0.1);
  const ScatteringCurve curve = scattering.reduce();
  for (std::size_t i = 0; i < curve.lag.size(); ++i) {
    const double steps = curve.lag[i] / 0.1;
    for (std::size_t wave = 0; wave < kScatteringWaves; ++wave) {
      const double q = scattering.wave_numbers()[wave];
      const auto falls = [&](double step) { return std::exp(-q * q * step * step / 2 * steps); };
      EXPECT_NEAR(curve.along[wave].value[i], falls(kAlong), 4.5 / std::sqrt(2.0 * kRods)) << curve.lag[i];
      EXPECT_NEAR(curve.across[wave].value[i], falls(kAcross), 4.5 / std::sqrt(2.0 * kRods)) << curve.lag[i];
    }
    // var(x^4 / 3 - 2 x^2) = 8/3 of a normal number
    EXPECT_NEAR(curve.alpha_2_along.value[i], 0, 4.5 * std::sqrt(8.0 / 3 / kRods));
    EXPECT_NEAR(curve.alpha_2_across.value[i], 0, 4.5 * std::sqrt(8.0 / 3 / kRods));
    const double s = kAlong * kAlong, t = kAcross * kAcross;
    EXPECT_NEAR(curve.alpha_2.value[i], (s - t) * (s - t) / (2 * (s + t) * (s + t)), 0.15);
  }
  // F_s falls to 1/e, of two exponentials of rates a and b, where (exp(-a t) + exp(-b t)) / 2 does.
  const ScatteringSummary summary = SelfScattering::summarize(curve);
  const double q = scattering.wave_numbers()[0], t = summary.relaxation[0].value / 0.1;
  EXPECT_NEAR((std::exp(-q * q * kAlong * kAlong / 2 * t) + std::exp(-q * q * kAcross * kAcross / 2 * t)) / 2,
              std::exp(-1.0), 0.02);
  EXPECT_GT(summary.relaxation[0].sem, 0);
  EXPECT_LT(summary.relaxation[1].value, summary.relaxation[0].value);
}

// Maxwellian flight: displacements are Gaussian at all lags, F_s = exp(-(q v t)^2 / 2).
TEST(SelfScattering, OfMaxwellianFlightIsGaussian) {
  constexpr std::size_t kRods = 20000;
  Draw draw(313);
  std::vector<Vec3> velocities;
  for (std::size_t i = 0; i < kRods; ++i) velocities.push_back(Vec3(draw.normal(), draw.normal(), 0));
  Frames frames;
  for (int t = 0; t < 12; ++t) {
    frames.emplace_back();
    for (const Vec3& v : velocities) frames.back().push_back(0.1 * t * v);
  }
  const ScatteringCurve curve = scattering_of(frames, 0.5, 10, 0.1).reduce();
  for (std::size_t i = 0; i < curve.lag.size(); ++i) {
    const double gained = 2 * kPi / 10 * curve.lag[i];
    EXPECT_NEAR(curve.mean[0].value[i], std::exp(-gained * gained / 2), 4.5 / std::sqrt(2.0 * kRods));
    EXPECT_NEAR(curve.alpha_2.value[i], 0, 4.5 * std::sqrt(1.0 / kRods));
  }
}

// Half the rods diffuse four times as fast: <x^4> / (3 <x^2>^2) = <D^2> / <D>^2 = (1 + 16) / 2 / 2.5^2.
TEST(SelfScattering, OfSlowAndFastRodsIsNotGaussian) {
  constexpr std::size_t kRods = 20000;
  Draw draw(314);
  Frames frames = walks(draw, kRods, 10, 0, 1.0, 1.0);
  for (std::vector<Vec3>& frame : frames) {
    for (std::size_t rod = 0; rod < kRods / 2; ++rod) frame[rod] *= 2;
  }
  const ScatteringCurve curve = scattering_of(frames, 1.3, 5).reduce();
  for (std::size_t i = 0; i < curve.lag.size(); ++i) {
    EXPECT_NEAR(curve.alpha_2_along.value[i], 0.36, 0.12);
    EXPECT_NEAR(curve.alpha_2_across.value[i], 0.36, 0.12);
    EXPECT_NEAR(curve.alpha_2.value[i], 0.36, 0.09);
  }
}

// Errors against the scatter of replicas, at lags that fit often into the run.
TEST(SelfScattering, ClaimsHonestErrors) {
  constexpr int kReplicas = 150;
  Draw draw(315);
  std::map<std::string, std::vector<Estimate>> found;
  for (int replica = 0; replica < kReplicas; ++replica) {
    const ScatteringCurve curve = scattering_of(walks(draw, 20, 400, 0, 1.0, 1.0), 0, 12).reduce();
    for (const std::size_t lag : {0u, 3u, 7u}) {
      const auto keep = [&](const char* name, const EstimateCurve& of) {
        found[name + std::to_string(lag)].push_back({of.value[lag], of.sem[lag]});
      };
      keep("along", curve.along[0]);
      keep("mean", curve.mean[1]);
      keep("alpha_2", curve.alpha_2);
      keep("alpha_2_along", curve.alpha_2_along);
    }
  }
  for (const auto& [name, estimates] : found) {
    double mean = 0, squares = 0;
    for (const Estimate& one : estimates) mean += one.value / kReplicas;
    for (const Estimate& one : estimates) squares += std::pow((one.value - mean) / one.sem, 2) / (kReplicas - 1);
    EXPECT_NEAR(squares, 1, 4 * std::sqrt(2.0 / kReplicas)) << name;
  }
}

TEST(SelfScattering, RefersToTheDirectorAtTheOriginTime) {
  SelfScattering scattering(1.0, 8);
  scattering.accumulate(0, std::vector<Vec3>{{0, 0, 0}}, 0);
  scattering.accumulate(1, std::vector<Vec3>{{2, 0, 0}}, kPi / 2);
  const ScatteringCurve curve = scattering.reduce();
  EXPECT_NEAR(curve.along[0].value[0], 0, 1e-14);
  EXPECT_NEAR(curve.along[1].value[0], -1, 1e-14);
  EXPECT_NEAR(curve.along[2].value[0], 1, 1e-14);
  EXPECT_NEAR(curve.across[0].value[0], 1, 1e-14);
}

TEST(SelfScattering, OfRodsAtRestHasNoShape) {
  const ScatteringCurve curve = scattering_of(Frames(50, std::vector<Vec3>(3, Vec3(1, 2, 3))), 0, 8).reduce();
  for (std::size_t i = 0; i < curve.lag.size(); ++i) {
    EXPECT_EQ(curve.mean[3].value[i], 1);
    EXPECT_TRUE(std::isnan(curve.alpha_2.value[i]));
  }
  EXPECT_TRUE(std::isnan(SelfScattering::summarize(curve).relaxation[0].value));
  EXPECT_TRUE(std::isnan(SelfScattering::summarize(curve).alpha_2_peak.value));
  EXPECT_TRUE(SelfScattering(1, 8).reduce().lag.empty());
}

TEST(SelfScattering, PeakIsTheLargestAlpha) {
  ScatteringCurve curve;
  curve.lag = {1, 2, 3, 4, 5};
  for (const double alpha : {0.1, 0.4, 0.3, 0.2, 0.9}) curve.alpha_2.push_back(Estimate{alpha, 0.01});
  curve.alpha_2.sem[4] = kNaN;  // too few of so long a lag
  for (std::size_t wave = 0; wave < kScatteringWaves; ++wave) {
    for (int i = 0; i < 5; ++i) curve.mean[wave].push_back(Estimate{1, 0});
  }
  const ScatteringSummary summary = SelfScattering::summarize(curve);
  EXPECT_EQ(summary.alpha_2_peak.value, 0.4);
  EXPECT_EQ(summary.alpha_2_peak_lag, 2);
}

}  // namespace
}  // namespace shaken::analysis
