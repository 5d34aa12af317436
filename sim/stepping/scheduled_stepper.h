// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "sim/stepping/list_reserve.h"
#include "sim/stepping/loops.h"
#include "sim/stepping/motion_change.h"
#include "sim/stepping/pair_search.h"
#include "sim/stepping/pair_table.h"
#include "sim/stepping/stepper.h"
#include "sim/stepping/tick.h"
#include "sim/stepping/timing_wheel.h"

namespace shaken {

/// Visits a rod or a pair only at the ticks at which contact is possible. After each visit a rigorous bound
/// (contact/safe_time.h, motion/plate_safe_time.h) tells up to when nothing can happen, and a timing wheel brings the
/// rod or pair back in time. What happens at a visit is tick.h's business, so the trajectory is the reference
/// stepper's, bit by bit.
///
/// The life of a pair:
///
///     two rods come near      bound: nothing can happen         it comes up, a little before the bound ends
///     (NeighborList)          for so many ticks                 (TimingWheel)
///          |                        |                                |
///          v                        v                                v
///        visit ---------------->  bound ------- waits ----------->  enough time left? -- no --> visit --> ...
///          |                        ^           ^ |   |              |
///          v                        |           | |   |              | yes (PairTable::waits_on)
///      contacts?                    |           +-+---|--------------+
///      response, storing            |             |   +---> the rods have parted: forgotten (NeighborList)
///                                   +-------------+
///                hits have taken more of the gap than they may: it comes up sooner (PairTable::settle),
///                or, if that were too soon, gets a new bound
///
/// Four things keep the work small:
///  1. A hit does not end a bound. Plates hit a rod thousands of times per second, and what a hit makes the gap to a
///     neighbour close faster takes a little of what it may take (GapAllowances), of all neighbours' at once.
///  2. A rod that a plate hits tick after tick rests on it and is visited at the next tick without a bound.
///  3. Beads that overlap but recede are left alone, unless a rod of theirs may be hit in this very tick.
///  4. Rods meet plates several at a time (stepping/plate_impacts.h).
///
/// Every rod and every pair belongs to a worker, and each worker may be a thread of its own (SharedLoops). A tick is a
/// few loops in which a worker handles what belongs to it; what takes two workers is done by the first one in between:
/// places in the neighbour list and the impulses between rods.
class ScheduledStepper final : public Stepper {
 public:
  /// A tick is shared among the threads if the one before it had at least `grain` visits and bounds for each.
  ScheduledStepper(const World& world, int n_threads, int grain);
  std::size_t bytes() const override;
  WorkCounts work_counts() const override;

 private:
  struct RodMarks {
    Tick posed_at = -1;    ///< tick for which rods_ holds the rod
    Tick listed_at = -1;   ///< tick at which it was last to be scheduled
    Tick changed_at = -1;  ///< tick at which it was last hit
    Tick rests_at = -1;    ///< last tick at which a surface hit it when it had been hit in the tick before
    Tick bounded_at = -1;  ///< tick for which motion_bounds_ holds the rod
  };
  /// What one worker has, and gathers in a tick: rods and pairs of its own.
  struct alignas(64) Worker {
    std::size_t number = 0;
    std::vector<int> due_rods;
    std::vector<int> to_place;  ///< rods that have used up their reserve in the neighbour list
    std::vector<int> near;      ///< rods, near each of those, one after the other
    std::vector<std::size_t> near_end;
    std::vector<int> out_of_hand;  ///< rods whose motion is trouble after the surfaces
    std::vector<int> due_pairs;
    std::vector<int> to_pose;  ///< rods
    std::vector<PairContact> contacts;
    std::vector<int> turned;                  ///< pairs that began or ceased to touch
    std::vector<int> changed;                 ///< rods hit in this tick
    std::vector<int> to_schedule;             ///< rods
    std::vector<std::vector<int>> to_settle;  ///< (n_workers) pairs of each worker of which hits took too much
    bool has_told = false;                    ///< there are any
    std::vector<int> searched_again;          ///< pairs of rods at rest
    std::vector<int> to_bound;                ///< pairs
    std::vector<int> to_bound_motion;         ///< rods of pairs that need a bound, of whatever worker
    Counters counters;
    WorkCounts counts;
    std::optional<NumericalTrouble> trouble;  ///< that of the first rods
    std::vector<BeadContact> bead_contacts;
    Pose other_pose{};
    PlateLanes plate_lanes{};
    PairLanes pair_lanes{};
  };

  std::optional<NumericalTrouble> step(World& world, Tick now) override;

  // parts of a tick, in this order; of those without a worker the first thread does all
  void meet_surfaces_due(World& world, const PlateState& plates, Tick now, Worker& worker);
  std::optional<NumericalTrouble> gather_surfaces(World& world);
  void place_rods(Tick now);
  void detect_due(const World& world, Tick now, Worker& worker);
  void gather_contacts(const World& world, Tick now);
  void replace_pairs(const World& world, Tick now);
  void detect_touching(const World& world, Tick now);
  std::optional<NumericalTrouble> check_changed(Tick now);
  void store_changed(World& world, Tick now, Worker& worker);
  void schedule_rods(const World& world, Tick now, Worker& worker);
  void tell_pairs(Tick now, Worker& worker);
  void settle_pairs(Tick now, Worker& worker);
  void bound_motions(const World& world, Tick now, Worker& worker);
  void schedule_pairs(Tick now, Worker& worker);

  template <class Visit>
  void in_loop(const Visit& visit) {
    phase_times.begin_loop();
    loops_.run(visit);
    phase_times.end_loop();
  }
  Worker& worker_of(int i) { return loops_.workers()[owners_[i]]; }
  void lap(const Worker& worker, Phase phase) {
    if (worker.number == 0) phase_times.lap(phase);
  }
  void pose_rod(int i, const World& world, Tick now);
  void pose_if_needed(int i, const World& world, Tick now);
  void build_neighbors(Tick now);
  void add_gained();
  void detect(int p, const World& world, Tick now);
  void pose_listed(const World& world, Tick now, Worker& worker);
  void bound_pairs(std::span<const int> pairs, Tick now, Worker& worker);
  /// Where free flight brought the rod; impacts at their instant may have displaced it since.
  const Pose& found(int i) const { return found_.empty() ? rods_[i].pose : found_[i]; }
  auto groups_of_rods() const;
  int species_index(int i) const { return rules_.species_of_rod[i]; }

  TickRules rules_;
  PairSearch search_;
  bool meets_in_lanes_;  ///< plates are met by several rods at a time
  NeighborList neighbors_;
  SharedLoops<Worker> loops_;
  std::size_t grain_;

  // of each rod
  std::vector<RodAtTick> rods_;
  std::vector<Pose> found_;            ///< or empty, if nothing displaces rods
  std::vector<MotionChange> changes_;  ///< of a rod that was hit in this tick
  std::vector<ListReserve> reserves_;
  std::vector<RodMarks> marks_;
  std::vector<MotionBound> motion_bounds_;
  std::vector<std::uint8_t> owners_;  ///< the worker of each rod
  TimingWheel wheel_;

  PairTable pairs_;
  bool is_new_ = true;

  // lists of one tick
  std::vector<PairContact> contacts_;
  std::vector<int> may_change_;     ///< rods that touch another and may yet be hit in this tick
  std::vector<int> gained_, lost_;  ///< pairs, by the neighbour list
  bool have_placed_ = false;        ///< there are rods with a new place
  bool was_complete_ = true;        ///< pairs gained in this tick cannot touch yet
};

}  // namespace shaken
