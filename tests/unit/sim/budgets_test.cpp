#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>
#include <set>

#include "sim/motion/flight.h"
#include "sim/schedule/gap_budgets.h"
#include "sim/schedule/skin_budget.h"
#include "tests/support/any_width.h"
#include "tests/support/effort.h"

namespace shaken {
namespace {

constexpr double kDt = 4e-6;
constexpr double kBeyond = 64 * kDt;  ///< for which a bound may last longer

/// What one pair's budget is, in so many words.
struct Allowance {
  int lane = -1;
  bool is_empty = true;
  Vec3 direction = Vec3::Zero();
  double gap = 0, rate = 0;
  double gap_margin = 0, rate_margin = 0;  ///< that may have been taken besides, for rounding
  Tick until = 0;
};

/// A change of a rod's motion, perhaps of its pose as well, and what it is made of.
struct Change {
  Vec3 velocity, turning, position, director;
  double rate_before, rate, half_length;
  bool displaces;

  explicit Change(test::Draw& draw)
      : velocity(draw.vector(std::pow(10.0, draw.uniform(-3, 2)))),
        turning(draw.vector(std::pow(10.0, draw.uniform(-3, 2)))),
        position(draw.vector(std::pow(10.0, draw.uniform(-7, -2)))),
        director(draw.vector(std::pow(10.0, draw.uniform(-7, -2)))),
        rate_before(draw.uniform(0, 100)),
        rate(draw.uniform(0, 100)),
        half_length(draw.uniform(0, 2.5)),
        displaces(draw.integer(0, 3) == 0) {}

