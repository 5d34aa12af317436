// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "sim/bounds/plate_safe_time.h"
#include "sim/bounds/velocity_jump.h"
#include "sim/schedule/loops.h"
#include "sim/schedule/pair_schedule.h"
#include "sim/schedule/pair_search.h"
#include "sim/schedule/sharing_trial.h"
#include "sim/schedule/skin_budget.h"
#include "sim/schedule/timing_wheel.h"
#include "sim/stepping/stepper.h"
#include "sim/tick/tick.h"

namespace shaken {

/// Visits a rod or a pair only at the ticks at which contact is possible. After each visit a rigorous bound
/// (bounds/safe_time.h, bounds/plate_safe_time.h) says until when nothing can happen, and a timing wheel brings the rod
/// or pair back in time. What happens at a visit is defined in tick/tick.h, so the trajectory is the reference
/// stepper's, bit for bit. docs/stepper.md explains it with figures.
///
/// The life of a pair:
///
///     two rods come near      bound: nothing can happen         it comes up, a little before the bound ends
///     (NeighborList)          for so many ticks                 (TimingWheel)
///          |                        |                                |
///          v                        v                                v
///        search --------------->  bound ------- waits ----------->  enough time left? -- no --> search --> ...
///          |                        ^           ^ |   |              |
///          v                        |           | |   |              | yes (PairSchedule::defer)
///      contacts?                    |           +-+---|--------------+
///      response, storing            |             |   +---> the rods have parted: forgotten (NeighborList)
///                                   +-------------+
///                hits have overspent the pair's budget: it comes up sooner (PairSchedule::shorten_bound)
///                or, if that were too soon, gets a new bound
///
/// Four things keep the work small:
///  1. A hit does not end a bound. Plates hit a rod thousands of times per second; each hit spends a little of the
///     budgets that the bounds of all its pairs leave it (GapBudgets), in one vector operation.
///  2. A rod that a plate hits tick after tick rests on it and is visited at the next tick without a bound.
///  3. Beads that overlap but recede are left alone, unless a rod of theirs may be hit in this very tick.
///  4. Rods meet plates several at a time (tick/plate_impacts.h).
///
/// Every rod and every pair belongs to a share, and each share may have a thread of its own (SharedLoops). A tick is
/// five loops in which each share handles what belongs to it; in between the first thread alone does what concerns
/// several shares: places in the neighbour list, and the impulses between rods.
class ScheduledStepper final : public Stepper {
 public:
  /// A tick is shared among the threads if the one before it had at least `grain` visits and bounds for each.
  ScheduledStepper(const World& world, int n_threads, int grain);
  std::size_t bytes() const override;
  WorkCounts work_counts() const override;
  void share_where_faster(PhaseTimes::Clock clock) override;

 private:
  struct RodMarks {
    Tick posed_at = -1;     ///< tick for which rods_ holds the rod
    Tick listed_at = -1;    ///< tick at which it was last to be scheduled
    Tick changed_at = -1;   ///< tick at which it was last hit
    Tick rests_at = -1;     ///< last tick at which a surface hit it when it had been hit in the tick before
    Tick bounded_at = -1;   ///< tick for which flight_bounds_ holds the rod
    Tick searched_at = -1;  ///< tick in which all of its pairs that touch are searched for contacts
  };
  /// What the surfaces phase leaves to the phases after it.
  struct Met {
    std::vector<int> rods;      ///< visited in this tick
    std::vector<int> hit;       ///< of these, hit by a surface; the response adds those that other rods hit
    std::vector<int> to_place;  ///< whose skin budget is used up: the neighbour list is to find their pairs anew
    std::vector<int> failed;    ///< whose motion after the surfaces is numerical trouble
    Counters counters;
    std::optional<NumericalTrouble> trouble;  ///< that of the first rods
  };
  /// What detection leaves: pairs that came up, and their contacts.
  struct Detected {
    std::vector<int> pairs;    ///< searched in this tick
    std::vector<int> toggled;  ///< of these, those that began or ceased to touch
    std::vector<PairContact> contacts;
    std::vector<int> near;              ///< rods near each of `to_place`, one after the other
    std::vector<std::size_t> near_end;  ///< where those of each end
  };
  /// What storing and the loops that make bounds hand on to each other.
  struct Stored {
    std::vector<int> resting;                 ///< rods that are due at the next tick, without a bound
    std::vector<int> to_schedule;             ///< rods that need a bound on the time to the next surface
    std::vector<std::vector<int>> overspent;  ///< (n_shares) pairs of each share whose budgets hits overspent
    bool has_overspent = false;
    std::vector<int> polled;           ///< pairs of rods at rest: to be searched at the next tick without a bound
    std::vector<int> to_bound;         ///< pairs that need a bound
    std::vector<int> to_bound_motion;  ///< rods of such pairs, of whatever share
  };
  /// One thread's share: the rods and pairs that belong to it, and its lists of one tick.
  struct alignas(64) Share {
    std::size_t number = 0;
    Met met;
    Detected detected;
    Stored stored;
    WorkCounts counts;
    // scratch
    std::vector<int> to_pose;  ///< rods
    std::vector<BeadContact> bead_contacts;
    Pose other_pose{};
    PlateLanes plate_lanes{};
    PairLanes pair_lanes{};
  };

