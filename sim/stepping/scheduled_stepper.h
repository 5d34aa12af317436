// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "sim/contact/bead_safe_time.h"
#include "sim/contact/hull_safe_time.h"
#include "sim/core/thread_team.h"
#include "sim/motion/plate_safe_time.h"
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
/// Hits by the plates change a rod's velocity thousands of times per second. Most pairs do not care: their bounds
/// provide for rods that stray within limits (Outlook, Allowance). Only a rod that leaves its limits has the bounds of
/// all its pairs renewed; a pair on the point of touching has a bound for steady flight instead, which is longer, and
/// renewed whenever one of its rods is hit.
///
/// Each phase of a tick is a loop over a list without order, which several threads may share; only the impulses
/// between rods, a few per cent of the time, are one thread's.
class ScheduledStepper final : public Stepper {
 public:
  /// Loops are shared if there are at least `grain` items for each thread.
  ScheduledStepper(const World& world, int n_threads, int grain);
  std::size_t bytes() const override;

 private:
  /// A tick, to be compared with the present one only: its low bits do.
  using Stamp = std::uint32_t;
  static Stamp stamp(Tick now) { return static_cast<Stamp>(now) + 1; }  // 0: never

  /// What the stepper knows of a rod beside its flight.
  struct alignas(64) RodRecord {
    float strayed_velocity[3] = {0, 0, 0};  ///< change by hits since the rod's limits were set [mm/s]
    float strayed_turning[3] = {0, 0, 0};   ///< the same for d director / dt [1/s]
    float rate_limit = 0;                   ///< of the precession; part of the limits [rad/s]
    float slack = 1e30F;                    ///< of the neighbour list at `slack_at`, at least [mm]
    float slack_speed = 0;                  ///< at which it shrinks, at most [mm/s]
    Stamp slack_at = 0;
    Stamp posed_at = 0;           ///< tick for which rods_ holds the rod
    Stamp listed_at = 0;          ///< tick at which it was last visited or hit
    Stamp outlook_at = 0;         ///< tick for which outlooks_ holds the rod
    std::int16_t n_touching = 0;  ///< pairs of the rod that are touching
    std::int16_t n_steady = 0;    ///< pairs whose bound holds for steady flight only
    bool strayed = false;         ///< by the last hit, out of its limits: the bounds of its pairs are to be renewed
  };
  struct PairRecord {
    int rod[2] = {-1, -1};           ///< -1: a number that the neighbour list does not use
    float direction[3] = {0, 0, 0};  ///< in which the hulls were apart at the last bound; 0: not known
    Stamp detected_at = 0;           ///< tick of the last search for contacts
    bool touching = false;           ///< beads overlapped then
  };
  /// What a pair is marked with: kept apart from the records because all pairs of a rod are asked.
  enum PairMark : std::uint8_t { kSteady = 1 /* the bound holds for steady flight only */, kListed = 2 };
  /// What one thread gathers in a loop.
  struct Worker {
    void note(NumericalTrouble met);

    Counters counters;
    std::optional<NumericalTrouble> trouble;  ///< that of the first rods
    std::vector<int> to_place;                ///< rods that have used up their slack
    std::vector<BeadContact> bead_contacts;
    std::vector<PairContact> contacts;
    std::vector<int> turned;  ///< pairs that began or ceased to touch
    PlateLanes plate_lanes{};
    PairLanes pair_lanes{};
  };

  std::optional<NumericalTrouble> step(World& world, Tick now) override;

  // phases of a tick
  std::optional<NumericalTrouble> collide_with_plates_due(World& world, Tick now);
  void list_pairs(const World& world, Tick now);
  void detect_due(const World& world, Tick now);
  void detect_touching(const World& world, Tick now);
  void list_changed(Tick now);
  std::optional<NumericalTrouble> store_changed(World& world, Tick now);
  void schedule_rods(const World& world, Tick now);
  void schedule_pairs(const World& world, Tick now);

  // parts of them
  std::optional<NumericalTrouble> first_trouble() const;
  void list_to_pose(int i, Tick now);
  void pose(const World& world, Tick now);
  bool detect(int p, Worker& worker);
  void turn_touching(int p);
  void mark_steady(int p, bool steady);
  bool within_limits(const RodRecord& record, const Flight& flight) const;
  static void set_limits(RodRecord& record, const Flight& flight);
  Outlook outlook(const World& world, int i, Tick now) const;
  float slack_left(int i, Tick now) const;
  void measure_slack(int i, Tick now);
  Tick listed_ticks(const World& world, int i, Tick now);
  void bound_pairs(int first, int n, Tick now, Worker& worker);

  TickRules rules_;
  Hull hull_;
  BeadLanes lanes_;
  NeighborList neighbors_;
  ThreadTeam team_;
  int grain_;

  std::vector<RodAtTick> rods_;
  std::vector<RodRecord> records_;
  std::vector<Outlook> outlooks_;
  TimingWheel rod_wheel_;

  std::vector<PairRecord> pairs_;         ///< numbered as in the neighbour list
  std::vector<std::uint8_t> pair_marks_;  ///< of PairMark
  TimingWheel pair_wheel_;
  bool is_new_ = true;

  // lists of one tick
  std::vector<std::int32_t> due_rods_;
  std::vector<std::int32_t> due_pairs_;
  std::vector<PairContact> contacts_;
  std::vector<int> changed_;               ///< rods hit in this tick
  std::vector<int> to_pose_;               ///< rods whose pose is needed
  std::vector<int> to_look_at_;            ///< rods whose outlook is
  std::vector<int> to_schedule_;           ///< rods that need a bound
  std::vector<int> to_bound_;              ///< pairs that need one
  std::vector<Tick> next_;                 ///< ticks at which they are due
  std::vector<std::uint8_t> next_steady_;  ///< whether the pairs' new bounds hold for steady flight only
  std::vector<int> may_change_;
  std::vector<int> gained_, lost_;  ///< pairs
  std::vector<Pose> poses_;
  std::vector<Worker> workers_;
};

}  // namespace shaken
