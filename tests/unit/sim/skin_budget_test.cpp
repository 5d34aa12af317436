// SPDX-License-Identifier: MIT
#include "sim/schedule/skin_budget.h"

#include <gtest/gtest.h>

#include <array>

namespace shaken {
namespace {

/// A rod that creeps along and is visited at each of many ticks, by a path so short per tick that it is less than half
/// of the last bit of what is left: at no time may more be left than the list says when it is asked.
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
      reserve.cover_tick(flight, half_length, now, kDt);
    } else {
      reserve.covered_ticks(list, 0, flight, {place, flight.director}, half_length, now, kDt, 4000);
    }
    if (now % 1000 != 0) continue;
    ASSERT_LE(static_cast<double>(reserve.left(now, kDt)), list.slack(0, {place, flight.director}))
        << speed << " mm/s, tick " << now;
  }
}

TEST(SkinBudget, CountsDownWhatARodCreeps) {
  for (const double speed : {1e-4, 3e-4, 1e-3, 1e-2}) {
    creep(speed, false);
    creep(speed, true);
  }
}

}  // namespace
}  // namespace shaken
