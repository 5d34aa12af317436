#include "sim/contact/impact_process_lanes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "tests/support/any_width.h"
#include "tests/support/effort.h"
#include "tests/support/random_rods.h"

namespace shaken {
namespace {

using lanes::kDoubleLanes;

/// Impacts by one plate on rods of one species.
struct PlateImpactsInLanes {
  bool by_work;
  double side, friction;
  lanes::TripleLanes director, arm, u;
  InverseInertia inverse;
  alignas(64) double restitution[kDoubleLanes];
  mutable lanes::TripleLanes impulse;
  alignas(64) mutable double unknown[kDoubleLanes];

  template <int W>
  SHAKEN_INLINE void run() const {
    for (int l = 0; l < kDoubleLanes; l += W) {
      const auto K = lanes::point_compliance(inverse, director.load<W>(l), arm.load<W>(l));
      const auto found =
          lanes::impulse_of_process(by_work, K, side, u.load<W>(l), friction, lanes::load<W>(restitution + l));
      impulse.store(l, found.P);
      lanes::store(unknown + l, found.unknown);
    }
  }
};

TEST(ImpactProcessLanes, HaveTheBitsOfOneImpactAfterTheOther) {
  test::Draw draw(83);
  test::AnyWidth width;
  const Species species = make_species({.length = 4.5, .n_beads = 15});
  PlateImpactsInLanes impacts{};
  impacts.inverse = inverse_inertia(species);
  enum Way { kAny, kStraight, kSticking, kWays };
  int n_of[kWays]{}, n_known_of[kWays]{};
  for (int trial = 0; trial < test::draws(100000); ++trial) {
    width.draw(draw);
    impacts.by_work = draw.integer(0, 1) == 1;
    impacts.side = draw.integer(0, 1) ? 1.0 : -1.0;
    const ContactParameters contact{std::pow(10.0, draw.uniform(-2.5, 0.5)),
                                    draw.integer(0, 3) ? draw.uniform(0, 1) : 0};
    impacts.friction = contact.friction;
    Mat3 K[kDoubleLanes];
    Vec3 u[kDoubleLanes];
    Way way[kDoubleLanes];
    for (int lane = 0; lane < kDoubleLanes; ++lane) {
      // in any direction, or where slip keeps its own, nearly
      Vec3 director = draw.flat_direction(draw.integer(0, 1) ? 0.2 : 1.0);
      u[lane] = draw.vector(1);
      way[lane] = kAny;
      if (draw.integer(0, 2) == 0) {
        way[lane] = kStraight;
        director = Vec3(director.x(), 0, director.z()).normalized();
        u[lane].y() *= std::pow(10.0, draw.uniform(-6, 0));
      }
      if (draw.integer(0, 5) == 0) {
        way[lane] = kSticking;
        u[lane] *= std::pow(10.0, draw.uniform(-12, 0));  // hardly any slip
      }
      u[lane].z() = -impacts.side * std::pow(10.0, draw.uniform(-3, 2));
      const auto bead = static_cast<std::size_t>(draw.integer(0, species.n_beads() - 1));
      const Vec3 arm = species.bead_offset[bead] * director - species.bead_radius[bead] * impacts.side * Vec3::UnitZ();
      K[lane] = point_compliance(impacts.inverse, director, arm);
      impacts.director.set(lane, director);
      impacts.arm.set(lane, arm);
      impacts.u.set(lane, u[lane]);
      impacts.restitution[lane] = contact.restitution;
    }
    lanes::with_widest_doubles(impacts);
    for (int lane = 0; lane < kDoubleLanes; ++lane) {
      ++n_of[way[lane]];
      if (!(impacts.unknown[lane] < 0)) continue;
      ++n_known_of[way[lane]];
      const Vec3 normal = impacts.side * Vec3::UnitZ();
      const Vec3 expected = impacts.by_work ? energetic_impulse(K[lane], normal, u[lane], contact)
                                            : poisson_impulse(K[lane], normal, u[lane], contact);
      Vec3 found;
      impacts.impulse.get(lane, found);
      ASSERT_EQ(std::memcmp(found.data(), expected.data(), sizeof found), 0)
          << trial << ": " << found.transpose() << " for " << expected.transpose();
    }
  }
  for (const Way one : {kAny, kStraight, kSticking}) {
    EXPECT_GT(n_known_of[one], n_of[one] / 4) << one;
    EXPECT_LT(n_known_of[one], n_of[one]) << one;
  }
}

}  // namespace
}  // namespace shaken
