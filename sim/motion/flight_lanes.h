#pragma once

#include "base/core/sincos.h"
#include "sim/gravity.h"
#include "sim/lanes/double_lanes.h"
#include "sim/motion/flight.h"

/// Flights of several rods at a time: each lane has the bits of the functions of motion/flight.h.
namespace shaken::lanes {

template <class D>
struct PoseOf {
  Triple<D> position, director;
};
template <class D>
struct MotionOf {
  Triple<D> velocity, angular_velocity;
};

/// Poses and motions at a later tick follow from this.
template <class D>
struct FlightOf {
  Triple<D> position, velocity, along, across, turned, precession;
  D spin, rate;
};

/// What `prepare` derives, of rods that precess.
template <class D>
SHAKEN_INLINE FlightOf<D> flight_of(const PoseOf<D>& pose, const MotionOf<D>& motion, double inertia_ratio) {
  FlightOf<D> flight;
  flight.position = pose.position;
  flight.velocity = motion.velocity;
  flight.spin = motion.angular_velocity.dot(pose.director);
  const D about_axis = (1.0 - inertia_ratio) * flight.spin;
  flight.precession = motion.angular_velocity - about_axis * pose.director;
  flight.rate = square_root(flight.precession.squared_norm());
  const Triple<D> axis = flight.precession / flight.rate;
  flight.along = axis.dot(pose.director) * axis;
  flight.across = pose.director - flight.along;
  flight.turned = axis.cross(pose.director);
  return flight;
}

/// The pose of rods that turn by at most kLargestSmallAngle.
template <class D>
SHAKEN_INLINE PoseOf<D> pose_after(const FlightOf<D>& flight, const D& tau, const Gravity& gravity) {
  PoseOf<D> pose;
  pose.position = flight.position + tau * flight.velocity;
  pose.position.z -= 0.5 * gravity.down * tau * tau;
  if (gravity.is_inclined) [[unlikely]] {
    pose.position.x += 0.5 * gravity.along.x() * tau * tau;
    pose.position.y += 0.5 * gravity.along.y() * tau * tau;
  }
  const SinCosOf<D> turn = sincos_of_small(D(flight.rate * tau));
  pose.director = flight.along + turn.cos * flight.across + turn.sin * flight.turned;
  return pose;
}

template <class D>
SHAKEN_INLINE MotionOf<D> motion_after(const FlightOf<D>& flight, const D& tau, const Gravity& gravity,
                                       const Triple<D>& director, double inertia_ratio) {
  MotionOf<D> motion;
  motion.velocity = flight.velocity;
  motion.velocity.z -= gravity.down * tau;
  if (gravity.is_inclined) [[unlikely]] {
    motion.velocity.x += gravity.along.x() * tau;
    motion.velocity.y += gravity.along.y() * tau;
  }
  const D about_axis = (1.0 - inertia_ratio) * flight.spin;
  motion.angular_velocity = flight.precession + about_axis * director;
  return motion;
}

/// Flights as they are loaded from.
struct FlightLanes {
  TripleLanes position, velocity, along, across, turned, precession;
  alignas(64) double spin[kDoubleLanes];
  alignas(64) double rate[kDoubleLanes];

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
  template <int W>
  SHAKEN_INLINE FlightOf<Doubles<W>> load(int l) const {
    return {position.load<W>(l), velocity.load<W>(l),   along.load<W>(l),         across.load<W>(l),
            turned.load<W>(l),   precession.load<W>(l), lanes::load<W>(spin + l), lanes::load<W>(rate + l)};
  }
};

}  // namespace shaken::lanes
