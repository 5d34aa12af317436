// SPDX-License-Identifier: MIT
#include "sim/schedule/skin_budget.h"

#include <algorithm>
#include <cmath>

#include "sim/bounds/margins.h"

namespace shaken {
namespace {

/// Below this, what is left is measured again rather than counted down [mm].
constexpr float kLow = 0.05F;

}  // namespace

void SkinBudget::measure(const NeighborList& list, int rod, const Pose& pose, Tick now) {
  left_ = static_cast<float>(list.slack(rod, pose)) - margins::kSkinMeasured;
  at_ = now;
}

Tick SkinBudget::covered_ticks(const NeighborList& list, int rod, const Flight& flight, const Pose& pose,
                               double half_length, Tick now, double dt, Tick horizon, double pull) {
  left_ = left(now, dt) * (1 - margins::kSkinStep);
  at_ = now;
  if (left_ < kLow) measure(list, rod, pose, now);
  // The segment turns at (p_z - n_z p.n) / |n_xy|^2, with p the precession and p.n a constant; |n_xy| changes by at
  // most |p| per time, so it keeps nine tenths for a while: up to the visit, which may come a tick later than said
  // here.
  const Vec3& n = pose.director;
  const Vec3& v = flight.velocity;
  const Vec3& p = flight.precession;
  const double flat2 = n.x() * n.x() + n.y() * n.y();
  double time = static_cast<double>(horizon + 1) * dt;  // a rod at rest has all the time there is
  double speed = std::sqrt(v.x() * v.x() + v.y() * v.y());
  if (pull > 0) speed += pull * (static_cast<double>(now - flight.since) * dt + time);
  if (half_length > 0 && flight.rate > 0) {  // a sphere has no segment
    const double upright = 0.1 * std::sqrt(flat2) / flight.rate - dt;
    if (!(upright > 0)) {  // it may turn any way at once: to be measured at the next tick
      left_ = 0;
      speed_ = 0;
      return 0;
    }
    time = std::min(time, upright);
    speed += half_length * (std::abs(p.z()) + std::abs(p.dot(n))) / (0.81 * flat2);
  }
  speed_ = static_cast<float>(speed);
  if (speed > 0) time = std::min(time, std::max(static_cast<double>(left_), 0.0) / speed);
  return std::min(horizon, static_cast<Tick>(time / dt * (1.0 - margins::kSkinTime)));
}

void SkinBudget::cover_tick(const Flight& flight, double half_length, Tick now, double dt, double pull) {
  left_ = left(now, dt) * (1 - margins::kSkinStep);
  at_ = now;
  // The segment turns at rate / |n_xy| at most, and |n_xy| changes by the rate: here it stays above a half.
  const Vec3& n = flight.director;
  const bool lies = n.x() * n.x() + n.y() * n.y() > 0.5 && flight.rate * dt < 0.2;
  const double speed =
      std::abs(flight.velocity.x()) + std::abs(flight.velocity.y()) + 2.0 * half_length * flight.rate + 2.0 * pull * dt;
  speed_ = lies ? static_cast<float>(speed) : 1e30F;  // or else it is measured at the next tick
}

}  // namespace shaken
