#pragma once

#include <array>
#include <cmath>
#include <cstdint>

#include "base/core/box.h"
#include "base/core/sincos.h"
#include "base/core/types.h"
#include "sim/gravity.h"
#include "sim/rod/species.h"

namespace shaken {

/// Where a rod is at one tick.
struct Pose {
  Vec3 position;  ///< of the centre; x and y may lie outside the box [mm]
  Vec3 director;  ///< unit vector along the rod
};

/// How a rod moves at one tick.
struct Motion {
  Vec3 velocity;          ///< of the centre [mm/s]
  Vec3 angular_velocity;  ///< [rad/s]
};

/// A rod in free flight, stored as of the tick of its last change of velocity and evaluated in closed form at any later
/// tick: the centre flies on a parabola; the angular momentum J is constant, so the director precesses about it at the
/// rate |J| / I_perp while the spin about the rod's own axis stays (Landau & Lifshitz, Mechanics, section 33).
struct Flight {
  Tick since = 0;
  Vec3 position = Vec3::Zero();             ///< at `since`; x and y in the box [mm]
  Vec3 velocity = Vec3::Zero();             ///< at `since` [mm/s]
  Vec3 director = Vec3::UnitX();            ///< at `since`
  Vec3 precession = Vec3::Zero();           ///< J / I_perp [rad/s]
  double spin = 0;                          ///< angular velocity about the rod's axis [rad/s]
  std::array<std::int32_t, 2> image{0, 0};  ///< box crossings in x and y

  // derived from director and precession by prepare(): n(t) = along + cos(rate t) across + sin(rate t) turned
  double rate = 0;             ///< |precession| [rad/s]
  Vec3 along = Vec3::UnitX();  ///< part of the director along the precession axis
  Vec3 across = Vec3::Zero();  ///< the rest of it
  Vec3 turned = Vec3::Zero();  ///< precession axis x director

  void prepare() {
    rate = precession.norm();
    if (rate > 0) {
      const Vec3 axis = precession / rate;
      along = axis.dot(director) * axis;
      across = director - along;
      turned = axis.cross(director);
    } else {
      along = director;
      across.setZero();
      turned.setZero();
    }
  }
};

/// Pose after `tau` seconds of flight under gravity.
[[gnu::always_inline]] inline Pose pose_after(const Flight& flight, double tau, const Gravity& gravity) {
  Pose pose;
  pose.position = flight.position + flight.velocity * tau;
  pose.position.z() -= 0.5 * gravity.down * tau * tau;
  if (gravity.is_inclined) [[unlikely]] {
    pose.position.x() += 0.5 * gravity.along.x() * tau * tau;
    pose.position.y() += 0.5 * gravity.along.y() * tau * tau;
  }
  const SinCos turn = sincos(flight.rate * tau);
  pose.director = flight.along + turn.cos * flight.across + turn.sin * flight.turned;
  return pose;
}

/// Velocity of the centre after `tau` seconds of flight [mm/s].
[[gnu::always_inline]] inline Vec3 velocity_after(const Flight& flight, double tau, const Gravity& gravity) {
  Vec3 velocity = flight.velocity;
  velocity.z() -= gravity.down * tau;
  if (gravity.is_inclined) [[unlikely]] {
    velocity.x() += gravity.along.x() * tau;
    velocity.y() += gravity.along.y() * tau;
  }
  return velocity;
}

/// Motion after `tau` seconds of flight, where the director has become `director`.
[[gnu::always_inline]] inline Motion motion_after(const Flight& flight, double tau, const Gravity& gravity,
                                                  const Vec3& director, double inertia_ratio) {
  Motion motion;
  motion.velocity = velocity_after(flight, tau, gravity);
  motion.angular_velocity = flight.precession + (1.0 - inertia_ratio) * flight.spin * director;
  return motion;
}

/// Brings a coordinate back into [0, side) and counts the crossings.
inline void wrap(double& x, std::int32_t& image, double side) {
  if (x < 0 || x >= side) {
    const double crossings = std::floor(x / side);
    x -= crossings * side;
    image += static_cast<std::int32_t>(crossings);
  }
  // what is left are rounding errors at the border
  if (x >= side) {
    x = 0;
    ++image;
  } else if (x < 0) {
    x = 0;
  }
}

/// Stores a new flight that begins at tick `now`; `inertia_ratio` is I_par / I_perp.
inline void begin_flight(Flight& flight, Tick now, const Pose& pose, const Motion& motion, const Box& box,
                         double inertia_ratio) {
  flight.since = now;
  flight.position = pose.position;
  wrap(flight.position.x(), flight.image[0], box.x());
  wrap(flight.position.y(), flight.image[1], box.y());
  flight.velocity = motion.velocity;
  // one Newton step towards |n| = 1 keeps the length of the director from drifting over 10^7 flights
  flight.director = pose.director * (0.5 * (3.0 - pose.director.squaredNorm()));
  flight.spin = motion.angular_velocity.dot(flight.director);
  flight.precession = motion.angular_velocity - (1.0 - inertia_ratio) * flight.spin * flight.director;
  flight.prepare();
}

}  // namespace shaken
