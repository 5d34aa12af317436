#include "sim/schedule/skin_budget.h"

#include <gtest/gtest.h>

#include <array>

#include "sim/motion/flight.h"

namespace shaken {
namespace {

/// A rod that creeps along and is visited at each of many ticks, by a path so short per tick that it is less than half
/// of the last bit of what remains: at no time may more remain than the list says when it is asked.
void creep(double speed, bool rests) {
  constexpr double kDt = 4e-6;
  constexpr double kBox = 30;
  const std::array species{make_species({})};
  const std::array<std::uint8_t, 1> kinds{0};
  NeighborList list(species, kinds, kBox, NeighborList::kSkin);
  Flight flight;
  flight.position = {15, 15, 0.5};
  flight.velocity = {speed, 0, 0};
  flight.director = {0, 1, 0};
  flight.prepare();
  const std::array poses{Pose{flight.position, flight.director}};
  list.build(poses);
  SkinBudget reserve;
  reserve.measure(list, 0, poses[0], 0);
  const double half_length = species[0].half_length;
  for (Tick now = 1; now <= 3'000'000; ++now) {
    const Vec3 place = flight.position + static_cast<double>(now) * kDt * flight.velocity;
    if (rests) {
      reserve.cover_tick(flight, {kDt, 0, half_length}, now);
    } else {
      reserve.covered_ticks(list, 0, flight, {place, flight.director}, {kDt, 0, half_length}, now, 4000);
    }
    if (now % 1000 != 0) continue;
    ASSERT_LE(static_cast<double>(reserve.remaining(now, kDt)), list.slack(0, {place, flight.director}))
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
  constexpr double kDt = 4e-6;
  const std::array species{make_species({})};
  const std::array<std::uint8_t, 1> kinds{0};
  const double half_length = species[0].half_length;
  for (const double speed : {0.0, 5.0, -3.0}) {
    NeighborList list(species, kinds, 30, NeighborList::kSkin);
    Gravity gravity(9810);
    gravity.is_inclined = true;
    gravity.along = Vec2(600, 0);
    Flight flight;
    flight.position = {15, 15, 0.5};
    flight.velocity = {speed, 0, 0};
    flight.director = {0, 1, 0};
    flight.prepare();
    const std::array poses{Pose{flight.position, flight.director}};
    list.build(poses);
    SkinBudget reserve;
    reserve.measure(list, 0, poses[0], 0);
    int n_looked = 0;
    for (Tick now = 1; reserve.remaining(now, kDt) > SkinBudget::kLeast && n_looked < 10000; ++n_looked) {
      const auto pose_at = [&](Tick k) { return pose_after(flight, static_cast<double>(k) * kDt, gravity); };
      const Tick covered = reserve.covered_ticks(list, 0, flight, pose_at(now), {kDt, 600, half_length}, now, 4000);
      for (const Tick k : {now, now + covered / 2, now + covered, now + covered + 1}) {
        const double slack = list.slack(0, pose_at(k));
        ASSERT_LE(static_cast<double>(reserve.remaining(k, kDt)), slack) << speed << " mm/s, tick " << k;
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
