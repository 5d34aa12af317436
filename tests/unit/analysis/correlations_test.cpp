#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "analysis/self_scattering.h"
#include "analysis/velocity_correlation.h"
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
  const Frames frames = with_holes(draw, walks(draw, 5, 150, kTheta, 1.0, 0.3));
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
        if (!d.hasNaN()) moved.push_back({d.dot(n), d.dot(m)});
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

VelocityCorrelation correlation_of(const Frames& frames, double director, double interval, double window) {
  VelocityCorrelation correlation(interval, window);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    correlation.accumulate(static_cast<double>(i) * interval, frames[i], director);
  }
  return correlation;
}

// The slow twin keeps all frames; the director turns with time.
TEST(VelocityCorrelation, EqualsTheSumOverAllFrames) {
  constexpr std::size_t kWindow = 3;
  Draw draw(111);
  const Frames frames = with_holes(draw, walks(draw, 4, 220, 0.4, 1.0, 0.3));
  VelocityCorrelation correlation(0.1, 0.29);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    correlation.accumulate(0.1 * static_cast<double>(i), frames[i], 0.02 * static_cast<double>(i));
  }
  const VelocityCurve curve = correlation.reduce();
  const auto product = [&](std::size_t lag) {
    double along = 0, across = 0, pairs = 0;
    for (std::size_t t = 0; t + lag + kWindow < frames.size(); t += origin_spacing(lag)) {
      const double angle = 0.02 * static_cast<double>(t);
      const Vec3 n(std::cos(angle), std::sin(angle), 0), m(-n.y(), n.x(), 0);
      for (std::size_t rod = 0; rod < 4; ++rod) {
        const Vec3 v = (frames[t + kWindow][rod] - frames[t][rod]) / 0.3;
        const Vec3 w = (frames[t + lag + kWindow][rod] - frames[t + lag][rod]) / 0.3;
        if ((v + w).hasNaN()) continue;
        along += v.dot(n) * w.dot(n);
        across += v.dot(m) * w.dot(m);
        pairs += 1;
      }
    }
    return Vec2(along / pairs, across / pairs);
  };
  const Vec2 square = product(0);
  ASSERT_GT(curve.lag.size(), 20u);
  EXPECT_EQ(curve.lag[0], 0.0);
  for (std::size_t i = 0; i < curve.lag.size(); ++i) {
    const Vec2 here = product(static_cast<std::size_t>(std::lround(curve.lag[i] / 0.1)));
    EXPECT_NEAR(curve.c_v.value[i], here.sum() / square.sum(), 1e-12);
    EXPECT_NEAR(curve.along.value[i], here.x() / square.x(), 1e-12);
    EXPECT_NEAR(curve.across.value[i], here.y() / square.y(), 1e-12);
  }
  EXPECT_NEAR(correlation.summarize().mean_square.value, square.sum(), 1e-12 * square.sum());
  EXPECT_NEAR(correlation.summarize().mean_square_along.value, square.x(), 1e-12 * square.sum());
  EXPECT_NEAR(correlation.summarize().mean_square_across.value, square.y(), 1e-12 * square.sum());
  for (std::size_t i = 0; i < curve.lag.size(); ++i) {
    const Vec2 here = product(static_cast<std::size_t>(std::lround(curve.lag[i] / 0.1)));
    EXPECT_NEAR(curve.product.value[i], here.sum(), 1e-12 * square.sum());
    EXPECT_NEAR(curve.product_along.value[i], here.x(), 1e-12 * square.sum());
    EXPECT_NEAR(curve.product_across.value[i], here.y(), 1e-12 * square.sum());
  }
}

TEST(VelocityCorrelation, OfConstantVelocityIsOne) {
  Frames frames;
  for (int i = 0; i < 200; ++i) frames.push_back({{0.3 * i, 0.4 * i, 0}, {-0.1 * i, 0.2 * i, 0}});
  const VelocityCorrelation correlation = correlation_of(frames, 0.3, 0.1, 0.4);
  const VelocityCurve curve = correlation.reduce();
  for (std::size_t i = 0; i < curve.lag.size(); ++i) {
    EXPECT_NEAR(curve.c_v.value[i], 1, 1e-12);
    EXPECT_NEAR(curve.along.value[i], 1, 1e-12);
    EXPECT_NEAR(curve.across.value[i], 1, 1e-12);
  }
  EXPECT_TRUE(std::isnan(correlation.summarize().correlation_time.value));
  EXPECT_TRUE(std::isnan(correlation.summarize().decay_time.value));
  EXPECT_TRUE(std::isnan(correlation.summarize().persistence_time.value)) << "it never ends";
  EXPECT_TRUE(std::isnan(correlation.summarize().persistence_length.value));
  EXPECT_NEAR(correlation.summarize().mean_square.value, (25 + 5) / 2.0, 1e-10);
}

