#include "sim/schedule/skin_budget.h"

#include <algorithm>
#include <cmath>

#include "sim/bounds/margins.h"

namespace shaken {
namespace {

/// Below this, what remains is measured again rather than counted down [mm].
constexpr float kLow = 0.05F;

/// How fast the ends of a rod's shadow on the plane move at most, and for how long they do.
struct ShadowSpeed {
  double speed;  ///< [mm/s]
  double time;   ///< [s]; 0: they may move at any speed
};

/// Model: the centre flies at v. The segment turns at (p_z - n_z p.n) / |n_xy|^2, with p the precession and p.n a
/// constant. |n_xy| changes by at most |p| per time, so it keeps nine tenths, and its square 0.81, for a time of
/// 0.1 |n_xy| / |p|, less a tick: the visit may come one later than said.
ShadowSpeed shadow_speed(const Flight& flight, const Vec3& n, const SkinBudget::Steps& steps, Tick now,
                         double longest) {
  const Vec3& v = flight.velocity;
  const Vec3& p = flight.precession;
  ShadowSpeed shadow{std::sqrt(v.x() * v.x() + v.y() * v.y()), longest};
  if (steps.pull > 0) shadow.speed += steps.pull * (static_cast<double>(now - flight.since) * steps.dt + longest);
  if (steps.half_length > 0 && flight.rate > 0) {  // a sphere has no segment
    const double flat2 = n.x() * n.x() + n.y() * n.y();
    const double upright = 0.1 * std::sqrt(flat2) / flight.rate - steps.dt;
    if (!(upright > 0)) return {0, 0};
    shadow.time = std::min(longest, upright);
    shadow.speed += steps.half_length * (std::abs(p.z()) + std::abs(p.dot(n))) / (0.81 * flat2);
  }
  return shadow;
}

}  // namespace

void SkinBudget::measure(const NeighborList& list, int rod, const Pose& pose, Tick now) {
  remaining_ = static_cast<float>(list.slack(rod, pose)) - margins::kSkinMeasured;
  at_ = now;
}

void SkinBudget::count_down(Tick now, double dt) {
  remaining_ = remaining(now, dt) * (1 - margins::kSkinStep);
  at_ = now;
}

Tick SkinBudget::covered_ticks(const NeighborList& list, int rod, const Flight& flight, const Pose& pose,
                               const Steps& steps, Tick now, Tick horizon) {
  count_down(now, steps.dt);
  if (remaining_ < kLow) measure(list, rod, pose, now);
  // a rod that does not move has all the time there is
  const double longest = static_cast<double>(horizon + 1) * steps.dt;
  const auto [speed, most] = shadow_speed(flight, pose.director, steps, now, longest);
  speed_ = static_cast<float>(speed);
  if (!(most > 0)) remaining_ = 0;  // to be measured at the next tick
  double time = most;
  if (speed > 0) time = std::min(time, std::max(static_cast<double>(remaining_), 0.0) / speed);
  return std::min(horizon, static_cast<Tick>(time / steps.dt * (1.0 - margins::kSkinTime)));
}

void SkinBudget::cover_tick(const Flight& flight, const Steps& steps, Tick now) {
  count_down(now, steps.dt);
  // The segment turns at rate / |n_xy| at most, and |n_xy| changes by the rate: here it stays above a half.
  const Vec3& n = flight.director;
  const bool lies = n.x() * n.x() + n.y() * n.y() > 0.5 && flight.rate * steps.dt < 0.2;
  const double speed = std::abs(flight.velocity.x()) + std::abs(flight.velocity.y()) +
                       2.0 * steps.half_length * flight.rate + 2.0 * steps.pull * steps.dt;
  speed_ = lies ? static_cast<float>(speed) : 1e30F;  // or else it is measured at the next tick
}

}  // namespace shaken
