#include "sim/contact/impact_process.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "sim/contact/impact_process_lanes.h"
#include "sim/contact/impulse_law.h"
#include "tests/support/any_width.h"
#include "tests/support/effort.h"
#include "tests/support/random_impacts.h"
#include "tests/support/random_rods.h"

namespace shaken {
namespace {

using test::ImpactInput;

Vec3 energetic_impulse(const ImpactInput& i, const ContactParameters& c) {
  return energetic_impulse(i.K, i.normal, i.u, c);
}
Vec3 poisson_impulse(const ImpactInput& i, const ContactParameters& c) {
  return poisson_impulse(i.K, i.normal, i.u, c);
}
Vec3 newton_impulse(const ImpactInput& i, const ContactParameters& c) {
  return newton_coulomb_impulse(i.K, i.normal, i.u, c);
}
Vec3 energetic_impulse(const ImpactInput& i, const ContactParameters& c, double turn) {
  ImpactProcess process(i.K, i.normal, i.u, c.friction, turn);
  process.compress();
  process.restore_work(-c.restitution * c.restitution * process.normal_work());
  return process.impulse();
}

// ---- closed forms

TEST(ImpactProcess, WithoutFrictionItIsNewtonsToTheBit) {
  test::RodImpacts impacts(1);
  for (int trial = 0; trial < 1000; ++trial) {
    const ImpactInput impact = impacts.next();
    for (const double e : {0.0, 0.3, 1.0}) {
      EXPECT_EQ(poisson_impulse(impact, {0, e}), newton_impulse(impact, {0, e}));
      EXPECT_EQ(energetic_impulse(impact, {0, e}), newton_impulse(impact, {0, e}));
    }
  }
}

TEST(ImpactProcess, CentralImpactsAreNewtons) {
  test::Draw draw(2);
  for (int trial = 0; trial < 10000; ++trial) {
    ImpactInput impact;
    impact.normal = draw.direction();
    const double normal = draw.uniform(0.1, 2), across = draw.uniform(0.1, 2);
    impact.K = across * Mat3::Identity() + (normal - across) * impact.normal * impact.normal.transpose();
    impact.u = draw.vector(1);
    if (impact.u.dot(impact.normal) > 0) impact.u = -impact.u;
    const ContactParameters contact{draw.uniform(0, 2), draw.uniform(0, 1)};
    const Vec3 newton = newton_impulse(impact, contact);
    EXPECT_LT((poisson_impulse(impact, contact) - newton).norm(), 1e-12 * newton.norm());
    EXPECT_LT((energetic_impulse(impact, contact) - newton).norm(), 1e-12 * newton.norm());
  }
}

/// Routh's graphical method for a planar impact, worked out leg by leg in one tangential direction: in each leg slip is
/// of one sign or absent, and everything is linear in p.
struct PlanarImpact {
  double nn, nt, tt, mu, e;
  double u_n, u_t, p = 0, p_t = 0, work = 0;
  bool slipped_back = false;