  VelocityJump change() const {
    VelocityJump jump(velocity, turning, rate_before, rate, half_length);
    if (displaces) jump.displace(position, director, half_length);
    return jump;
  }
  /// By how much faster the gap in this direction closes, without any margin [mm/s].
  double closing(const Vec3& direction) const {
    if (direction.isZero()) return velocity.norm() + half_length * std::max(turning.norm(), rate - rate_before);
    return velocity.dot(direction) + half_length * std::abs(turning.dot(direction));
  }
  /// By how much less the gap is at once, without any margin [mm].
  double shift(const Vec3& direction) const {
    if (!displaces) return 0;
    if (direction.isZero()) return position.norm() + half_length * director.norm();
    return position.dot(direction) + half_length * std::abs(director.dot(direction));
  }
  /// What may be added to that, for rounding [mm/s, mm].
  double margin() const { return 2e-4 + 1e-5 * (velocity.norm() + half_length * turning.norm()); }
  double shift_margin() const { return displaces ? 1e-5 * (position.norm() + half_length * director.norm()) : 0; }
  double curvature() const { return 0.5 * half_length * std::max(0.0, rate * rate - rate_before * rate_before); }
};

TEST(GapBudgets, AreTakenFromAsEachPairByItselfWouldBe) {
  test::Draw draw(81);
  test::AnyWidth width;
  int n_taken = 0, n_used_up = 0, n_shifted = 0, most = 0;
  for (int trial = 0; trial < test::draws(2000); ++trial) {
    width.draw(draw);
    GapBudgets budgets(2, kDt);
    std::map<int, Allowance> expected;  // of rod 1, by pair
    Tick now = (Tick{1} << 31) - 500;   // a tick's last 32 bits come round on the way
    for (int step = 0, pair = 0; step < 120; ++step) {
      const int what = draw.integer(0, 9);
      if (what < 3) {
        expected[pair].lane = budgets.add(1, pair);
        ++pair;
      } else if (what == 3 && !expected.empty()) {
        const auto gone = std::next(expected.begin(), draw.integer(0, static_cast<int>(expected.size()) - 1));
        const int lane = gone->second.lane;
        expected.erase(gone);
        const int moved = budgets.remove(1, lane);
        if (moved >= 0) expected.at(moved).lane = lane;
      } else if (what < 7) {
        for (auto& [of, budget] : expected) {
          if (draw.integer(0, 2)) continue;
          budget.direction = draw.integer(0, 3) ? draw.direction() : Vec3::Zero();
          budget.gap = std::pow(10.0, draw.uniform(-5, -1));
          budget.gap_margin = budget.rate_margin = 0;
          const Tick wait = draw.integer(1, 1000);
          budget.until = now + wait;
          const double most_rate = std::min(1000.0, budget.gap / (static_cast<double>(wait) * kDt));
          budget.rate = static_cast<float>(draw.uniform(-1, 1) * most_rate);
          budget.is_empty = false;
          Direction direction;
          for (std::size_t c = 0; c < 3; ++c)
            direction[c] = -static_cast<float>(budget.direction[static_cast<Eigen::Index>(c)]);
          budgets.set_direction(1, budget.lane, direction, -1);
          budgets.set(1, budget.lane, static_cast<float>(budget.gap), static_cast<float>(budget.rate), budget.until);
        }
      } else {
        const Change change(draw);
        std::set<int> used_up;
        budgets.spend(1, change.change(), now, [&](int of) { EXPECT_TRUE(used_up.insert(of).second); });
        for (auto& [of, budget] : expected) {
          if (budget.is_empty) {
            EXPECT_TRUE(used_up.count(of));
            continue;
          }
          const auto wait = static_cast<double>(budget.until - now) * kDt;
          const double faster = change.closing(budget.direction) + change.curvature() * (wait + kBeyond);
          budget.gap -= faster * wait + change.shift(budget.direction);
          budget.rate += faster;
          const double margin = change.margin() + 1e-5 * std::abs(faster);
          budget.gap_margin += margin * std::max(0.0, wait) + change.shift_margin() + 1e-5 * std::abs(budget.gap);
          budget.rate_margin += margin + 1e-5 * std::abs(budget.rate);
          const double closes = budget.rate * std::max(0.0, wait);
          const double least = change.displaces ? std::min(budget.gap, budget.gap + closes) : budget.gap;
          const double least_margin =
              budget.gap_margin + (change.displaces ? budget.rate_margin * wait + 1e-5 * std::abs(closes) : 0.0);
          const bool is_closed_now =
              change.displaces && budget.gap + closes < -2e-7 * (std::abs(budget.gap) + std::abs(closes));
          const bool must_be_called = wait <= 0 || budget.gap < 0 || is_closed_now;
          const bool is_called = used_up.count(of) != 0;
          EXPECT_TRUE(is_called || !must_be_called) << least;
          EXPECT_TRUE(!is_called || must_be_called || least < least_margin) << least;
          n_shifted += is_called && change.displaces && wait > 0 && budget.gap > budget.gap_margin;
          if (wait > 0) {
            const double too_little = budget.gap - static_cast<double>(budgets.remaining(1, budget.lane));
            EXPECT_GE(too_little, -1e-7 * (1 + std::abs(budget.gap)));
            EXPECT_LE(too_little, budget.gap_margin);
            const double too_fast = static_cast<double>(budgets.rate(1, budget.lane)) - budget.rate;
            EXPECT_GE(too_fast, 0);
            EXPECT_LE(too_fast, budget.rate_margin);
          }
          budget.is_empty = is_called;
          if (budget.is_empty) budgets.set_empty(1, budget.lane);
          n_used_up += is_called;
          ++n_taken;
        }
        for (const int of : used_up) EXPECT_TRUE(expected.count(of));
        now += draw.integer(1, 40);
      }
      most = std::max(most, static_cast<int>(expected.size()));
    }
  }
  EXPECT_GT(n_used_up, n_taken / 20);
  EXPECT_GT(n_taken - n_used_up, n_taken / 20);
  EXPECT_GT(n_shifted, n_taken / 1000);
  EXPECT_GT(most, 16);
}

TEST(GapBudgets, OfWhatIsAllowedAllNoHitTakesAnything) {
  GapBudgets budgets(1, kDt);
  budgets.set_unlimited(0, budgets.add(0, 7));
  const VelocityJump hard({1e5, 0, 0}, Vec3::Zero(), 0, 0, 1);
  for (const Tick start : {Tick{0}, Tick{3} << 30}) {
    for (int k = 0; k < 1000; ++k) budgets.spend(0, hard, start + k, [](int) { FAIL() << "there is nothing to tell"; });
  }
}

TEST(GapBudgets, OfWhatIsForbiddenEveryHitTakesTooMuch) {
  GapBudgets budgets(1, kDt);
  budgets.set_empty(0, budgets.add(0, 7));
  const VelocityJump opens({-1e3, 0, 0}, Vec3::Zero(), 0, 0, 1);
  for (const Tick start : {Tick{0}, Tick{3} << 30}) {
    for (int k = 0; k < 1000; ++k) {
      bool is_called = false;
      budgets.spend(0, opens, start + k, [&](int) { is_called = true; });
      EXPECT_TRUE(is_called);
    }
  }
}

TEST(GapBudgets, NobodyIsToldOfLanesThatAreGone) {
  GapBudgets budgets(1, kDt);
  for (int pair = 0; pair < 3; ++pair) {
    const int lane = budgets.add(0, pair);
    budgets.set(0, lane, 1e-3F, 0, 1000);
  }
  EXPECT_EQ(budgets.remove(0, 2), -1);
  for (int k = 0; k < 1000; ++k) {
    std::set<int> told;
    budgets.spend(0, VelocityJump::unknown(), k, [&](int pair) { told.insert(pair); });
    EXPECT_EQ(told, (std::set<int>{0, 1})) << k;
  }
}

/// A rod along y in the middle of a box, that slides along x, with its list of neighbours and what is left of its skin.
struct SlidingRod {
  std::array<Species, 1> species{make_species({})};
  std::array<std::uint8_t, 1> kinds{0};
  double half_length = species[0].half_length;
  NeighborList list{species, kinds, 30, NeighborList::kSkin};
  Flight flight;
  SkinBudget reserve;