// Without memory but for the window W: 1 - t / W, then 0, whose integral is W / 2 and which is 1/e at (1 - 1/e) W.
TEST(VelocityCorrelation, OfARandomWalkIsTheTriangleOfItsWindow) {
  constexpr double kWindow = 0.4;
  Draw draw(112);
  const VelocityCorrelation correlation = correlation_of(walks(draw, 100, 3000, 0.4, 1.0, 0.5), 0.4, 0.1, kWindow);
  const VelocityCurve curve = correlation.reduce();
  for (std::size_t i = 1; i < curve.lag.size() && curve.lag[i] <= 10; ++i) {
    const double known = std::max(0.0, 1 - curve.lag[i] / kWindow);
    EXPECT_LT(std::abs(curve.c_v.value[i] - known) / curve.c_v.sem[i], 4.5) << curve.lag[i];
    EXPECT_LT(std::abs(curve.along.value[i] - known) / curve.along.sem[i], 4.5) << curve.lag[i];
    EXPECT_LT(std::abs(curve.across.value[i] - known) / curve.across.sem[i], 4.5) << curve.lag[i];
    EXPECT_LT(curve.c_v.sem[i], 0.01);
  }
  EXPECT_NEAR(curve.c_v.sem[0], 0.0, 1e-12) << "1 by definition";
  const VelocitySummary summary = correlation.summarize();
  EXPECT_NEAR(summary.correlation_time.value, kWindow / 2, 0.01);
  EXPECT_LT(summary.correlation_time.sem, 0.01);
  EXPECT_NEAR(summary.decay_time.value, (1 - std::exp(-1)) * kWindow, 0.02);
  // <v^2> = (1 + 0.25) * 4 steps / W^2
  EXPECT_LT(std::abs(summary.mean_square.value - 1.25 * 4 / 0.16) / summary.mean_square.sem, 4.5);
}

// Straight ways at speeds of exponential distribution, mean kSpeed; with probability kTurn a step a new direction and a
// new speed. <u . u'> = (1 - kTurn)^k, and on the way along u also, times the mean speed: not its mean square, which is
// twice as large. The integrals are those of the trapezia on the lags that there are, up to 1/e^2. 150 experiments: z
// of their mean, and chi^2 / n, which chance leaves open by 0.12. Where integrals went up to the first zero, which
// noise sets far out, it was 1.6 and 1.9.
TEST(VelocityCorrelation, PersistenceOfRunsAndTumbles) {
  constexpr double kDt = 0.4, kSpeed = 2.0, kTurn = 0.1;
  constexpr int kRepeats = 150;
  const double left = std::exp(-2.0);
  Draw draw(116);
  double chi2_time = 0, chi2_length = 0, off_time = 0, off_length = 0, sem_time = 0, sem_length = 0;
  for (int repeat = 0; repeat < kRepeats; ++repeat) {
    constexpr std::size_t kRods = 15;
    const auto tumbled = [&] {
      const double phi = draw.uniform(0, 2 * kPi), speed = -kSpeed * std::log(1 - draw.uniform(0, 1));
      return Vec3(speed * std::cos(phi), speed * std::sin(phi), 0);
    };
    std::vector<Vec3> velocity;
    for (std::size_t i = 0; i < kRods; ++i) velocity.push_back(tumbled());
    Frames frames{std::vector<Vec3>(kRods, Vec3::Zero())};
    while (frames.size() < 2400) {
      std::vector<Vec3> next = frames.back();
      for (std::size_t i = 0; i < kRods; ++i) {
        next[i] += kDt * velocity[i];
        if (draw.uniform(0, 1) < kTurn) velocity[i] = tumbled();
      }
      frames.push_back(next);
    }
    const VelocityCorrelation correlation = correlation_of(frames, 0.2, kDt, kDt);
    const VelocityCurve curve = correlation.reduce();
    double known = 0;
    for (std::size_t i = 0; i + 1 < curve.lag.size(); ++i) {
      const double here = std::pow(1 - kTurn, curve.lag[i] / kDt), next = std::pow(1 - kTurn, curve.lag[i + 1] / kDt);
      if (here <= left) break;
      const double end = std::max(next, left);  // the last trapezium is cut off there
      known += (curve.lag[i + 1] - curve.lag[i]) * (here - end) / (here - next) * (here + end) / 2 / (1 - left);
    }
    EXPECT_NEAR(known, kDt * (1 / kTurn - 0.5), 0.05 * known) << "trapezia of exponentials";
    const VelocitySummary summary = correlation.summarize();
    ASSERT_GT(summary.persistence_time.sem, 0);
    const double time = summary.persistence_time.value - known;
    const double length = summary.persistence_length.value - kSpeed * known;
    chi2_time += std::pow(time / summary.persistence_time.sem, 2) / kRepeats;
    chi2_length += std::pow(length / summary.persistence_length.sem, 2) / kRepeats;
    off_time += time / kRepeats;
    off_length += length / kRepeats;
    sem_time += summary.persistence_time.sem / kRepeats;
    sem_length += summary.persistence_length.sem / kRepeats;
  }
  std::printf("persistence: off by %.2f and %.2f errors, chi^2 / n %.2f and %.2f\n", off_time / sem_time,
              off_length / sem_length, chi2_time, chi2_length);
  EXPECT_LT(std::abs(off_time), 0.35 * sem_time) << "four errors of the mean";
  EXPECT_LT(std::abs(off_length), 0.35 * sem_length);
  EXPECT_GT(chi2_time, 0.65);
  EXPECT_LT(chi2_time, 1.45);
  EXPECT_GT(chi2_length, 0.65);
  EXPECT_LT(chi2_length, 1.45);
}

