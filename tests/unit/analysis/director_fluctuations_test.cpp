#include "analysis/director_fluctuations.h"

#include <gtest/gtest.h>

#include <complex>

#include "tests/unit/analysis/analysis_samples.h"

namespace shaken::analysis {
namespace director_fluctuations_test {

constexpr double kBox = 80;
constexpr int kLattice = 30;
constexpr double kAllWaves = 2 * kPi * 6.0 * 1.5 / kBox;

/// A nematic whose director's waves are drawn from the spectrum of given constants, and which wanders.
struct Nematic {
  double splay, bend;
  double theta = 0.4;     // director [rad]
  double noise = 0;       // of each rod's own [rad]
  double disorder = 0.2;  // of the rods' places about a lattice [spacings]
  std::vector<Vec3> positions = {}, directors = {};

  void draw(Draw& draw) {
    struct Wave {
      Vec2 q;
      double a, b;
    };
    std::vector<Wave> waves;
    for (int n = 0; n <= 6; ++n) {
      for (int m = n == 0 ? 1 : -6; m <= 6; ++m) {
        const Vec2 q = 2 * kPi / kBox * Vec2(m, n);
        const double along = q.x() * std::cos(theta) + q.y() * std::sin(theta);
        const double across = q.y() * std::cos(theta) - q.x() * std::sin(theta);
        // theta(r) = 2 Re(theta_q exp(i q r)), |theta_q|^2 with mean 1 / (L^2 (K1 q_across^2 + K3 q_along^2)).
        const double sigma = std::sqrt(0.5 / (splay * across * across + bend * along * along)) / kBox;
        waves.push_back({q, 2 * sigma * draw.normal(), 2 * sigma * draw.normal()});
      }
    }
    positions.clear();
    directors.clear();
    for (int k = 0; k < kLattice * kLattice; ++k) {
      const Vec3 site(k % kLattice, static_cast<double>(k / kLattice), 0);
      positions.push_back(kBox / kLattice * (site + disorder * Vec3{draw.normal(), draw.normal(), 0}));
      double angle = theta + noise * draw.normal();
      for (const Wave& wave : waves) {
        const double phase = wave.q.dot(positions.back().head<2>());
        angle += wave.a * std::cos(phase) - wave.b * std::sin(phase);
      }
      directors.push_back(axis(angle, 0.1));
    }
  }
};

DirectorSpectrum spectrum_of(Nematic nematic, int samples, double wander, std::uint64_t seed) {
  Draw draw(seed);
  Blocked<DirectorFluctuations> blocks(DirectorFluctuations(kBox, kAllWaves));
  const double start = nematic.theta;
  for (int i = 0; i < samples; ++i) {
    nematic.theta = start + wander * i / samples;
    nematic.draw(draw);
    blocks.accumulate(i, nematic.positions, nematic.directors);
  }
  return DirectorFluctuations::reduce(blocks, 0);
}

/// Within four errors, and those small; a relative 2 % are granted to what is beyond the linear theory.
void expect_constants(const DirectorSpectrum& spectrum, double splay, double bend) {
  const auto near = [](const Estimate& estimate, double want) {
    EXPECT_LT(estimate.sem, 0.06 * want);
    EXPECT_NEAR(estimate.value, want, 4 * estimate.sem + 0.02 * want);
  };
  near(spectrum.splay, splay);
  near(spectrum.bend, bend);
  near(spectrum.ratio, bend / splay);
}

TEST(DirectorFluctuations, GivesBackTheConstantsOfItsWaves) {
  const DirectorSpectrum spectrum = spectrum_of({.splay = 6, .bend = 18}, 120, 0, 71);
  EXPECT_EQ(spectrum.samples, 120);
  expect_constants(spectrum, 6, 18);
  EXPECT_GT(spectrum.chi2, 0.4);
  EXPECT_LT(spectrum.chi2, 2.5);
  // The power itself, against the wave vectors it is given for.
  double pulls = 0;
  for (std::size_t i = 0; i < spectrum.power.size(); ++i) {
    const double want = 1 / (6 * std::pow(spectrum.q_across[i], 2) + 18 * std::pow(spectrum.q_along[i], 2));
    EXPECT_NEAR(spectrum.fit[i] / want, 1, 0.25) << spectrum.q_along[i] << " " << spectrum.q_across[i];
    pulls += std::pow((spectrum.power[i].value - want) / spectrum.power[i].sem, 2);
  }
  EXPECT_LT(pulls / static_cast<double>(spectrum.power.size()), 4);
  expect_constants(spectrum_of({.splay = 18, .bend = 6}, 120, 0, 72), 18, 6);
}

// Independent noise of each rod is a floor under the spectrum, here a third of the power of the shortest waves; rods
// at random places see the waves themselves as noise.
TEST(DirectorFluctuations, TakesTheFloorOff) {
  const DirectorSpectrum noisy = spectrum_of({.splay = 6, .bend = 18, .noise = 0.15}, 120, 0, 73);
  expect_constants(noisy, 6, 18);
  EXPECT_NEAR(noisy.floor, kBox * kBox * 0.15 * 0.15 / (kLattice * kLattice), 0.02);
  expect_constants(spectrum_of({.splay = 6, .bend = 18, .noise = 0.15, .disorder = 100}, 120, 0, 74), 6, 18);
}

// Rods stand in rows close together, 0.8 mm, and 8 mm apart along the row; rods side by side lean together, by a wave
// across that is too short to be measured, of far more than the noise that they have to themselves. That wave is not
// noise of every rod: the floor is the rods' own.
TEST(DirectorFluctuations, RodsThatLeanTogetherAreNoNoise) {
  Draw draw(78);
  Blocked<DirectorFluctuations> blocks(DirectorFluctuations(kBox, kAllWaves));
  for (int i = 0; i < 40; ++i) {
    std::vector<Vec3> positions, directors;
    const double phase = draw.uniform(0, 2 * kPi);
    for (int k = 0; k < 1000; ++k) {
      positions.push_back({8.0 * (k % 10) + draw.uniform(-0.2, 0.2), 0.8 * static_cast<double>(k / 10), 0});
      const double together = 0.1 * std::sin(2 * kPi * 8 * positions.back().y() / kBox + phase);
      directors.push_back(axis(together + 0.03 * draw.normal()));
    }
    blocks.accumulate(i, positions, directors);
  }
  const DirectorSpectrum spectrum = DirectorFluctuations::reduce(blocks, 0);
  const double own = kBox * kBox * 0.03 * 0.03 / 1000;
  // The wave's share between neighbours is cos(q d) = 0.88 of it, so 0.12 of its variance, 0.005, is still taken.
  EXPECT_GT(spectrum.floor, 0.95 * own);
  EXPECT_LT(spectrum.floor, own + 0.13 * kBox * kBox * 0.005 / 1000);
}

TEST(DirectorFluctuations, FollowsADirectorThatTurns) {
  expect_constants(spectrum_of({.splay = 6, .bend = 18, .theta = 1.2}, 120, 1.5, 75), 6, 18);
}

// Rods along x, all turned by a sin(q x): only that wave, of power L^2 a^2 / 4, less nothing.
TEST(DirectorFluctuations, OfOneWave) {
  constexpr double kTurn = 0.01;
  std::vector<Vec3> positions = {}, directors = {};
  for (int k = 0; k < 10000; ++k) {
    positions.push_back(0.8 * Vec3(k % 100 + 0.5, static_cast<double>(k / 100) + 0.5, 0));
    directors.push_back(axis(kTurn * std::sin(2 * kPi * 2 * positions.back().x() / kBox)));
  }
  Blocked<DirectorFluctuations> blocks(DirectorFluctuations(kBox, kAllWaves));
  blocks.accumulate(0, positions, directors);
  const DirectorSpectrum spectrum = DirectorFluctuations::reduce(blocks, 0);
  for (std::size_t i = 0; i < spectrum.power.size(); ++i) {
    const bool here = std::abs(spectrum.q_along[i] - 2 * 2 * kPi / kBox) < 1e-6 && spectrum.q_across[i] < 1e-6;
    EXPECT_NEAR(spectrum.power[i].value, here ? kBox * kBox * kTurn * kTurn / 4 : 0, 1e-4);
  }
  EXPECT_EQ(spectrum.power.size(), 48U);  // (m, +-n) fall together
}

TEST(DirectorFluctuations, NothingWithoutOrder) {
  Draw draw(76);
  Blocked<DirectorFluctuations> blocks(DirectorFluctuations(kBox, kAllWaves));
  EXPECT_TRUE(DirectorFluctuations::reduce(blocks, 0).power.empty());
  blocks.accumulate(0, random_places(draw, 1000, kBox), random_axes(draw, 1000));
  blocks.accumulate(1, std::vector<Vec3>{}, std::vector<Vec3>{});
  blocks.accumulate(2, std::vector<Vec3>{Vec3::Zero()}, std::vector<Vec3>{Vec3(0, 0, 1)});
  const DirectorSpectrum nothing = DirectorFluctuations::reduce(blocks, 0);
  EXPECT_EQ(nothing.samples, 0);
  EXPECT_TRUE(nothing.power.empty() && std::isnan(nothing.ratio.value) && std::isnan(nothing.chi2));
  blocks.accumulate(3, std::vector<Vec3>{Vec3::Zero()}, std::vector<Vec3>{axis(0.3)});
  EXPECT_EQ(DirectorFluctuations::reduce(blocks, 0).samples, 1);  // one rod is its own director: no fluctuation
  EXPECT_TRUE(std::isnan(DirectorFluctuations::reduce(blocks, 0).ratio.value));
}

}  // namespace director_fluctuations_test
}  // namespace shaken::analysis