  double friction() const {  // per normal impulse
    const double hold = -nt / tt;
    if (u_t > 0) return -mu;
    if (u_t < 0) return mu;
    return std::abs(hold) <= mu ? hold : std::copysign(mu, hold);
  }
  template <class Left>
  void run(const Left& left) {
    const double sign = u_t;
    for (int leg = 0; leg < 3; ++leg) {
      const double q = friction();
      const double rate_t = nt + tt * q;
      const double rate_n = nn + nt * q;
      const double to_stop = u_t * rate_t < 0 ? -u_t / rate_t : INFINITY;
      const double to_end = left(rate_n);
      const double x = std::min(to_stop, to_end);
      work += u_n * x + 0.5 * rate_n * x * x;
      u_n += rate_n * x;
      u_t = to_stop <= to_end || u_t == 0 ? 0.0 : u_t + rate_t * x;
      if (to_stop == INFINITY && rate_t * sign < -1e-12) slipped_back = true;
      p += x;
      p_t += q * x;
      if (to_end <= to_stop) return;
    }
  }
  void compress() {
    run([this](double rate) { return rate > 0 ? -u_n / rate : INFINITY; });
    u_n = 0;
  }
  void poisson() {
    compress();
    const double end = (1 + e) * p;
    run([this, end](double) { return end - p; });
  }
  void energetic() {
    compress();
    const double end = (1 - e * e) * work;
    run([this, end](double rate) { return (std::sqrt(u_n * u_n + 2 * rate * (end - work)) - u_n) / rate; });
  }
};

TEST(ImpactProcess, PlanarImpactsAreRouths) {
  test::Draw draw(3);
  int n_stuck = 0, n_slid = 0, n_back = 0;
  for (int trial = 0; trial < 20000; ++trial) {
    PlanarImpact planar{draw.uniform(0.5, 2), 0, draw.uniform(0.5, 2), draw.uniform(0.01, 2), draw.uniform(0, 1), 0, 0};
    planar.nt = draw.uniform(-0.95, 0.95) * std::sqrt(planar.nn * planar.tt);
    planar.u_n = -draw.uniform(0.1, 1);
    planar.u_t = draw.normal() * (draw.integer(0, 1) == 1 ? 1.0 : 0.1);
    // the plane of the impact, turned at random; what is out of it does not take part
    ImpactInput impact;
    const Vec3 t = draw.direction();
    const Vec3 aside = t.cross(draw.direction()).normalized();
    impact.normal = aside.cross(t);
    impact.K = planar.nn * impact.normal * impact.normal.transpose() + planar.tt * t * t.transpose() +
               planar.nt * (impact.normal * t.transpose() + t * impact.normal.transpose()) +
               draw.uniform(0.5, 2) * aside * aside.transpose();
    impact.u = planar.u_n * impact.normal + planar.u_t * t;
    const ContactParameters contact{planar.mu, planar.e};

    PlanarImpact poisson = planar, energetic = planar;
    poisson.poisson();
    energetic.energetic();
    const Vec3 P = poisson.p * impact.normal + poisson.p_t * t;
    const Vec3 E = energetic.p * impact.normal + energetic.p_t * t;
    EXPECT_LT((poisson_impulse(impact, contact) - P).norm(), 1e-7 * P.norm());
    EXPECT_LT((energetic_impulse(impact, contact) - E).norm(), 1e-7 * E.norm());
    if (energetic.slipped_back) {
      ++n_back;
    } else if (energetic.u_t == 0) {
      ++n_stuck;
    } else {
      ++n_slid;
    }
  }
  EXPECT_GT(n_stuck, 1000);
  EXPECT_GT(n_slid, 1000);
  EXPECT_GT(n_back, 100);
}

// ---- against a slow twin, in three dimensions

/// The impact process in tiny equal steps of p and long doubles: the friction of each step is what leaves least slip
/// within the cone (implicit Euler), found by bisection. The last step of each phase is cut.
class SlowTwin {
 public:
  SlowTwin(const ImpactInput& impact, double mu, int n_steps) : mu_(mu) {
    n_ = impact.normal;
    t1_ = n_.cross(std::abs(n_.x()) < 0.5 ? Vec3::UnitX() : Vec3::UnitY()).normalized();
    t2_ = n_.cross(t1_);
    const Mat3& K = impact.K;
    nn_ = n_.dot(K * n_), n1_ = n_.dot(K * t1_), n2_ = n_.dot(K * t2_);
    t11_ = t1_.dot(K * t1_), t12_ = t1_.dot(K * t2_), t22_ = t2_.dot(K * t2_);
    u_n_ = n_.dot(impact.u), u_1_ = t1_.dot(impact.u), u_2_ = t2_.dot(impact.u);
    step_ = -u_n_ / nn_ / n_steps;
  }
  Vec3 energetic(double e) {
    run([this](Real rate) { return rate > 0 ? -u_n_ / rate : Real(INFINITY); });
    u_n_ = 0;
    if (e > 0) {
      const Real end = (1 - e * e) * work_;
      run([this, end](Real rate) {
        const Real square = u_n_ * u_n_ + 2 * rate * (end - work_);
        return square < 0 ? -u_n_ / rate : 2 * (end - work_) / (u_n_ + std::sqrt(square));
      });
    }
    return static_cast<double>(p_) * n_ + static_cast<double>(p_1_) * t1_ + static_cast<double>(p_2_) * t2_;
  }

