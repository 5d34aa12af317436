// SPDX-License-Identifier: MIT
#include "sim/stepping/gap_allowances.h"

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

/// What one pair's allowance is, in so many words.
struct Allowance {
  int lane = -1;
  bool is_forbidden = true;
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

  MotionChange change() const { return {velocity, precession, director, rate_before, rate, half_length, earlier}; }
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
  double bending() const { return 0.5 * half_length * std::max(0.0, rate * rate - rate_before * rate_before); }
};

TEST(GapAllowances, AreTakenFromAsEachPairByItselfWouldBe) {
  test::Draw draw(81);
  test::AnyWidth width;
  int n_taken = 0, n_used_up = 0, most = 0;
  for (int trial = 0; trial < test::draws(2000); ++trial) {
    width.draw(draw);
    GapAllowances allowances(2, kDt);
    std::map<int, Allowance> expected;  // of rod 1, by pair
    Tick now = (Tick{1} << 31) - 500;   // a tick's last 32 bits come round on the way
    for (int step = 0, pair = 0; step < 120; ++step) {
      const int what = draw.integer(0, 9);
      if (what < 3) {
        expected[pair].lane = allowances.add(1, pair);
        ++pair;
      } else if (what == 3 && !expected.empty()) {
        const auto gone = std::next(expected.begin(), draw.integer(0, static_cast<int>(expected.size()) - 1));
        const int lane = gone->second.lane;
        expected.erase(gone);
        const int moved = allowances.remove(1, lane);
        if (moved >= 0) expected.at(moved).lane = lane;
      } else if (what < 7) {
        for (auto& [of, allowance] : expected) {
          if (draw.integer(0, 2)) continue;
          allowance.direction = draw.integer(0, 3) ? draw.direction() : Vec3::Zero();
          allowance.left = std::pow(10.0, draw.uniform(-5, -1));
          allowance.faster = allowance.left_margin = allowance.faster_margin = 0;
          allowance.until = now + draw.integer(1, 1000);
          allowance.is_forbidden = false;
          Direction direction;
          for (std::size_t c = 0; c < 3; ++c)
            direction[c] = -static_cast<float>(allowance.direction[static_cast<Eigen::Index>(c)]);
          allowances.set_direction(1, allowance.lane, direction, -1);
          allowances.allow(1, allowance.lane, static_cast<float>(allowance.left), allowance.until);
        }
      } else {
        const Change change(draw);
        std::set<int> used_up;
        allowances.take(1, change.change(), now, [&](int of) { EXPECT_TRUE(used_up.insert(of).second); });
        for (auto& [of, allowance] : expected) {
          if (allowance.is_forbidden) {
            EXPECT_TRUE(used_up.count(of));
            continue;
          }
          const auto rest = static_cast<double>(allowance.until - now) * kDt;
          const double faster =
              change.closing(allowance.direction) + change.bending() * (rest + kBeyond + change.earlier);
          allowance.left -= faster * rest + std::max(0.0, faster) * change.earlier;
          allowance.faster += faster;
          const double margin = change.margin() + 1e-5 * std::abs(faster);
          allowance.left_margin += margin * (std::max(0.0, rest) + change.earlier) + 1e-5 * std::abs(allowance.left);
          allowance.faster_margin += margin;
          const bool must_be_told = rest <= 0 || change.earlier > 0 || allowance.left < 0;
          const bool is_told = used_up.count(of) != 0;
          EXPECT_TRUE(is_told || !must_be_told) << allowance.left;
          EXPECT_TRUE(!is_told || must_be_told || allowance.left < allowance.left_margin) << allowance.left;
          if (rest > 0) {
            const double too_little = allowance.left - static_cast<double>(allowances.left(1, allowance.lane));
            EXPECT_GE(too_little, -1e-7 * (1 + std::abs(allowance.left)));
            EXPECT_LE(too_little, allowance.left_margin);
            const double too_fast = static_cast<double>(allowances.faster(1, allowance.lane)) - allowance.faster;
            EXPECT_GE(too_fast, 0);
            EXPECT_LE(too_fast, allowance.faster_margin);
          }
          allowance.is_forbidden = is_told;
          if (allowance.is_forbidden) allowances.forbid(1, allowance.lane);
          n_used_up += is_told;
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

TEST(GapAllowances, OfWhatIsAllowedAllNoHitTakesAnything) {
  GapAllowances allowances(1, kDt);
  allowances.allow_all(0, allowances.add(0, 7));
  const MotionChange hard({1e5, 0, 0}, Vec3::Zero(), Vec3::UnitY(), 0, 0, 1, 0);
  for (const Tick start : {Tick{0}, Tick{3} << 30}) {
    for (int k = 0; k < 1000; ++k)
      allowances.take(0, hard, start + k, [](int) { FAIL() << "there is nothing to tell"; });
  }
}

TEST(GapAllowances, OfWhatIsForbiddenEveryHitTakesTooMuch) {
  GapAllowances allowances(1, kDt);
  allowances.forbid(0, allowances.add(0, 7));
  const MotionChange opens({-1e3, 0, 0}, Vec3::Zero(), Vec3::UnitY(), 0, 0, 1, 0);
  for (const Tick start : {Tick{0}, Tick{3} << 30}) {
    for (int k = 0; k < 1000; ++k) {
      bool is_told = false;
      allowances.take(0, opens, start + k, [&](int) { is_told = true; });
      EXPECT_TRUE(is_told);
    }
  }
}

TEST(GapAllowances, NobodyIsToldOfLanesThatAreGone) {
  GapAllowances allowances(1, kDt);
  for (int pair = 0; pair < 3; ++pair) {
    const int lane = allowances.add(0, pair);
    allowances.allow(0, lane, 1e-3F, 1000);
  }
  EXPECT_EQ(allowances.remove(0, 2), -1);
  for (int k = 0; k < 1000; ++k) {
    std::set<int> told;
    allowances.take(0, MotionChange::unknown(), k, [&](int pair) { told.insert(pair); });
    EXPECT_EQ(told, (std::set<int>{0, 1})) << k;
  }
}

}  // namespace
}  // namespace shaken
