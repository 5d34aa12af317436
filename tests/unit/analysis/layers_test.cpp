#include "analysis/layers.h"

#include <gtest/gtest.h>

#include <functional>

#include "tests/unit/analysis/analysis_samples.h"

namespace shaken::analysis {
namespace layers_test {

constexpr double kBox = 60;

/// Rods at random places, each at director + tilt(phase of the wave 2 pi (m, n) / L there).
struct Rods {
  std::vector<Vec3> places, axes;
};
Rods layered(Draw& draw, std::size_t n_rods, double director, int m, int n, const std::function<double(double)>& tilt) {
  Rods rods{random_places(draw, n_rods, kBox), {}};
  for (const Vec3& place : rods.places) {
    rods.axes.push_back(axis(director + tilt(2 * kPi / kBox * (m * place.x() + n * place.y()))));
  }
  return rods;
}

// A sinusoid in s = sin 2 (theta - director), along the axis of the box and askew: the wave vector, its wavelength, and
// the amplitude as it was planted. Random places let the amplitude fluctuate by a / sqrt(N) and the director by a /
// sqrt(2 N).
TEST(LayerOrder, FindsAPlantedSinusoid) {
  Draw draw(161);
  for (const double amplitude : {0.1, 0.2, 0.4}) {
    struct Case {
      int m, n;
    };
    for (const Case& wave : {Case{0, 5}, {8, 0}, {3, 4}, {5, -12}}) {
      LayerOrder layers(kBox, 2.25);
      for (int t = 0; t < 10; ++t) {
        // the director at right angles to the wave vector, up to 20 degrees
        const double director = std::atan2(wave.n, wave.m) + kPi / 2 + draw.uniform(-0.35, 0.35);
        const Rods rods = layered(draw, 2000, director, wave.m, wave.n,
                                  [&](double phase) { return 0.5 * std::asin(amplitude * std::sin(phase)); });
        layers.accumulate(rods.places, rods.axes);
      }
      const std::optional<LayerPeak> peak = layers.peak();
      ASSERT_TRUE(peak);
      EXPECT_EQ(peak->m, wave.m);
      EXPECT_EQ(peak->n, wave.n);
      const double waves = std::hypot(wave.m, wave.n);
      EXPECT_NEAR(kBox / peak->wavelength, waves, 0.1);
      EXPECT_NEAR(peak->order / amplitude, 1.0, 0.05);
      // N a^2 / 4 shared by the wave vectors of its shell: the largest of the spectrum
      const LayerSpectrum spectrum = layers.reduce();
      const auto shell = static_cast<std::size_t>(std::lround(waves)) - 1;
      EXPECT_NEAR(spectrum.q[shell], 2 * kPi / kBox * static_cast<double>(shell + 1), 1e-12);
      for (std::size_t k = 0; k < spectrum.q.size(); ++k) {
        if (k != shell) {
          EXPECT_LT(spectrum.across[k], spectrum.across[shell]);
        }
        if (std::isfinite(spectrum.along[k])) {
          EXPECT_LT(spectrum.along[k], 3 * amplitude * amplitude);
        }
      }
    }
  }
}

// In a strip the wave vectors lie closer along the longer side, and wavelengths come in finer steps there.
TEST(LayerOrder, InAStrip) {
  const Box box(21, 126);
  Draw draw(166);
  LayerOrder layers(box, 2.25);
  constexpr int kWaves = 11;  // along y: 11.45 mm each
  for (int t = 0; t < 10; ++t) {
    const std::vector<Vec3> places = random_places(draw, 1500, box);
    std::vector<Vec3> axes;
    for (const Vec3& place : places)
      axes.push_back(axis(0.5 * std::asin(0.3 * std::sin(2 * kPi * kWaves * place.y() / 126))));
    layers.accumulate(places, axes);
  }
  const std::optional<LayerPeak> peak = layers.peak();
  ASSERT_TRUE(peak);
  EXPECT_EQ(std::pair(peak->m, peak->n), std::pair(0, kWaves));
  EXPECT_EQ(peak->side, 126);
  EXPECT_NEAR(peak->wavelength, 126.0 / kWaves, 0.15);
  EXPECT_NEAR(peak->order, 0.3, 0.015);
  EXPECT_NEAR(layers.reduce().q[kWaves - 1], 2 * kPi * kWaves / 126, 1e-12);
}

// A nematic without layers: the spectrum is <s^2>, flat, and the order the floor 2 sqrt(<s^2> / N) a little raised by
// being the largest of some hundred means of 100 samples, each with a relative spread of 1 / 10: by less than 20 % in
// the square root.
TEST(LayerOrder, OfAUniformNematicIsTheFloor) {
  constexpr double kSpread = 0.1, kRods = 1000;
  Draw draw(163);
  LayerOrder layers(kBox, 4.5);
  for (int t = 0; t < 100; ++t) {
    const Rods rods =
        layered(draw, static_cast<std::size_t>(kRods), 0.7, 0, 1, [&](double) { return kSpread * draw.normal(); });
    layers.accumulate(rods.places, rods.axes);
  }
  const double square = (1 - std::exp(-8 * kSpread * kSpread)) / 2;
  const LayerSpectrum spectrum = layers.reduce();
  for (std::size_t k = 3; k < spectrum.q.size(); ++k) {
    EXPECT_NEAR(spectrum.across[k] / square, 1.0, 0.4) << k;
    EXPECT_NEAR(spectrum.along[k] / square, 1.0, 0.4) << k;
  }
  const double floor = 2 * std::sqrt(square / kRods);
  EXPECT_GT(layers.peak()->order, floor);
  EXPECT_LT(layers.peak()->order, 1.2 * floor);
  EXPECT_NEAR(layers.peak()->floor / floor, 1.0, 0.02);
  EXPECT_FALSE(layers.peak()->stands_out());
}

// A wave along the director is no layer; one that has it at a steep angle is out of the cone.
TEST(LayerOrder, WavesAlongTheDirectorAreNone) {
  Draw draw(164);
  LayerOrder layers(kBox, 4.5);
  const Rods rods = layered(draw, 4000, 0, 6, 0, [](double phase) { return 0.2 * std::sin(phase); });
  layers.accumulate(rods.places, rods.axes);
  EXPECT_LT(layers.peak()->order, 0.05);
  EXPECT_GT(layers.reduce().along[5], 20 * layers.reduce().across[5]);
}

// Half the power each in two neighbouring wavelengths: the wavelength is that of the mean wave vector.
TEST(LayerOrder, InterpolatesBetweenWavesOfTheBox) {
  Draw draw(165);
  LayerOrder layers(kBox, 4.5);
  for (int t = 0; t < 40; ++t) {
    const Rods rods = layered(draw, 2000, 0, 0, t % 2 == 0 ? 6 : 7, [](double phase) { return 0.2 * std::sin(phase); });
    layers.accumulate(rods.places, rods.axes);
  }
  EXPECT_NEAR(kBox / layers.peak()->wavelength, 6.5, 0.05);
}

// A weak wave on the background of uncorrelated rods, with neighbours at the edge of the cone of 30 degrees: those of
// (0, 2) at 45 degrees are out and their opposites, at 18, in; those of (0, 3) at 27 degrees go in and out as the
// director turns. The background has a tenth of the wave's power at each of eight neighbours. One counted with its
// opposite left out, or less often, would move the wavelength by 0.12 of a wave to the box for (0, 2), 0.04 for (0, 3).
TEST(LayerOrder, ABackgroundAtTheEdgeOfTheConeMovesNothing) {
  constexpr double kAmplitude = 0.06, kSpread = 0.15;
  for (const int waves : {2, 3}) {
    for (const double turns : {0.0, 0.25}) {
      Draw draw(167);
      LayerOrder layers(kBox, 4.5);
      for (int t = 0; t < 400; ++t) {
        const double director = draw.uniform(-turns, turns);
        const Rods rods = layered(draw, 1000, director, 0, waves, [&](double phase) {
          return 0.5 * std::asin(kAmplitude * std::sin(phase)) + kSpread * draw.normal();
        });
        layers.accumulate(rods.places, rods.axes);
      }
      ASSERT_EQ(layers.peak()->n, waves);
      EXPECT_NEAR(kBox / layers.peak()->wavelength, waves, 0.025) << waves << " waves, turning by " << turns;
    }
  }
}

TEST(LayerOrder, OddInput) {
  EXPECT_THROW(LayerOrder(kBox, 0), std::logic_error);

  LayerOrder odd(kBox, 100);  // one wave at least
  EXPECT_FALSE(odd.peak());
  odd.accumulate({}, {});
  odd.accumulate(std::vector<Vec3>(1), std::vector<Vec3>{{0, 0, 1}});
  EXPECT_FALSE(odd.peak());
  EXPECT_TRUE(std::isnan(odd.reduce().across[0]));
  odd.accumulate(std::vector<Vec3>{{1, 2, 0}}, std::vector<Vec3>{axis(1)});
  EXPECT_NEAR(odd.peak()->order, 0.0, 1e-12);  // a rod by itself is the director
  EXPECT_TRUE(std::isfinite(odd.peak()->wavelength));
}

}  // namespace layers_test
}  // namespace shaken::analysis
