// SPDX-License-Identifier: MIT
#include "scene/points.h"

#include <fmt/format.h>
#include <xxhash.h>

#include <cmath>
#include <cstddef>
#include <numeric>
#include <utility>

#include "base/core/check.h"
#include "base/core/natural_log.h"
#include "base/core/rng.h"

namespace shaken::scene {

namespace {

/// One line of the list of Joe & Kuo: a primitive polynomial of degree s, whose inner coefficients are the binary
/// digits of a, and the first s direction numbers.
struct Directions {
  unsigned s;
  std::uint32_t a;
  std::array<std::uint32_t, 7> m;
};

// Dimensions from 1 on; the first, number 0, has van der Corput's sequence.
constexpr std::array<Directions, kMaxSobolDimensions - 1> kDirections{{
    {1, 0, {1}},
    {2, 1, {1, 3}},
    {3, 1, {1, 3, 1}},
    {3, 2, {1, 1, 1}},
    {4, 1, {1, 1, 3, 3}},
    {4, 4, {1, 3, 5, 13}},
    {5, 2, {1, 1, 5, 5, 17}},
    {5, 4, {1, 1, 5, 5, 5}},
    {5, 7, {1, 1, 7, 11, 19}},
    {5, 11, {1, 1, 5, 1, 1}},
    {5, 13, {1, 1, 1, 3, 11}},
    {5, 14, {1, 3, 5, 5, 31}},
    {6, 1, {1, 3, 3, 9, 7, 49}},
    {6, 13, {1, 1, 1, 15, 21, 21}},
    {6, 16, {1, 3, 1, 13, 27, 49}},
    {6, 19, {1, 1, 1, 15, 7, 5}},
    {6, 22, {1, 3, 1, 15, 13, 25}},
    {6, 25, {1, 1, 5, 5, 19, 61}},
    {7, 1, {1, 3, 7, 11, 23, 15, 103}},
    {7, 4, {1, 3, 7, 13, 13, 15, 69}},
    {7, 7, {1, 1, 3, 13, 7, 35, 63}},
    {7, 8, {1, 3, 5, 9, 1, 25, 53}},
    {7, 14, {1, 3, 1, 13, 9, 35, 107}},
    {7, 19, {1, 3, 1, 5, 27, 61, 31}},
    {7, 21, {1, 1, 5, 11, 19, 41, 61}},
    {7, 28, {1, 3, 5, 3, 3, 13, 69}},
    {7, 31, {1, 1, 7, 13, 1, 19, 1}},
    {7, 32, {1, 3, 7, 5, 13, 19, 59}},
    {7, 37, {1, 1, 3, 9, 25, 29, 41}},
    {7, 41, {1, 3, 5, 13, 23, 1, 55}},
    {7, 42, {1, 3, 7, 3, 13, 59, 17}},
}};

constexpr unsigned kBits = 32;

/// What the seed draws for one key, number `index` of it.
Rng drawn_for(std::uint64_t seed, std::string_view path, std::uint64_t index) {
  return {seed, RngStream::kPoints, static_cast<Tick>(XXH3_64bits(path.data(), path.size())), index};
}

double random_coordinate(std::uint64_t seed, std::string_view path, int i) {
  const std::string key = fmt::format("{}/{}/{}", seed, path, i);
  return static_cast<double>(XXH3_64bits(key.data(), key.size()) >> 11) * 0x1p-53;
}

/// Point k lies anywhere in the stratum [p_k / n, (p_k + 1) / n) of a random permutation p (Fisher & Yates).
std::vector<double> latin_coordinates(std::uint64_t seed, std::string_view path, int n) {
  Rng rng = drawn_for(seed, path, 0);
  std::vector<double> strata(static_cast<std::size_t>(n));
  std::iota(strata.begin(), strata.end(), 0.0);
  for (std::size_t k = strata.size(); k > 1; --k) std::swap(strata[k - 1], strata[rng.below(k)]);
  // 32 digits: with more, a sum could be rounded up into the next stratum.
  for (double& place : strata) place = (place + static_cast<double>(rng.bits() >> 32) * 0x1p-32) / n;
  return strata;
}

/// `x` (in units of 2^-32) scrambled as A. B. Owen, J. Complexity 14 (1998) 466, does: whether a digit is flipped is
/// random, and depends on the digits before it. Every interval that is halved, quartered, ... keeps its share of
/// points, but no point stays at 0. The digits after the 32nd are random.
double scrambled(std::uint64_t seed, std::string_view path, std::uint32_t x) {
  std::uint64_t digits = 0;
  for (unsigned n_before = 0; n_before < kBits; ++n_before) {
    const std::uint64_t before = (std::uint64_t{1} << n_before) | (std::uint64_t{x} >> (kBits - n_before));
    const std::uint64_t digit = (x >> (kBits - 1 - n_before)) & 1;
    digits = 2 * digits + (digit ^ (drawn_for(seed, path, before).bits() >> 63));
  }
  const std::uint64_t rest = drawn_for(seed, path, (std::uint64_t{1} << kBits) | x).bits() >> (11 + kBits);
  return static_cast<double>((digits << (53 - kBits)) | rest) * 0x1p-53;
}

/// e^x; the same bits on every machine. Numerics: x = k ln 2 + r with |r| <= ln(2) / 2, and the series of e^r, of which
/// the first term left out is below 1e-17.
double exponential(double x) {
  constexpr double kLn2High = 0x1.62e42fefa38p-1;  // as in natural_log.h
  constexpr double kLn2Low = 0x1.ef35793c7673p-45;
  const double k = std::floor(x / kLn2High + 0.5);
  const double r = (x - k * kLn2High) - k * kLn2Low;
  double series = 1.0;
  for (int term = 14; term >= 1; --term) series = 1.0 + r / term * series;
  return std::ldexp(series, static_cast<int>(k));
}

}  // namespace

SobolSequence::SobolSequence(int dimension) {
  SHAKEN_CHECK(dimension >= 0 && dimension < kMaxSobolDimensions, "a dimension that has direction numbers");
  for (unsigned k = 0; k < kBits; ++k) {
    const unsigned shift = kBits - 1 - k;
    if (dimension == 0) {
      directions_[k] = 1u << shift;
      continue;
    }
    const Directions& row = kDirections[static_cast<std::size_t>(dimension - 1)];
    if (k < row.s) {
      directions_[k] = row.m[k] << shift;
      continue;
    }
    const std::uint32_t before = directions_[k - row.s];
    directions_[k] = before ^ (before >> row.s);
    for (unsigned j = 1; j < row.s; ++j) {
      if (((row.a >> (row.s - 1 - j)) & 1) != 0) directions_[k] ^= directions_[k - j];
    }
  }
}

std::uint32_t SobolSequence::point(std::uint32_t i) const {
  std::uint32_t x = 0;
  const std::uint32_t gray = i ^ (i >> 1);
  for (unsigned k = 0; k < kBits; ++k) {
    if (((gray >> k) & 1) != 0) x ^= directions_[k];
  }
  return x;
}

std::vector<double> CubePoints::coordinates(std::string_view path, int dimension) const {
  if (spread == Spread::kLatin) return latin_coordinates(seed, path, n);
  std::vector<double> all;
  all.reserve(static_cast<std::size_t>(n));
  if (spread == Spread::kRandom) {
    for (int i = 0; i < n; ++i) all.push_back(random_coordinate(seed, path, i));
  } else {
    const SobolSequence sequence(dimension);
    for (int i = 0; i < n; ++i) all.push_back(scrambled(seed, path, sequence.point(static_cast<std::uint32_t>(i))));
  }
  return all;
}

double between_on_log_scale(double from, double to, double share) {
  return from * exponential(share * natural_log(to / from));
}

}  // namespace shaken::scene
