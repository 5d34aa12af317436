#include "analysis/geometry/wave_sums.h"

#include <algorithm>
#include <cmath>
#include <complex>

#include "base/core/box_grids.h"
#include "base/core/check.h"

namespace shaken::analysis {
namespace {

// The sums are a product of two matrices, (cos m x | sin m x)^T (cos n y | sin n y), computed in tiles of kTile x kTile
// that stay in registers; factors are stored tile by tile, for kChunk places at a time, which stay in the cache.
constexpr std::size_t kTile = 4;
constexpr std::size_t kChunk = 64;

/// Two doubles at a time, on every x86-64 and with the same rounding as one at a time.
typedef double Pair __attribute__((vector_size(16)));

/// tile (kTile x kTile) += sum over k of a[k] b[k]^T.
void add_products(const double* a, const double* b, std::size_t count, double* tile) {
  Pair sums[kTile][2] = {};
  for (std::size_t k = 0; k < count; ++k) {
    Pair low, high;
    __builtin_memcpy(&low, b + k * kTile, sizeof low);
    __builtin_memcpy(&high, b + k * kTile + 2, sizeof high);
    for (std::size_t row = 0; row < kTile; ++row) {
      const double factor = a[k * kTile + row];
      sums[row][0] += factor * low;
      sums[row][1] += factor * high;
    }
  }
  for (std::size_t row = 0; row < kTile; ++row) {
    for (std::size_t half = 0; half < 2; ++half) {
      tile[row * kTile + 2 * half] += sums[row][half][0];
      tile[row * kTile + 2 * half + 1] += sums[row][half][1];
    }
  }
}

/// Writes weight * (cos k a, k = 0 .. waves | sin k a) as column `place` of the tiles of one chunk.
void put_powers(double weight, double angle, std::size_t waves, std::size_t place, std::vector<double>& factors) {
  const std::complex<double> step(std::cos(angle), std::sin(angle));
  std::complex<double> power = weight;
  for (std::size_t k = 0; k <= waves; ++k) {
    const std::size_t sine = waves + 1 + k;
    factors[(k / kTile * kChunk + place) * kTile + k % kTile] = power.real();
    factors[(sine / kTile * kChunk + place) * kTile + sine % kTile] = power.imag();
    power = {power.real() * step.real() - power.imag() * step.imag(),
             power.real() * step.imag() + power.imag() * step.real()};
  }
}

}  // namespace

WaveVectors::WaveVectors(const Box& in_box, int most_waves)
    : box(in_box),
      waves(most_waves),
      most_m(static_cast<int>(shaken::most_waves(in_box, most_waves).x())),
      most_n(static_cast<int>(shaken::most_waves(in_box, most_waves).y())) {
  SHAKEN_CHECK(waves >= 1 && box.shorter() > 0.0, "a box and waves in it");
}

std::vector<double> wave_powers(std::span<const Vec2> places, std::span<const double> weights,
                                const WaveVectors& vectors) {
  SHAKEN_CHECK(places.size() == weights.size(), "one weight for each place");
  const auto m_max = static_cast<std::size_t>(vectors.most_m), n_max = static_cast<std::size_t>(vectors.most_n);
  const auto tiles_for = [](std::size_t waves) { return (2 * (waves + 1) + kTile - 1) / kTile; };
  const std::size_t rows = tiles_for(m_max), columns = tiles_for(n_max);
  std::vector<double> of_x(rows * kChunk * kTile), of_y(columns * kChunk * kTile), sums(rows * columns * kTile * kTile);
  for (std::size_t start = 0; start < places.size(); start += kChunk) {
    const std::size_t count = std::min(kChunk, places.size() - start);
    for (std::size_t k = 0; k < count; ++k) {
      const Vec2& place = places[start + k];
      put_powers(weights[start + k], place.x() * (2 * kPi / vectors.box.x()), m_max, k, of_x);
      put_powers(1.0, place.y() * (2 * kPi / vectors.box.y()), n_max, k, of_y);
    }
    for (std::size_t i = 0; i < rows; ++i) {
      for (std::size_t j = 0; j < columns; ++j) {
        add_products(&of_x[i * kChunk * kTile], &of_y[j * kChunk * kTile], count,
                     &sums[(i * columns + j) * kTile * kTile]);
      }
    }
  }

  const auto sum = [&](std::size_t row, std::size_t column) {
    return sums[((row / kTile) * columns + column / kTile) * kTile * kTile + row % kTile * kTile + column % kTile];
  };
  std::vector<double> powers(vectors.size());
  for (int m = 0; m <= vectors.most_m; ++m) {
    for (int n = 0; n <= vectors.most_n; ++n) {
      const auto row = static_cast<std::size_t>(m), column = static_cast<std::size_t>(n);
      const double cc = sum(row, column), ss = sum(row + m_max + 1, column + n_max + 1);
      const double sc = sum(row + m_max + 1, column), cs = sum(row, column + n_max + 1);
      powers[vectors.index(m, n)] = (cc - ss) * (cc - ss) + (sc + cs) * (sc + cs);
      powers[vectors.index(m, -n)] = (cc + ss) * (cc + ss) + (sc - cs) * (sc - cs);
    }
  }
  return powers;
}

}  // namespace shaken::analysis
