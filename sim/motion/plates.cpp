#include "sim/motion/plates.h"

#include <algorithm>
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

double radians(double degrees) { return degrees * (kPi / 180.0); }

}  // namespace

TickPhases::TickPhases(double frequency, double dt) {
  const double cycles = frequency * dt;
  if (!(cycles > 0)) {
    period_ = 1;
    return;
  }
  // f and dt are decimal numbers rounded to binary: a period within 1e-12 of a whole number of ticks is meant to be one
  const double period = 1.0 / cycles;
  const double whole = std::round(period);
  if (whole <= static_cast<double>(kLongestTable) && std::abs(period - whole) <= 1e-12 * whole) {
    period_ = static_cast<Tick>(whole);
  } else {
    const double rest = std::fma(frequency, dt, -cycles);  // cycles + rest is the exact product
    phase_per_tick_ = to_fixed(cycles - std::floor(cycles));
    phase_per_tick_ += rest >= 0 ? to_fixed(rest) : -to_fixed(-rest);
  }
}

double TickPhases::at(Tick k) const {
  if (period_ > 0) return static_cast<double>(k % period_) / static_cast<double>(period_);
  const Fixed128 phase = phase_per_tick_ * static_cast<Fixed128>(k);
  return static_cast<double>(static_cast<std::uint64_t>(phase >> 64)) * 0x1p-64;
}

PlateMotion::PlateMotion(double amplitude, double frequency, double gap, double dt, const HorizontalMotion& horizontal)
    : amplitude_(amplitude),
      angular_frequency_(2.0 * kPi * frequency),
      gap_(gap),
      horizontal_(horizontal),
      phases_(frequency, dt) {
  const SinCos direction = sincos(horizontal.angle);
  direction_ = {direction.cos, direction.sin};
  fill_table();
}

PlateMotion::PlateMotion(const System& system)
    : PlateMotion(system.amplitude, system.frequency, system.gap, system.dt,
                  {system.horizontal_amplitude, radians(system.horizontal_phase), radians(system.horizontal_angle)}) {
  if (system.has_second_vibration()) {
    const SecondVibration& second = *system.second;
    second_ = Second{.amplitude = second.amplitude,
                     .angular_frequency = 2.0 * kPi * second.frequency,
                     .phase = radians(second.phase),
                     .phases = TickPhases(second.frequency, system.dt)};
    for (Tick k = 0; k < second_->phases.period(); ++k)
      second_->table.push_back(second_->at_phase(second_->phases.at(k)));
  }
  if (!system.has_lid_motion()) return;
  lid_ = system.lid_motion;
  fill_table();
}

PlateMotion PlateMotion::without_ticks(System system) {
  system.dt = 0;
  return PlateMotion(system);
}

void PlateMotion::fill_table() {
  table_.clear();
  for (Tick k = 0; k < phases_.period(); ++k) table_.push_back(at_phase(phases_.at(k)));
}

double PlateMotion::peak_acceleration() const {
  const double first = amplitude_ * angular_frequency_ * angular_frequency_;
  return second_ ? first + second_->peak_acceleration() : first;
}

double PlateMotion::peak_lid_acceleration() const {
  return lid_ ? lid_->amplitude * angular_frequency_ * angular_frequency_ : peak_acceleration();
}

double PlateMotion::peak_speed() const {
  const double first = amplitude_ * angular_frequency_;
  const double base = second_ ? first + second_->amplitude * second_->angular_frequency : first;
  return lid_ ? std::max(base, lid_->amplitude * angular_frequency_) : base;
}

double PlateMotion::least_gap() const {
  if (!lid_) return gap_;
  const SinCos ahead = sincos(radians(lid_->phase));
  const double closing = std::hypot(amplitude_ - lid_->amplitude * ahead.cos, lid_->amplitude * ahead.sin);
  return gap_ - closing - second_amplitude();
}

PlateState PlateMotion::at_phase(double cycles) const {
  const SinCos angle = sincos(2.0 * kPi * cycles);
  PlateState state{};
  state.base = amplitude_ * angle.cos + amplitude_;
  state.lid = state.base + gap_;
  state.velocity = state.lid_velocity = -amplitude_ * angular_frequency_ * angle.sin;
  if (lid_) {
    const SinCos ahead = sincos(2.0 * kPi * cycles + radians(lid_->phase));
    state.lid = lid_middle() + lid_->amplitude * ahead.cos;
    state.lid_velocity = -lid_->amplitude * angular_frequency_ * ahead.sin;
  }
  if (horizontal_.amplitude > 0) {
    const SinCos ahead = sincos(2.0 * kPi * cycles + horizontal_.phase);
    state.shift = horizontal_.amplitude * ahead.cos;
    state.slide = -horizontal_.amplitude * angular_frequency_ * ahead.sin;
  }
  return state;
}

PlateMotion::Moving PlateMotion::Second::at_phase(double cycles) const {
  const SinCos angle = sincos(2.0 * kPi * cycles + phase);
  return {amplitude * angle.cos, -amplitude * angular_frequency * angle.sin};
}

PlateMotion::Moving PlateMotion::moved_back(double middle, const Moving& then, double angular_frequency,
                                            double seconds) {
  if (!(angular_frequency > 0)) return then;
  const SinCos turn = sincos(angular_frequency * seconds);
  const double cos = then.place - middle;                 // amplitude times that of the phase
  const double sin = -then.velocity / angular_frequency;  // the same
  return {middle + cos * turn.cos + sin * turn.sin, -angular_frequency * (sin * turn.cos - cos * turn.sin)};
}

PlateMotion::Moving PlateMotion::second_at(Tick k) const {
  const std::vector<Moving>& table = second_->table;
  return table.empty() ? second_->at_phase(second_->phases.at(k)) : table[static_cast<std::size_t>(k) % table.size()];
}

void PlateMotion::add_second(PlateState& state, const Moving& second) const {
  const double raised = second.place + second_->amplitude;  // the base never goes below 0
  state.base += raised;
  state.velocity += second.velocity;
  state.lid += lid_ ? second_->amplitude : raised;
  state.lid_velocity += lid_ ? 0.0 : second.velocity;
}

PlateState PlateMotion::with_second(Tick k) const {
  PlateState state = first_at(k);
  add_second(state, second_at(k));
  return state;
}

PlateState PlateMotion::before(Tick k, double seconds) const {
  const PlateState then = first_at(k);
  const auto back = [&](double middle, double place, double velocity) {
    return moved_back(middle, {place, velocity}, angular_frequency_, seconds);
  };
  const Moving base = back(amplitude_, then.base, then.velocity);
  const Moving horizontal = back(0.0, then.shift, then.slide);
  PlateState state{base.place, base.place + gap_, base.velocity, base.velocity, horizontal.place, horizontal.velocity};
  if (lid_) {
    const Moving lid = back(lid_middle(), then.lid, then.lid_velocity);
    state.lid = lid.place;
    state.lid_velocity = lid.velocity;
  }
  if (second_) add_second(state, moved_back(0.0, second_at(k), second_->angular_frequency, seconds));
  return state;
}

double System::least_gap() const { return PlateMotion::without_ticks(*this).least_gap(); }

double System::peak_plate_speed() const { return PlateMotion::without_ticks(*this).peak_speed(); }

PlatesAtStart plates_at_start(const System& system) {
  const PlateState first = PlateMotion::without_ticks(system).at(0);
  return {first.base, system.has_lid_motion() ? first.lid - first.base : system.gap};
}

}  // namespace shaken
