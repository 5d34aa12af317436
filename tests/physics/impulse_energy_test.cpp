// SPDX-License-Identifier: MIT
// Energy in ten million impacts by each impulse law.
#include <gtest/gtest.h>

#include <algorithm>

#include "sim/contact/impulse_law.h"
#include "tests/support/random_impacts.h"

namespace shaken {
namespace {

struct Gains {
  double most = -1;  ///< largest change of energy, as a fraction of the energies exchanged
  int n = 0;         ///< impacts that made energy beyond rounding
};

constexpr double kRounding = 1e-14;

void look(ImpulseFunction law, const test::ImpactInput& impact, const ContactParameters& contact, Gains& gains) {
  const Vec3 P = law(impact.K, impact.normal, impact.u, contact);
  const double change = test::relative_energy_change(impact, P);
  gains.most = std::max(gains.most, change);
  gains.n += change > kRounding;
}

TEST(ImpulseEnergy, TenMillionImpactsOfRods) {
  test::RodImpacts impacts(77);
  const double frictions[] = {0, 0.05, 1, 1000};
  const double restitutions[] = {0, 0.05, 0.3, 1};
  Gains newton, newton_of_paper, poisson, energetic;
  for (int trial = 0; trial < 10'000'000; ++trial) {
    const test::ImpactInput impact = impacts.next();
    const ContactParameters contact{frictions[trial % 4], restitutions[trial / 4 % 4]};
    look(&energetic_impulse, impact, contact, energetic);
    if (trial % 11 != 0) continue;
    look(&poisson_impulse, impact, contact, poisson);
    look(&newton_coulomb_impulse, impact, contact, newton);
    if (contact.friction <= 0.05 && contact.restitution <= 0.3)
      look(&newton_coulomb_impulse, impact, contact, newton_of_paper);
  }
  EXPECT_EQ(energetic.n, 0) << energetic.most;
  // measured, not guaranteed
  EXPECT_EQ(poisson.n, 0) << poisson.most;
  EXPECT_EQ(newton_of_paper.n, 0) << newton_of_paper.most;
  // what this test would show of a law that makes energy
  EXPECT_GT(newton.n, 10'000);
  EXPECT_GT(newton.most, 0.1);
}

}  // namespace
}  // namespace shaken
