// SPDX-License-Identifier: MIT
#include "sim/motion/plates.h"

#include <cmath>

#include "base/core/sincos.h"

namespace shaken {
namespace {

__extension__ using Fixed128 = unsigned __int128;

/// x in [0, 1) as a multiple of 2^-128, exactly.
Fixed128 to_fixed(double x) {
  const double high = std::floor(x * 0x1p64);
  const double low = (x * 0x1p64 - high) * 0x1p64;
  return (static_cast<Fixed128>(high) << 64) + static_cast<Fixed128>(low);
}

constexpr Tick kLongestTable = 100000;

}  // namespace

PlateMotion::PlateMotion(double amplitude, double frequency, double gap, double dt, const HorizontalMotion& horizontal)
    : amplitude_(amplitude), angular_frequency_(2.0 * kPi * frequency), gap_(gap), horizontal_(horizontal) {
  const SinCos direction = sincos(horizontal.angle);
  direction_ = {direction.cos, direction.sin};
  const double cycles = frequency * dt;
  if (!(cycles > 0)) {
    table_.push_back(at_phase(0.0));
    return;
  }
  // f and dt are decimal numbers rounded to binary: a period within 1e-12 of a whole number of ticks is meant to be one
  const double period = 1.0 / cycles;
  const double whole = std::round(period);
  if (whole <= static_cast<double>(kLongestTable) && std::abs(period - whole) <= 1e-12 * whole) {
    const auto ticks = static_cast<std::int64_t>(whole);
    for (std::int64_t k = 0; k < ticks; ++k) table_.push_back(at_phase(static_cast<double>(k) / whole));
  } else {
    const double rest = std::fma(frequency, dt, -cycles);  // cycles + rest is the exact product
    phase_per_tick_ = to_fixed(cycles - std::floor(cycles));
    phase_per_tick_ += rest >= 0 ? to_fixed(rest) : -to_fixed(-rest);
  }
}

PlateState PlateMotion::at_phase(double cycles) const {
  const SinCos angle = sincos(2.0 * kPi * cycles);
  const double base = amplitude_ * angle.cos + amplitude_;
  const double velocity = -amplitude_ * angular_frequency_ * angle.sin;
  if (!(horizontal_.amplitude > 0)) return {base, base + gap_, velocity, 0.0, 0.0};
  const SinCos ahead = sincos(2.0 * kPi * cycles + horizontal_.phase);
  return {base, base + gap_, velocity, horizontal_.amplitude * ahead.cos,
          -horizontal_.amplitude * angular_frequency_ * ahead.sin};
}

PlateState PlateMotion::before(const PlateState& then, double seconds) const {
  if (!(angular_frequency_ > 0)) return then;
  const SinCos turn = sincos(angular_frequency_ * seconds);
  const double cos = then.base - amplitude_;               // a cos(phase)
  const double sin = -then.velocity / angular_frequency_;  // a sin(phase)
  const double base = amplitude_ + cos * turn.cos + sin * turn.sin;
  const double velocity = -angular_frequency_ * (sin * turn.cos - cos * turn.sin);
  const double shift_sin = -then.slide / angular_frequency_;  // b sin(phase + phi)
  return {base, base + gap_, velocity, then.shift * turn.cos + shift_sin * turn.sin,
          -angular_frequency_ * (shift_sin * turn.cos - then.shift * turn.sin)};
}

PlateState PlateMotion::at_phase_of(Tick k) const {
  const Fixed128 phase = phase_per_tick_ * static_cast<Fixed128>(k);
  return at_phase(static_cast<double>(static_cast<std::uint64_t>(phase >> 64)) * 0x1p-64);
}

}  // namespace shaken
