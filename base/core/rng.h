#pragma once

#include <cmath>
#include <cstdint>

#include "base/core/natural_log.h"
#include "base/core/sincos.h"
#include "base/core/types.h"

namespace shaken {

/// Who draws random numbers: one entry for each use, so that no two uses share a sequence.
enum class RngStream : std::uint64_t {
  kLattice = 1,
  kVelocity = 2,
  kInsertion = 3,
  kKinds = 4,
  kNoise = 5,
  kContacts = 6,
  kReferences = 7,
  kKicks = 9,
  kSamples = 10,
  kDomains = 11
};

/// Random numbers keyed by (seed, stream, tick, index): what a rod draws depends on nothing but its own index and the
/// tick (0 for what is drawn once), not on the order of loops or on threads. Each part of the key is mixed in by
/// itself, so that neighbouring seeds and ticks have nothing in common. SplitMix64 (Steele, Lea & Flood 2014) over a
/// counter.
class Rng {
 public:
  Rng(std::uint64_t seed, RngStream stream, Tick tick, std::uint64_t index)
      : state_(
            mix(mix(mix(mix(seed) ^ static_cast<std::uint64_t>(stream)) ^ static_cast<std::uint64_t>(tick)) ^ index)) {}

  std::uint64_t bits() {
    state_ += 0x9e3779b97f4a7c15ull;
    return mix(state_);
  }
  /// In [0, 1).
  double uniform() { return static_cast<double>(bits() >> 11) * 0x1p-53; }
  /// In [low, high).
  double uniform(double low, double high) { return low + (high - low) * uniform(); }
  /// In [0, n).
  std::uint64_t below(std::uint64_t n) { return static_cast<std::uint64_t>(uniform() * static_cast<double>(n)); }
  /// Mean 0, variance 1 (Box & Muller 1958).
  double normal() {
    const double radius = std::sqrt(-2.0 * natural_log(1.0 - uniform()));
    return radius * sincos(2.0 * kPi * uniform()).cos;
  }

 private:
  static std::uint64_t mix(std::uint64_t z) {
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
    return z ^ (z >> 31);
  }
  std::uint64_t state_;
};

}  // namespace shaken