 private:
  using Real = long double;
  template <class Left>
  void run(const Left& left) {
    for (;;) {
      // least slip: (lambda + tt h) q = -(u_t + nt h), |q| <= mu
      const Real b1 = u_1_ + n1_ * step_, b2 = u_2_ + n2_ * step_;
      Real q1 = 0, q2 = 0;
      const auto solve = [&](Real lambda) {
        const Real a = t11_ * step_ + lambda, d = t22_ * step_ + lambda, c = t12_ * step_;
        const Real det = a * d - c * c;
        q1 = -(d * b1 - c * b2) / det, q2 = -(a * b2 - c * b1) / det;
        return q1 * q1 + q2 * q2 <= mu_ * mu_;
      };
      if (!solve(0)) {
        Real low = 0, high = std::sqrt(b1 * b1 + b2 * b2) / mu_;
        for (int k = 0; k < 45; ++k) (solve(0.5L * (low + high)) ? high : low) = 0.5L * (low + high);
      }
      const Real rate = nn_ + n1_ * q1 + n2_ * q2;
      const Real to_end = left(rate);
      const Real h = std::min(step_, to_end);
      work_ += (u_n_ + 0.5L * rate * h) * h;
      u_n_ += rate * h;
      u_1_ += (n1_ + t11_ * q1 + t12_ * q2) * h, u_2_ += (n2_ + t12_ * q1 + t22_ * q2) * h;
      p_ += h, p_1_ += q1 * h, p_2_ += q2 * h;
      if (to_end <= step_) return;
    }
  }
  Vec3 n_, t1_, t2_;
  Real mu_, nn_, n1_, n2_, t11_, t12_, t22_, u_n_, u_1_, u_2_, step_, p_ = 0, p_1_ = 0, p_2_ = 0, work_ = 0;
};

TEST(ImpactProcess, AgreesWithTheSlowTwin) {
  test::RodImpacts impacts(4);
  for (int trial = 0; trial < 60; ++trial) {
    const ImpactInput impact = impacts.next();
    for (const double mu : {0.05, 0.5, 5.0}) {
      const Vec3 slow = SlowTwin(impact, mu, 3000).energetic(0.5);
      EXPECT_LT((energetic_impulse(impact, {mu, 0.5}, 0.005) - slow).norm(), 2e-3 * slow.norm()) << mu;
      EXPECT_LT((energetic_impulse(impact, {mu, 0.5}) - slow).norm(), 0.05 * slow.norm()) << mu;
    }
  }
}

TEST(ImpactProcess, ConvergesWithShorterLegs) {
  for (const double mu : {0.05, 1.0}) {
    double mean[3] = {}, worst[3] = {};
    constexpr int kTrials = 2000;
    test::RodImpacts impacts(5);
    for (int trial = 0; trial < kTrials; ++trial) {
      const ImpactInput impact = impacts.next();
      const Vec3 fine = energetic_impulse(impact, {mu, 0.5}, 0.005);
      for (int k = 0; k < 3; ++k) {
        const double turn = ImpactProcess::kTurn / (1 << k);
        const double error = (energetic_impulse(impact, {mu, 0.5}, turn) - fine).norm() / fine.norm();
        mean[k] += error / kTrials;
        worst[k] = std::max(worst[k], error);
      }
    }
    // as the docstring of kTurn says
    EXPECT_LT(mean[0], 2e-3) << mu;
    EXPECT_LT(worst[0], mu > 0.1 ? 0.06 : 1e-3) << mu;
    for (int k = 0; k < 2; ++k) EXPECT_LT(mean[k + 1], 0.5 * mean[k]) << mu;
    EXPECT_LT(mean[2], 0.25 * mean[0]) << mu;
  }
}

// ---- what must hold for any impact

TEST(ImpactProcess, LawsHoldForAMillionImpactsOfRods) {
  test::RodImpacts impacts(6);
  const double frictions[] = {0, 0.05, 1, 1000};
  const double restitutions[] = {0, 0.05, 0.3, 1};
  double most_energetic = -1, most_poisson = -1, most_newton = -1, most_newton_of_paper = -1;
  int most_legs = 0;
  for (int trial = 0; trial < test::draws(1'000'000); ++trial) {
    const ImpactInput impact = impacts.next();
    const double mu = frictions[trial % 4];
    const double e = restitutions[trial / 4 % 4];
    const Vec3 P = energetic_impulse(impact, {mu, e});
    most_energetic = std::max(most_energetic, test::relative_energy_change(impact, P));
    most_poisson = std::max(most_poisson, test::relative_energy_change(impact, poisson_impulse(impact, {mu, e})));
    const double newton = test::relative_energy_change(impact, newton_impulse(impact, {mu, e}));
    most_newton = std::max(most_newton, newton);
    if (mu <= 0.05 && e <= 0.3) most_newton_of_paper = std::max(most_newton_of_paper, newton);
    // it pushes, within the cone, and afterwards the bodies do not approach
    const double P_n = P.dot(impact.normal);
    ASSERT_GT(P_n, 0);
    ASSERT_LE((P - P_n * impact.normal).norm(), mu * P_n * (1 + 1e-9) + 1e-12 * P_n);
    ASSERT_GE((impact.u + impact.K * P).dot(impact.normal), -1e-9 * impact.u.norm());
    if (mu > 0 && trial % 16 < 4) {
      ImpactProcess process(impact.K, impact.normal, impact.u, mu);
      process.compress();
      most_legs = std::max(most_legs, process.n_legs());
    }
  }
  EXPECT_LT(most_energetic, 1e-14);
  EXPECT_LT(most_poisson, 1e-14);          // measured, not guaranteed
  EXPECT_LT(most_newton_of_paper, 1e-14);  // measured, not guaranteed
  EXPECT_GT(most_newton, 0.1) << "what this test shows of a law that makes energy";
  EXPECT_LT(most_legs, 60);
}

TEST(ImpactProcess, EnergeticLawNeverMakesEnergyWhateverTheCompliance) {
  test::RodImpacts impacts(7);
  double most = -1;
  for (int trial = 0; trial < test::draws(200'000); ++trial) {
    const ImpactInput impact = impacts.next_of_any_compliance(trial % 5);
    const double mu = std::pow(10.0, trial % 7 - 3), e = 0.25 * (trial % 5);
    const Vec3 P = energetic_impulse(impact, {mu, e});
    ASSERT_TRUE(P.allFinite());
    most = std::max(most, test::relative_energy_change(impact, P));
  }
  EXPECT_LT(most, 1e-12);
}

/// The end of a slender rod at 45 degrees hits a rough plate: m = 1, length 2, I = 1/3 (after Kane & Levinson 1985).
/// It slides a little to begin with; friction brings it to a stop and holds it.
TEST(ImpactProcess, NewtonsRuleMakesEnergyWhereSlipStopsAndTheOthersDoNot) {
  const Vec3 arm = Vec3(std::sqrt(0.5), 0, -std::sqrt(0.5));
  const Vec3 lever = Vec3::UnitY().cross(arm);
  ImpactInput impact;
  impact.K = Mat3::Identity() + 3.0 * lever * lever.transpose();
  impact.normal = Vec3::UnitZ();
  int n_newton = 0;
  for (const double slip : {-0.2, -0.1, -0.05, 0.05, 0.1, 0.2}) {
    impact.u = Vec3(slip, 0, -1);
    for (const double mu : {0.8, 1.0, 1000.0}) {
      const ContactParameters contact{mu, 1.0};
      n_newton += test::energy_change(impact, newton_impulse(impact, contact)) > 0.01;
      EXPECT_LT(test::energy_change(impact, energetic_impulse(impact, contact)), 1e-14);
      EXPECT_LT(test::energy_change(impact, poisson_impulse(impact, contact)), 1e-14);
    }
  }
  EXPECT_EQ(n_newton, 9);  // slip to one side, at each friction
}

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
