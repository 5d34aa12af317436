// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <span>
#include <vector>

#include "sim/contact/bead_safe_time.h"
#include "sim/contact/hull_safe_time.h"
#include "sim/core/thread_team.h"
#include "sim/motion/plate_safe_time.h"
#include "sim/neighbors/neighbor_list.h"
#include "sim/stepping/compose.h"
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
/// Each phase of a tick is a loop over a list without order, which several threads may share: each rod and pair has an
/// owner, so that what belongs to it stays in one thread's caches. Lists, marks, wheels and the impulses between rods
/// are the first thread's.
class ScheduledStepper final : public Stepper {
 public:
  /// Loops are shared if there are at least `grain` items for each thread.
  ScheduledStepper(const World& world, int n_threads, int grain, const Kernels& kernels);
  std::size_t bytes() const override;

 private:
  static constexpr Tick kNever = -1;

  /// What the stepper knows of a rod beside its flight; its owner's.
  struct RodRecord {
    float strayed_velocity[3] = {0, 0, 0};  ///< change by hits since the rod's limits were set [mm/s]
    float strayed_turning[3] = {0, 0, 0};   ///< the same for d director / dt [1/s]
    float blur = 0;                         ///< what strayed_turning may be wrong by [1/s]
    float rate_limit = 0;                   ///< of the precession; part of the limits [rad/s]
    float slack = 1e30F;                    ///< of the neighbour list at `slack_at`, at least [mm]
    float slack_speed = 0;                  ///< at which it shrinks, at most [mm/s]
    Tick slack_at = kNever;
  };
  /// The same, the first thread's.
  struct RodMarks {
    Tick posed_at = kNever;       ///< tick for which rods_ holds the rod
    Tick listed_at = kNever;      ///< tick at which it was last to be scheduled
    Tick changed_at = kNever;     ///< tick at which it was last hit
    Tick outlook_at = kNever;     ///< tick for which outlooks_ holds the rod
    std::int16_t n_touching = 0;  ///< pairs of the rod that are touching
    std::int16_t n_steady = 0;    ///< pairs whose bound holds for steady flight only
  };
  /// In which direction a pair's hulls were apart at the last bound; 0: not known.
  using Direction = std::array<float, 3>;
  using PairRods = std::array<int, 2>;
  static constexpr PairRods kUnused{-1, -1};  ///< of a number that the neighbour list does not use
  /// Marks of a pair, the first thread's.
  enum PairMark : std::uint8_t {
    kSteady = 1,    ///< the bound holds for steady flight only
    kTouching = 2,  ///< beads overlapped at the last search
    kListed = 4,    ///< for a new bound
  };
  /// What one thread has and gathers in a loop.
  struct Worker {
    void note(NumericalTrouble met);

    std::vector<int> own;                   ///< items of a list that the thread owns
    std::span<const int> mine;              ///< those that it visits: its own, or all if it is alone
    std::vector<Tick> next;                 ///< ticks at which they are due
    std::vector<std::uint8_t> next_steady;  ///< whether the pairs' new bounds hold for steady flight only
    Counters counters;
    std::optional<NumericalTrouble> trouble;  ///< that of the first rods
    std::vector<int> hit;                     ///< rods, by a plate
    std::vector<int> strayed;                 ///< rods, out of their limits: their pairs need new bounds
    std::vector<int> to_place;                ///< rods that have used up their slack
    std::vector<BeadContact> bead_contacts;
    std::vector<PairContact> contacts;
    std::vector<int> turned;  ///< pairs that began or ceased to touch
    PlateLanes plate_lanes{};
    PairLanes pair_lanes{};
  };

  std::optional<NumericalTrouble> step(World& world, Tick now) override;

