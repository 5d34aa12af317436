// SPDX-License-Identifier: MIT
#pragma once

#include "sim/lanes/double_lanes.h"
#include "sim/motion/flight.h"

namespace shaken {

/// Flights of several rods, component by component, but for `since` and `image`.
struct FlightLanes {
  lanes::TripleLanes position, velocity, director, along, across, turned, precession;
  alignas(64) double spin[lanes::kDoubleLanes];
  alignas(64) double rate[lanes::kDoubleLanes];

  void set(int lane, const Flight& flight) {
    position.set(lane, flight.position);
    velocity.set(lane, flight.velocity);
    director.set(lane, flight.director);
    along.set(lane, flight.along);
    across.set(lane, flight.across);
    turned.set(lane, flight.turned);
    precession.set(lane, flight.precession);
    spin[lane] = flight.spin;
    rate[lane] = flight.rate;
  }
  void get(int lane, Flight& flight) const {
    position.get(lane, flight.position);
    velocity.get(lane, flight.velocity);
    director.get(lane, flight.director);
    along.get(lane, flight.along);
    across.get(lane, flight.across);
    turned.get(lane, flight.turned);
    precession.get(lane, flight.precession);
    flight.spin = spin[lane];
    flight.rate = rate[lane];
  }
};

/// Poses and motions of several rods at a tick.
struct RodLanes {
  lanes::TripleLanes position, director, velocity, angular_velocity;
};

}  // namespace shaken
