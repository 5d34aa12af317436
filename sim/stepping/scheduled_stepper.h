// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "sim/contact/safe_time.h"
#include "sim/neighbors/neighbor_list.h"
#include "sim/stepping/stepper.h"
#include "sim/stepping/tick.h"
#include "sim/stepping/timing_wheel.h"

namespace shaken {

/// Visits a rod or a pair only at the ticks at which contact is possible. Whenever one has been looked at, a rigorous
/// bound (contact/safe_time.h, motion/plate_safe_time.h) tells up to when nothing can happen, and a timing wheel
/// brings it back in time. What happens at a visit is tick.h's business, so the trajectory is the reference stepper's,
/// bit by bit.
///
/// When an impulse changes a rod's velocity, the bounds of its pairs are renewed at the end of that tick, from stored
/// records (the separating direction, and what is known of both rods' cosines to it) rather than from new geometry;
/// changes that together stay within an allowance, which every bound provides for, need no renewal.
class ScheduledStepper final : public Stepper {
 public:
  explicit ScheduledStepper(const World& world);
  std::size_t bytes() const override;

 private:
  /// When an item is due, and at which tick the wheel will bring it up (at or before `due`).
  struct Schedule {
    Tick due = 0;
    Tick queued = kNotQueued;
  };
  static constexpr Tick kNotQueued = -1;

  struct AxisRecord {
    double c = 0;
    double rate = 0;
    double half_rate2 = 0;
    Tick at = 0;
  };
  struct PairRecord {
    int rod[2];
    bool touching = false;  ///< beads overlapped, receding, at the last look
    bool by_beads = false;  ///< the last bound was taken bead by bead; the direction is not valid
    Vec3 direction;         ///< from rod 0 to rod 1
    AxisRecord axis[2];
  };

  std::optional<NumericalTrouble> step(World& world, Tick now) override;

  RodAtTick& at_tick(const World& world, int i, Tick now);
  FlightState flight_state(const World& world, int i, Tick now);
  void set_due(TimingWheel& wheel, Schedule& schedule, std::int32_t item, Tick due);
  void take_due(TimingWheel& wheel, std::vector<Schedule>& schedules, Tick now, std::vector<std::int32_t>& due);

  void detect(const World& world, int p, Tick now);
  void detect_touching(const World& world, Tick now);
  void set_touching(PairRecord& pair, bool touching);
  void rebuild_pairs(const World& world, Tick now);
  void schedule_rod(const World& world, int i, Tick now);
  void schedule_pair(int p, Tick now, double safe_time);
  void look_again(const World& world, int p, Tick now);
  void renew(const World& world, int p, int side, Tick now);

  TickRules rules_;
  Hull hull_;
  BeadLanes lanes_;
  Allowance allowance_;
  NeighborList neighbors_;

  std::vector<RodAtTick> rods_;  ///< valid where rod_tick_ is the current tick
  std::vector<Tick> rod_tick_;
  std::vector<Schedule> rod_schedule_;
  std::vector<double> strayed_velocity_;    ///< since the rod's pairs were last renewed [mm/s]
  std::vector<double> strayed_precession_;  ///< [rad/s]
  TimingWheel rod_wheel_;

  std::vector<PairRecord> pairs_;
  std::vector<Schedule> pair_schedule_;
  std::vector<Tick> pair_detected_;  ///< tick of the last search for contacts
  std::vector<Tick> pair_looked_;    ///< tick of the last new bound from new geometry
  TimingWheel pair_wheel_;
  std::vector<int> n_touching_;                ///< (n_rods) pairs of the rod that are touching
  std::vector<int> first_pair_of_;             ///< (n_rods + 1) into pairs_of_
  std::vector<std::pair<int, int>> pairs_of_;  ///< (pair, side), grouped by rod

  // scratch of one tick
  std::vector<std::int32_t> due_rods_;
  std::vector<std::int32_t> due_pairs_;
  std::vector<std::int32_t> popped_;
  std::vector<int> changed_;
  std::vector<int> may_change_;
  std::vector<BeadContact> bead_contacts_;
  std::vector<PairContact> contacts_;
  std::vector<Pose> poses_;
};

}  // namespace shaken
