#include "analysis/velocity_correlation.h"

#include <gtest/gtest.h>

#include <cstdio>

#include "tests/unit/analysis/walks.h"

namespace shaken::analysis {
namespace {

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
  const Frames frames = walks(draw, 4, 220, 0.4, 1.0, 0.3);
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

// An Ornstein-Uhlenbeck velocity, <v(0) v(t)> = exp(-t / tau), averaged over the window W: with a = tau^2 / W^2
//   t >= W: 2 a (cosh(W / tau) - 1) exp(-t / tau)
//   t <  W: a (exp(-(t + W) / tau) + exp((t - W) / tau) - 2 exp(-t / tau)) + 2 tau (W - t) / W^2
// over its value at t = 0. Simulated in steps of dt = W / 40, whose sum is the integral to (dt / tau)^2 / 12 < 1e-4.
TEST(VelocityCorrelation, OfAnOrnsteinUhlenbeckVelocityIsItsSmoothedExponential) {
  constexpr double kWindow = 0.4, kTau = 0.7, kDt = 0.01, kEvery = 0.1;
  const auto known = [](double t) {
    const double a = kTau * kTau / (kWindow * kWindow);
    if (t >= kWindow) return 2 * a * (std::cosh(kWindow / kTau) - 1) * std::exp(-t / kTau);
    return a * (std::exp(-(t + kWindow) / kTau) + std::exp((t - kWindow) / kTau) - 2 * std::exp(-t / kTau)) +
           2 * kTau * (kWindow - t) / (kWindow * kWindow);
  };
  EXPECT_NEAR(known(kWindow), known(kWindow * (1 - 1e-9)), 1e-8);
  constexpr std::size_t kRods = 50;
  Draw draw(113);
  const double keep = std::exp(-kDt / kTau);
  std::vector<Vec3> r(kRods, Vec3::Zero()), v;
  for (std::size_t i = 0; i < kRods; ++i) v.push_back({draw.normal(), draw.normal(), 0});
  Frames frames;
  for (int step = 0; step < 20000; ++step) {
    if (step % 10 == 0) frames.push_back(r);
    for (std::size_t i = 0; i < kRods; ++i) {
      const Vec3 next = keep * v[i] + std::sqrt(1 - keep * keep) * Vec3{draw.normal(), draw.normal(), 0};
      r[i] += kDt / 2 * (v[i] + next);
      v[i] = next;
    }
  }
  const VelocityCorrelation correlation = correlation_of(frames, 0, kEvery, kWindow);
  const VelocityCurve curve = correlation.reduce();
  for (std::size_t i = 1; i < curve.lag.size() && curve.lag[i] <= 6; ++i) {
    EXPECT_LT(std::abs(curve.c_v.value[i] - known(curve.lag[i]) / known(0)) / curve.c_v.sem[i], 4.5) << curve.lag[i];
    EXPECT_LT(curve.c_v.sem[i], 0.02);
  }
  const VelocitySummary summary = correlation.summarize();
  EXPECT_LT(std::abs(summary.mean_square.value - 2 * known(0)) / summary.mean_square.sem, 4.5);
  // 1/e at t = tau ln(e 2 a (cosh(W / tau) - 1) / known(0)), beyond the window
  const double decay = kTau * (1 + std::log(known(kWindow) * std::exp(kWindow / kTau) / known(0)));
  EXPECT_LT(std::abs(summary.decay_time.value - decay) / summary.decay_time.sem, 4.5);
  EXPECT_LT(summary.decay_time.sem, 0.1 * decay);
  // The integral of the whole is tau / known(0); up to a zero that noise sets it is less by as little.
  EXPECT_NEAR(summary.correlation_time.value, kTau / known(0), 4.5 * summary.correlation_time.sem + 0.02);
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
  double squares = 0, variances = 0;
  for (int repeat = 0; repeat < 200; ++repeat) {
    const VelocityCorrelation correlation = correlation_of(walks(draw, 3, 600, 0, 1, 1), 0, 0.1, 0.4);
    const VelocityCurve curve = correlation.reduce();
    squares += std::pow(curve.c_v.value.at(2) - 0.5, 2);
    variances += std::pow(curve.c_v.sem.at(2), 2);
  }
  EXPECT_NEAR(std::sqrt(variances / squares), 1.0, 0.25);
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