  // phases of a tick
  std::optional<NumericalTrouble> meet_surfaces_due(World& world, Tick now);
  void list_pairs(const World& world, Tick now);
  void detect_due(const World& world, Tick now);
  void detect_touching(const World& world, Tick now);
  std::optional<NumericalTrouble> store_changed(World& world, Tick now);
  void schedule_rods(const World& world, Tick now);
  void schedule_pairs(const World& world, Tick now);

  /// Calls visit(worker) on each thread, worker.mine being its part of the list; on one if that is not worth it.
  template <class Visit>
  void share(const std::vector<int>& list, const std::vector<std::uint8_t>& owners, const Visit& visit);

  // parts of them
  std::optional<NumericalTrouble> first_trouble() const;
  void list_changed(int i, Tick now);
  void list_to_pose(int i, Tick now);
  void pose(const World& world, Tick now);
  bool detect(int p, Worker& worker);
  const Pose& found(int i) const { return found_.empty() ? rods_[i].pose : found_[i]; }
  void turn_touching(int p);
  void mark_steady(int p, bool steady);
  bool within_limits(const RodRecord& record, const Flight& flight) const;
  static void set_limits(RodRecord& record, const Flight& flight);
  Outlook outlook(const World& world, int i, Tick now) const;
  float slack_left(int i, Tick now) const;
  void measure_slack(int i, Tick now);
  Tick listed_ticks(const World& world, int i, Tick now);
  Tick off_walls_ticks(const World& world, int i) const;
  void bound_pairs(std::span<const int> pairs, Tick now, Worker& worker);

  // with several species, lists are sorted so that what is bounded together is of one kind
  int rod_group(int i) const { return rules_.rod_kinds[i]; }
  int pair_group(int p) const {
    return rod_group(pair_rods_[p][0]) * static_cast<int>(rules_.kinds.size()) + rod_group(pair_rods_[p][1]);
  }
  /// Sorts a list by group.
  template <class Group>
  void sort_by(const Group& group, std::vector<int>& list) const;
  /// Calls visit(part) for parts of the list that are of one group and fit into the lanes.
  template <class Group, class Visit>
  void in_lanes(const Group& group, std::span<const int> list, const Visit& visit) const;

  TickRules rules_;
  Kernels kernels_;
  std::vector<Hull> hulls_;       ///< (n_species)
  std::vector<BeadLanes> lanes_;  ///< (n_species)
  std::vector<double> reach_;     ///< (n_species) [mm]
  NeighborList neighbors_;
  ThreadTeam team_;
  int grain_;

  std::vector<RodAtTick> rods_;
  std::vector<Pose> found_;  ///< where free flight brought the rods of rods_, if impacts may displace them; or empty
  std::vector<RodRecord> records_;
  std::vector<RodMarks> marks_;
  std::vector<Outlook> outlooks_;
  std::vector<std::uint8_t> rod_owners_;  ///< the thread of each rod
  TimingWheel rod_wheel_;

  // pairs, numbered as in the neighbour list
  std::vector<PairRods> pair_rods_;
  std::vector<Direction> directions_;
  std::vector<Tick> detected_at_;          ///< tick of the last search for contacts
  std::vector<std::uint8_t> pair_marks_;   ///< of PairMark
  std::vector<std::uint8_t> pair_owners_;  ///< the thread of each pair
  TimingWheel pair_wheel_;
  bool is_new_ = true;

  // lists of one tick
  std::vector<std::int32_t> due_rods_;
  std::vector<std::int32_t> due_pairs_;
  std::vector<PairContact> contacts_;
  std::vector<int> changed_;      ///< rods hit in this tick
  std::vector<int> to_pose_;      ///< rods whose pose is needed
  std::vector<int> to_look_at_;   ///< rods whose outlook is
  std::vector<int> to_schedule_;  ///< rods that need a bound
  std::vector<int> to_bound_;     ///< pairs that need one
  std::vector<int> may_change_;
  std::vector<int> gained_, lost_;  ///< pairs
  std::vector<Worker> workers_;
};

}  // namespace shaken
