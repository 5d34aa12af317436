// SPDX-License-Identifier: MIT
#include "run/probe/impulse_cost.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "run/probe/clock.h"
#include "sim/contact/impulse.h"

namespace shaken::run {
namespace {

constexpr int kBatches = 9;          ///< of which the fastest counts
constexpr double kBatchTime = 2e-3;  ///< CPU time of one batch, about [s]
constexpr std::size_t kMostHits = 2000;

/// What the law is given.
struct Hit {
  Mat3 compliance;
  Vec3 normal;
  Vec3 approach;
};

/// Each rod is hit where its surface is in the direction -normal from one end. The normals are all around.
std::vector<Hit> hits_on(const World& world) {
  const Species& species = world.species.front();
  const InverseInertia inverse = inverse_inertia(species);
  const double ratio = species.inertia_par / species.inertia_perp;
  std::vector<Hit> hits;
  for (std::size_t i = 0; i < std::min(world.rods.size(), kMostHits); ++i) {
    const Flight& flight = world.rods[i];
    const double angle = static_cast<double>(i);
    const Vec3 normal(0.6 * std::cos(angle), 0.6 * std::sin(angle), 0.8);
    const Vec3 arm = (i % 2 == 0 ? 1 : -1) * species.half_length * flight.director - species.end_radius * normal;
    const Motion motion = motion_after(flight, 0, world.scene.gravity, flight.director, ratio);
    Vec3 u = point_velocity(motion, arm);
    if (u.dot(normal) > 0) u = -u;
    hits.push_back({point_compliance(inverse, flight.director, arm), normal, u});
  }
  return hits;
}

/// CPU time of one impulse by each of the `laws`, in turn, the least of several batches [s].
template <std::size_t kLaws>
std::array<double, kLaws> time_laws(const std::vector<Hit>& hits, const std::array<ContactParameters, kLaws>& laws) {
  std::array<double, kLaws> least;
  least.fill(std::numeric_limits<double>::infinity());
  Vec3 sum = Vec3::Zero();
  for (int batch = 0; batch < kBatches; ++batch) {
    for (std::size_t law = 0; law < kLaws; ++law) {
      const double all = time_of(
          [&] {
            for (const Hit& hit : hits)
              sum += newton_coulomb_impulse(hit.compliance, hit.normal, hit.approach, laws[law]);
            asm volatile("" : : "r"(sum.data()) : "memory");  // the sum is wanted
          },
          kBatchTime, 1);
      least[law] = std::min(least[law], all / static_cast<double>(hits.size()));
    }
  }
  return least;
}

}  // namespace

ImpulseCost time_impulses(const World& world, const ContactParameters& contact) {
  if (world.rods.empty()) return {};
  // The law as it is stands there twice: what its two times differ by is the noise.
  const auto [as_it_is, again, without_friction, without_bounce] =
      time_laws<4>(hits_on(world), {contact, contact, {0.0, contact.restitution}, {contact.friction, 0.0}});
  const double with = std::min(as_it_is, again);
  const double noise = std::abs(as_it_is - again);
  const auto beyond_noise = [&](double difference) { return difference > noise ? difference : 0.0; };
  return {beyond_noise(with - without_friction), beyond_noise(with - without_bounce)};
}

}  // namespace shaken::run
