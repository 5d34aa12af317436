// SPDX-License-Identifier: MIT
#include "run/probe/impulse_cost.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "base/clock.h"
#include "sim/contact/impulse.h"
#include "sim/contact/impulse_law.h"

namespace shaken::run {
namespace {

constexpr int kBatches = 9;          ///< of which the fastest counts
constexpr double kBatchTime = 2e-3;  ///< CPU time of one batch, about [s]
constexpr std::size_t kMostHits = 2000;

/// A rod that is about to be hit.
struct Hit {
  const Species* species;
  InverseInertia inverse;
  Motion motion;
  Vec3 director;
  Vec3 normal;
  double offset;  ///< of the bead along the rod [mm]
  Vec3 arm;       ///< from the centre to the contact [mm]
};

/// Each rod is hit at one end.
std::vector<Hit> hits_on(const World& world, Against what) {
  std::vector<Hit> hits;
  for (std::size_t i = 0; i < std::min(world.rods.size(), kMostHits); ++i) {
    const Flight& flight = world.rods[i];
    const Species& species = world.species_of(i);
    const double angle = static_cast<double>(i);  // all around, in time
    const Vec3 normal =
        what == Against::kPlate ? Vec3(0, 0, i % 4 < 2 ? 1 : -1) : Vec3(std::cos(angle), std::sin(angle), 0);
    const double offset = i % 2 == 0 ? species.half_length : -species.half_length;
    Hit hit{&species, inverse_inertia(species), {}, flight.director, normal, offset, {}};
    hit.motion =
        motion_after(flight, 0, world.scene.gravity, flight.director, species.inertia_par / species.inertia_perp);
    hit.arm = offset * flight.director - species.end_radius * normal;
    if (point_velocity(hit.motion, hit.arm).dot(normal) > 0) {
      hit.motion.velocity = -hit.motion.velocity;
      hit.motion.angular_velocity = -hit.motion.angular_velocity;
    }
    hits.push_back(hit);
  }
  return hits;
}

/// One impulse as the inner loops give it (stepping/impact.h).
Motion after_hit(ImpulseFunction law, const Hit& hit, const ContactParameters& contact) {
  Motion motion = hit.motion;
  const Vec3 u = point_velocity(motion, hit.arm);
  if (contact.friction > 0) {
    const Mat3 K = point_compliance(hit.inverse, hit.director, hit.arm);
    apply_impulse(motion, hit.inverse, hit.director, hit.arm, law(K, hit.normal, u, contact));
  } else {
    const double compliance = normal_compliance(hit.inverse, hit.director, hit.offset, hit.normal);
    const Vec3 P = (-(1.0 + contact.restitution) * u.dot(hit.normal) / compliance) * hit.normal;
    apply_normal_impulse(motion, hit.inverse, hit.director, hit.offset, P);
  }
  return motion;
}

/// CPU time of one impulse by each of the `contacts`, in turn, the least of several batches [s].
template <std::size_t kContacts>
std::array<double, kContacts> time_contacts(ImpulseFunction law, const std::vector<Hit>& hits,
                                            const std::array<ContactParameters, kContacts>& contacts) {
  std::array<double, kContacts> least;
  least.fill(std::numeric_limits<double>::infinity());
  Vec3 sum = Vec3::Zero();
  for (int batch = 0; batch < kBatches; ++batch) {
    for (std::size_t c = 0; c < kContacts; ++c) {
      const double all = time_of(
          [&] {
            for (const Hit& hit : hits) {
              const Motion motion = after_hit(law, hit, contacts[c]);
              sum += motion.velocity + motion.angular_velocity;
            }
            asm volatile("" : : "r"(sum.data()) : "memory");  // the sum is wanted
          },
          kBatchTime, 1);
      least[c] = std::min(least[c], all / static_cast<double>(hits.size()));
    }
  }
  return least;
}

ImpulseCost time_law(ImpulseFunction law, const std::vector<Hit>& hits, const ContactParameters& contact) {
  // The contact as it is stands there twice: what its two times differ by is the noise.
  const auto [as_it_is, again, without_friction, without_bounce] =
      time_contacts<4>(law, hits, {contact, contact, {0.0, contact.restitution}, {contact.friction, 0.0}});
  const double with = std::min(as_it_is, again);
  const double noise = std::abs(as_it_is - again);
  const auto beyond_noise = [&](double difference) { return difference > noise ? difference : 0.0; };
  return {beyond_noise(with - without_friction), beyond_noise(with - without_bounce)};
}

}  // namespace

ImpulseCost time_impulses(const World& world, const ContactParameters& contact, Against what) {
  if (world.rods.empty()) return {};
  const std::vector<Hit> hits = hits_on(world, what);
  return time_law(impulse_function(world.scene.law), hits, contact);
}

}  // namespace shaken::run
