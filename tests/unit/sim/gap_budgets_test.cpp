// SPDX-License-Identifier: MIT
#include "sim/schedule/gap_budgets.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

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
  double left = 0, faster = 0;
  double left_margin = 0, faster_margin = 0;  ///< that may have been taken besides, for rounding
  Tick until = 0;
};

/// A change of a rod's motion, and what it is made of.
struct Change {
  Vec3 velocity, precession, director;
  double rate_before, rate, half_length, earlier;

  explicit Change(test::Draw& draw)
      : velocity(draw.vector(std::pow(10.0, draw.uniform(-3, 2)))),
        precession(draw.vector(std::pow(10.0, draw.uniform(-3, 2)))),
        director(draw.direction()),
        rate_before(draw.uniform(0, 100)),
        rate(draw.uniform(0, 100)),
        half_length(draw.uniform(0, 2.5)),
        earlier(draw.integer(0, 3) == 0 ? kDt : 0.0) {}

  VelocityJump change() const { return {velocity, precession, director, rate_before, rate, half_length, earlier}; }
  /// By how much faster the gap in this direction closes, without any margin [mm/s].
  double closing(const Vec3& direction) const {
    const Vec3 tip = half_length * precession.cross(director);
    if (direction.isZero()) return velocity.norm() + std::max(tip.norm(), half_length * (rate - rate_before));
    return velocity.dot(direction) + std::abs(tip.dot(direction));
  }
  /// What may be added to that, for rounding and because a rod that was displaced had another director [mm/s].
  double margin() const {
    const double size = velocity.norm() + half_length * precession.norm();
    return 2e-4 + 1e-5 * size + half_length * precession.norm() * std::max(rate, rate_before) * earlier;
  }
  double curvature() const { return 0.5 * half_length * std::max(0.0, rate * rate - rate_before * rate_before); }
};

TEST(GapBudgets, AreTakenFromAsEachPairByItselfWouldBe) {
  test::Draw draw(81);
  test::AnyWidth width;
  int n_taken = 0, n_used_up = 0, most = 0;
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
          budget.left = std::pow(10.0, draw.uniform(-5, -1));
          budget.faster = budget.left_margin = budget.faster_margin = 0;
          budget.until = now + draw.integer(1, 1000);
          budget.is_empty = false;
          Direction direction;
          for (std::size_t c = 0; c < 3; ++c)
            direction[c] = -static_cast<float>(budget.direction[static_cast<Eigen::Index>(c)]);
          budgets.set_direction(1, budget.lane, direction, -1);
          budgets.set(1, budget.lane, static_cast<float>(budget.left), budget.until);
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
          const auto rest = static_cast<double>(budget.until - now) * kDt;
          const double faster =
              change.closing(budget.direction) + change.curvature() * (rest + kBeyond + change.earlier);
          budget.left -= faster * rest + std::max(0.0, faster) * change.earlier;
          budget.faster += faster;
          const double margin = change.margin() + 1e-5 * std::abs(faster);
          budget.left_margin += margin * (std::max(0.0, rest) + change.earlier) + 1e-5 * std::abs(budget.left);
          budget.faster_margin += margin;
          const bool must_be_called = rest <= 0 || change.earlier > 0 || budget.left < 0;
          const bool is_called = used_up.count(of) != 0;
          EXPECT_TRUE(is_called || !must_be_called) << budget.left;
          EXPECT_TRUE(!is_called || must_be_called || budget.left < budget.left_margin) << budget.left;
          if (rest > 0) {
            const double too_little = budget.left - static_cast<double>(budgets.left(1, budget.lane));
            EXPECT_GE(too_little, -1e-7 * (1 + std::abs(budget.left)));
            EXPECT_LE(too_little, budget.left_margin);
            const double too_fast = static_cast<double>(budgets.added_rate(1, budget.lane)) - budget.faster;
            EXPECT_GE(too_fast, 0);
            EXPECT_LE(too_fast, budget.faster_margin);
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
  EXPECT_GT(most, 16);
}

TEST(GapBudgets, OfWhatIsAllowedAllNoHitTakesAnything) {
  GapBudgets budgets(1, kDt);
  budgets.set_unlimited(0, budgets.add(0, 7));
  const VelocityJump hard({1e5, 0, 0}, Vec3::Zero(), Vec3::UnitY(), 0, 0, 1, 0);
  for (const Tick start : {Tick{0}, Tick{3} << 30}) {
    for (int k = 0; k < 1000; ++k) budgets.spend(0, hard, start + k, [](int) { FAIL() << "there is nothing to tell"; });
  }
}

TEST(GapBudgets, OfWhatIsForbiddenEveryHitTakesTooMuch) {
  GapBudgets budgets(1, kDt);
  budgets.set_empty(0, budgets.add(0, 7));
  const VelocityJump opens({-1e3, 0, 0}, Vec3::Zero(), Vec3::UnitY(), 0, 0, 1, 0);
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
    budgets.set(0, lane, 1e-3F, 1000);
  }
  EXPECT_EQ(budgets.remove(0, 2), -1);
  for (int k = 0; k < 1000; ++k) {
    std::set<int> told;
    budgets.spend(0, VelocityJump::unknown(), k, [&](int pair) { told.insert(pair); });
    EXPECT_EQ(told, (std::set<int>{0, 1})) << k;
  }
}

}  // namespace
}  // namespace shaken
