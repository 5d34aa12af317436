#include "sim/motion/start_motion.h"

namespace shaken {
namespace {

constexpr double kTurnSpeed = 5.0;  ///< of each angular velocity component across the rod [rad/s]

}  // namespace

void push_at_start(Flight& flight, const System& system, Rng& rng) {
  // in braces, whose order of evaluation is the same everywhere
  flight.velocity = kStartSpeed * Vec3{rng.normal(), rng.normal(), rng.normal()};
  Vec3 turn = kTurnSpeed * Vec3{rng.normal(), rng.normal(), rng.normal()};
  if (system.is_planar()) {
    flight.velocity.z() = 0;
    turn.head<2>().setZero();
  }
  flight.spin = 0;
  flight.precession = turn - turn.dot(flight.director) * flight.director;
  flight.prepare();
}

}  // namespace shaken
