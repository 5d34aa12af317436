#include "sim/contact/restitution.h"

#include <cmath>

namespace shaken {

// Not inlined: loops that are flattened stay as small as they are where restitution is constant.
[[gnu::noinline]] double falling_restitution(double restitution, double speed, double reference_speed) {
  if (!(speed > 0)) return 1;
  const double v = speed / reference_speed;
  return v <= 1 ? 1.0 - (1.0 - restitution) * fifth_root(v) : restitution / std::sqrt(std::sqrt(v));
}

[[gnu::noinline]] void restitution_at(const ContactParameters& contact, std::span<double> speeds) {
  for (double& speed : speeds) speed = restitution_at(contact, speed);
}

}  // namespace shaken
