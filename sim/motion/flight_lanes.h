// SPDX-License-Identifier: MIT
#pragma once

#include "sim/lanes/double_lanes.h"
#include "sim/motion/flight.h"

namespace shaken {

/// Flights of several rods, component by component: what poses and motions at a later tick follow from.
struct FlightLanes {
  lanes::TripleLanes position, velocity, along, across, turned, precession;
  alignas(64) double spin[lanes::kDoubleLanes];
  alignas(64) double rate[lanes::kDoubleLanes];

  void set(int lane, const Flight& flight) {
    position.set(lane, flight.position);
    velocity.set(lane, flight.velocity);
    along.set(lane, flight.along);
    across.set(lane, flight.across);
    turned.set(lane, flight.turned);
    precession.set(lane, flight.precession);
    spin[lane] = flight.spin;
    rate[lane] = flight.rate;
  }
};

/// Poses and motions of several rods at a tick.
struct RodLanes {
  lanes::TripleLanes position, director, velocity, angular_velocity;
};

}  // namespace shaken