// A curve of which all is known: two rods side by side that go to and fro, 1 mm/s, turning every 16 samples. With a
// window of one sample <u u'> falls in straight lines from 1 to -1 in 16 samples, and 1/e^2 of it is met at 8 (1 -
// 1/e^2).
TEST(VelocityCorrelation, PersistenceGoesToOneOverESquaredAndNotToZero) {
  Frames frames;
  double x = 0;
  for (int i = 0; i < 3200; ++i) {
    frames.push_back({Vec3(x, 0, 0), Vec3(x, 3, 0)});
    x += i % 32 < 16 ? 0.1 : -0.1;
  }
  const VelocitySummary summary = correlation_of(frames, 0, 0.1, 0.1).summarize();
  const double left = std::exp(-2.0);
  const double known = 0.8 * (1 - left) * (1 + left) / 2 / (1 - left);
  EXPECT_NEAR(summary.persistence_time.value, known, 0.01 * known);
  EXPECT_NEAR(summary.persistence_length.value, known, 0.01 * known);
  EXPECT_NEAR(summary.correlation_time.value, 0.4, 0.004) << "up to its zero, as ever";
}

TEST(VelocityCorrelation, ErrorsAreTheScatterOfRepeatedExperiments) {
  Draw draw(114);
  constexpr int kRuns = 200;
  double squares = 0, variances = 0, sum = 0, sum2 = 0, errors = 0;
  for (int repeat = 0; repeat < kRuns; ++repeat) {
    const VelocityCorrelation correlation = correlation_of(walks(draw, 3, 600, 0, 1, 1), 0, 0.1, 0.4);
    const VelocityCurve curve = correlation.reduce();
    const Estimate persistence = correlation.summarize().persistence_time;
    squares += std::pow(curve.c_v.value.at(2) - 0.5, 2);
    variances += std::pow(curve.c_v.sem.at(2), 2);
    sum += persistence.value / kRuns;
    sum2 += std::pow(persistence.value, 2) / kRuns;
    errors += std::pow(persistence.sem, 2) / kRuns;
  }
  EXPECT_NEAR(std::sqrt(variances / squares), 1.0, 0.25);
  EXPECT_NEAR(std::sqrt(errors / (sum2 - sum * sum)), 1.0, 0.25);
}

TEST(VelocityCorrelation, NothingAndStillRodsDoNotCrash) {
  EXPECT_TRUE(VelocityCorrelation(0.1, 0.4).reduce().lag.empty());
  EXPECT_TRUE(std::isnan(VelocityCorrelation(0.1, 0.4).summarize().mean_square.value));
  const VelocityCorrelation none = correlation_of(Frames(20), 0, 0.1, 0.4);
  EXPECT_TRUE(none.reduce().lag.empty());
  const VelocityCorrelation still = correlation_of(Frames(20, {Vec3(1, 2, 3)}), 0, 0.1, 0.4);
  EXPECT_TRUE(std::isnan(still.reduce().c_v.value.at(0)));
  EXPECT_EQ(still.summarize().mean_square.value, 0.0);
  EXPECT_TRUE(std::isnan(still.summarize().correlation_time.value));
}

}  // namespace
}  // namespace shaken::analysis