  std::optional<NumericalTrouble> step(World& world, Tick now) override;

  // parts of a tick, in this order; of those without a share the first thread does all
  void meet_surfaces_due(World& world, const PlateState& plates, Tick now, Share& share);
  std::optional<NumericalTrouble> gather_surfaces(World& world);
  void place_rods(Tick now);
  void detect_due(const World& world, Tick now, Share& share);
  void gather_contacts(const World& world, Tick now);
  void replace_pairs(const World& world, Tick now);
  void detect_touching(const World& world, Tick now);
  std::optional<NumericalTrouble> check_changed(Tick now);
  void store_changed(World& world, Tick now, Share& share);
  void schedule_rods(const World& world, Tick now, Share& share);
  void spend_budgets(Tick now, Share& share);
  void shorten_bounds(Tick now, Share& share);
  void bound_motions(const World& world, Tick now, Share& share);
  void schedule_pairs(Tick now, Share& share);

  template <class Visit>
  void in_loop(const Visit& visit) {
    phase_times.begin_loop();
    loops_.run(visit);
    phase_times.end_loop();
  }
  Share& share_of(int i) { return loops_.shares()[owners_[i]]; }
  void lap(const Share& share, Phase phase) {
    if (share.number == 0) phase_times.lap(phase);
  }
  void pose_rod(int i, const World& world, Tick now);
  void pose_if_needed(int i, const World& world, Tick now);
  void build_neighbors(Tick now);
  void add_gained();
  void detect(int p, const World& world, Tick now);
  void pose_listed(const World& world, Tick now, Share& share);
  void bound_pairs(std::span<const int> pairs, Tick now, Share& share);
  /// Where free flight brought the rod; impacts at their instant may have displaced it since.
  const Pose& flight_pose(int i) const { return flight_pose_.empty() ? rods_[i].pose : flight_pose_[i]; }
  auto groups_of_rods() const;
  int shape_of(int i) const { return rules_.shape_of_rod[i]; }

  TickRules rules_;
  PairSearch search_;
  bool meets_in_lanes_;  ///< plates are met by several rods at a time
  NeighborList neighbors_;
  SharedLoops<Share> loops_;
  std::size_t grain_;
  SharingTrial trial_;

  // of each rod
  std::vector<RodAtTick> rods_;
  std::vector<Pose> flight_pose_;    ///< or empty, if nothing displaces rods
  std::vector<VelocityJump> jumps_;  ///< of a rod that was hit in this tick
  std::vector<SkinBudget> skin_budgets_;
  std::vector<RodMarks> marks_;
  std::vector<FlightBound> flight_bounds_;
  std::vector<std::uint8_t> owners_;  ///< the share of each rod
  TimingWheel wheel_;

  PairSchedule pairs_;
  bool is_new_ = true;

  // lists of one tick
  std::vector<PairContact> contacts_;
  std::vector<int> may_change_;     ///< rods that touch another and may yet be hit in this tick, each once
  std::vector<int> gained_, lost_;  ///< pairs, by the neighbour list
  bool have_placed_ = false;        ///< there are rods with a new place
  bool was_complete_ = true;        ///< pairs gained in this tick cannot touch yet
};

}  // namespace shaken