  explicit SlidingRod(double speed) {
    flight.position = {15, 15, 0.5};
    flight.velocity = {speed, 0, 0};
    flight.director = {0, 1, 0};
    flight.prepare();
    const std::array poses{Pose{flight.position, flight.director}};
    list.build(poses);
    reserve.measure(list, 0, poses[0], 0);
  }
};

/// A rod that creeps along and is visited at each of many ticks, by a path so short per tick that it is less than half
/// of the last bit of what remains: at no time may more remain than the list says when it is asked.
void creep(double speed, bool rests) {
  SlidingRod rod(speed);
  for (Tick now = 1; now <= 3'000'000; ++now) {
    const Vec3 place = rod.flight.position + static_cast<double>(now) * kDt * rod.flight.velocity;
    if (rests) {
      rod.reserve.cover_tick(rod.flight, {kDt, 0, rod.half_length}, now);
    } else {
      rod.reserve.covered_ticks(rod.list, 0, rod.flight, {place, rod.flight.director}, {kDt, 0, rod.half_length}, now,
                                4000);
    }
    if (now % 1000 != 0) continue;
    ASSERT_LE(static_cast<double>(rod.reserve.remaining(now, kDt)), rod.list.slack(0, {place, rod.flight.director}))
        << speed << " mm/s, tick " << now;
  }
}

TEST(SkinBudget, CountsDownWhatARodCreeps) {
  for (const double speed : {1e-4, 3e-4, 1e-3, 1e-2}) {
    creep(speed, false);
    creep(speed, true);
  }
}

// On inclined plates a rod becomes faster while it counts down. It is looked at where it has to be, and in between.
TEST(SkinBudget, CountsDownWhatARodSlidesDownASlope) {
  for (const double speed : {0.0, 5.0, -3.0}) {
    SlidingRod rod(speed);
    Gravity gravity(9810);
    gravity.is_inclined = true;
    gravity.along = Vec2(600, 0);
    int n_looked = 0;
    for (Tick now = 1; rod.reserve.remaining(now, kDt) > SkinBudget::kLeast && n_looked < 10000; ++n_looked) {
      const auto pose_at = [&](Tick k) { return pose_after(rod.flight, static_cast<double>(k) * kDt, gravity); };
      const Tick covered =
          rod.reserve.covered_ticks(rod.list, 0, rod.flight, pose_at(now), {kDt, 600, rod.half_length}, now, 4000);
      for (const Tick k : {now, now + covered / 2, now + covered, now + covered + 1}) {
        const double slack = rod.list.slack(0, pose_at(k));
        ASSERT_LE(static_cast<double>(rod.reserve.remaining(k, kDt)), slack) << speed << " mm/s, tick " << k;
        if (k <= now + covered) {
          ASSERT_GE(slack, 0) << speed << " mm/s, tick " << k;
        }
      }
      now += covered + 1;
    }
    EXPECT_GT(n_looked, 0);
    EXPECT_LT(n_looked, 10000);
  }
}

}  // namespace
}  // namespace shaken
