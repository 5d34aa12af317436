// SPDX-License-Identifier: MIT
#include "sim/stepping/resting_rods.h"

#include <cmath>

#include "base/core/heap_bytes.h"
#include "sim/bounds/margins.h"

namespace shaken {
namespace {

using lanes::Doubles;
using lanes::Triple;

template <class D>
SHAKEN_INLINE void store_floats(float* to, const D& x) {
  constexpr int W = sizeof(D) / sizeof(double);
  typedef float Floats __attribute__((vector_size(W * sizeof(float))));
  const Floats rounded = __builtin_convertvector(x, Floats);
  __builtin_memcpy(to, &rounded, sizeof rounded);
}

}  // namespace

/// begin_flight (motion/flight.h) with the same bits, but that the place is not yet brought back into the box; the
/// VelocityJump that it is; and SkinBudget::cover_tick.
struct RestingRods::StoreKernel {
  const SpeciesMechanics& species;
  const TickRules& rules;
  Block& block;

  template <int W>
  SHAKEN_INLINE void run() const {
    for (int l = 0; l < kLanes8; l += W) store<W>(l);
  }

  template <int W>
  SHAKEN_INLINE void store(int l) const {
    using D = Doubles<W>;
    FlightLanes& flights = block.flights;
    const RodLanes& rods = block.hits.rods;
    const double half_length = species.half_length;

    const Triple<D> old_velocity = flights.velocity.load<W>(l);
    const Triple<D> old_precession = flights.precession.load<W>(l);
    const D old_rate = lanes::load<W>(flights.rate + l);

    flights.position.store(l, rods.position.load<W>(l));
    const Triple<D> velocity = rods.velocity.load<W>(l);
    flights.velocity.store(l, velocity);
    const Triple<D> flown = rods.director.load<W>(l);
    const Triple<D> director = (0.5 * (3.0 - flown.squared_norm())) * flown;
    flights.director.store(l, director);
    const Triple<D> angular_velocity = rods.angular_velocity.load<W>(l);
    const D spin = angular_velocity.dot(director);
    const Triple<D> precession = angular_velocity - ((1.0 - species.inertia_ratio) * spin) * director;
    const D rate = lanes::square_root(precession.squared_norm());
    const auto turns = rate > 0.0;
    const D zero{};
    const Triple<D> axis = precession / rate;
    const Triple<D> part = axis.dot(director) * axis;
    const Triple<D> across = director - part;
    const Triple<D> turned = axis.cross(director);
    const auto where_it_turns = [&](const Triple<D>& a, const Triple<D>& b) __attribute__((always_inline)) {
      return Triple<D>{turns ? a.x : b.x, turns ? a.y : b.y, turns ? a.z : b.z};
    };
    flights.along.store(l, where_it_turns(part, director));
    flights.across.store(l, where_it_turns(across, {zero, zero, zero}));
    flights.turned.store(l, where_it_turns(turned, {zero, zero, zero}));
    flights.precession.store(l, precession);
    lanes::store(flights.spin + l, spin);
    lanes::store(flights.rate + l, rate);

    Triple<D> jump = velocity - old_velocity;
    jump.z += rules.gravity * rules.dt;
    const Triple<D> tip = lanes::all<W>(half_length) * (precession - old_precession).cross(director);
    const D speed = lanes::square_root(jump.squared_norm());
    const D tip_speed = lanes::square_root(tip.squared_norm());
    const D rounding = margins::kJumpSpeed + margins::kJump * (speed + tip_speed);
    const D faster = lanes::larger(tip_speed, half_length * (rate - old_rate));
    const auto store_three = [&](float (*to)[kLanes8], const Triple<D>& v) __attribute__((always_inline)) {
      store_floats(to[0] + l, v.x);
      store_floats(to[1] + l, v.y);
      store_floats(to[2] + l, v.z);
    };
    store_three(block.jumps.velocity, jump);
    store_three(block.jumps.tip, tip);
    store_three(block.jumps.size, {rounding, rounding + (speed + faster) * (1.0 + margins::kJump),
                                   0.5 * half_length * lanes::larger(zero, rate * rate - old_rate * old_rate)});

    const D left = lanes::load<W>(block.skin_left + l) - lanes::load<W>(block.skin_speed + l) * rules.dt;
    lanes::store(block.skin_left + l, left - margins::kSkinStep * lanes::absolute(left));
    const D flat2 = director.x * director.x + director.y * director.y;
    const D lies = lanes::smaller(flat2 - 0.5, 0.2 - rate * rules.dt);  // > 0: yes
    const D drift = lanes::absolute(velocity.x) + lanes::absolute(velocity.y) + 2.0 * half_length * rate;
    lanes::store(block.skin_speed + l, lies > 0.0 ? drift : lanes::all<W>(1e30));
  }
};

RestingRods::RestingRods(const TickRules& rules, float slow)
    : rules_(rules), slow_(slow), blocks_(rules.species.size()), free_(rules.species.size()) {}

int RestingRods::enter(int i, const Flight& flight, const SkinBudget& skin) {
  const std::size_t species = rules_.species_of_rod[static_cast<std::size_t>(i)];
  std::vector<Block>& blocks = blocks_[species];
  std::vector<int>& free = free_[species];
  if (free.empty()) {
    for (int lane = kLanes8 - 1; lane >= 0; --lane) free.push_back(static_cast<int>(blocks.size()) * kLanes8 + lane);
    blocks.emplace_back();
    blocks.back().rods.fill(kNone);
  }
  const int slot = free.back();
  free.pop_back();
  Block& block = blocks[static_cast<std::size_t>(slot / kLanes8)];
  const int lane = slot % kLanes8;
  block.rods[static_cast<std::size_t>(lane)] = i;
  block.image[static_cast<std::size_t>(lane)] = flight.image;
  block.flights.set(lane, flight);
  block.skin_left[lane] = skin.left(flight.since, rules_.dt);
  block.skin_speed[lane] = skin.speed();
  ++size_;
  return slot;
}

void RestingRods::leave(int i, int slot, Flight& flight, SkinBudget& skin) {
  flight = this->flight(i, slot);
  Block& block = blocks_of(i)[static_cast<std::size_t>(slot / kLanes8)];
  const int lane = slot % kLanes8;
  skin.count_down(static_cast<float>(block.skin_left[lane]), static_cast<float>(block.skin_speed[lane]), since_);
  block.rods[static_cast<std::size_t>(lane)] = kNone;
  free_[rules_.species_of_rod[static_cast<std::size_t>(i)]].push_back(slot);
  --size_;
}

Flight RestingRods::flight(int i, int slot) const {
  const Block& block = block_of(i, slot);
  const int lane = slot % kLanes8;
  Flight flight;
  flight.since = since_;
  flight.image = block.image[static_cast<std::size_t>(lane)];
  block.flights.get(lane, flight);
  return flight;
}

bool RestingRods::stays(const Block& block, int lane) const {
  if (!block.hits.is_known(lane) || !block.hits.is_hit(lane)) return false;
  if (block.skin_left[lane] - block.skin_speed[lane] * rules_.dt < SkinBudget::kLeast) return false;
  RodAtTick rod;
  block.hits.get(lane, rod);
  return has_sound_motion(rod, rules_);
}

void RestingRods::begin_flights_of(Block& block, const SpeciesMechanics& species) const {
  lanes::with_widest_doubles(StoreKernel{species, rules_, block});
  for (std::size_t lane = 0; lane < kLanes8; ++lane) {
    wrap(block.flights.position.x[lane], block.image[lane][0], rules_.box_side);
    wrap(block.flights.position.y[lane], block.image[lane][1], rules_.box_side);
  }
}

VelocityJump RestingRods::jump(const Block& block, int lane) const {
  const lanes::TripleLanes& velocity = block.flights.velocity;
  if (std::max(std::abs(velocity.x[lane]), std::abs(velocity.y[lane])) >= slow_) return VelocityJump::unknown();
  const JumpLanes& jumps = block.jumps;
  return {{jumps.velocity[0][lane], jumps.velocity[1][lane], jumps.velocity[2][lane]},
          {jumps.tip[0][lane], jumps.tip[1][lane], jumps.tip[2][lane]},
          jumps.size[0][lane],
          jumps.size[1][lane],
          jumps.size[2][lane]};
}

std::size_t RestingRods::bytes() const {
  std::size_t bytes = heap_bytes(blocks_, free_);
  for (const auto& blocks : blocks_) bytes += heap_bytes(blocks);
  for (const auto& free : free_) bytes += heap_bytes(free);
  return bytes;
}

}  // namespace shaken
