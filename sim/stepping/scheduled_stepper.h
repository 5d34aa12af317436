// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "sim/schedule/loops.h"
#include "sim/schedule/pair_schedule.h"
#include "sim/schedule/pair_search.h"
#include "sim/schedule/sharing_trial.h"
#include "sim/stepping/detection_phase.h"
#include "sim/stepping/neighbor_upkeep.h"
#include "sim/stepping/pair_bounding.h"
#include "sim/stepping/rod_states.h"
#include "sim/stepping/share.h"
#include "sim/stepping/stepper.h"
#include "sim/stepping/storing_phase.h"
#include "sim/stepping/surfaces_phase.h"
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
  std::optional<NumericalTrouble> step(World& world, Tick now) override;
  void choose_sharing();

  template <class Visit>
  void in_loop(const Visit& visit) {
    phase_times.begin_loop();
    loops_.run(visit);
    phase_times.end_loop();
  }
  void lap(const Share& share, Phase phase) {
    if (share.number == 0) phase_times.lap(phase);
  }

  TickRules rules_;
  PairSearch search_;
  NeighborList neighbors_;
  PairSchedule pairs_;
  SharedLoops<Share> loops_;
  std::vector<Share>& shares_ = loops_.shares();
  std::size_t grain_;
  SharingTrial trial_;
  RodStates rods_;
  SurfacesPhase surfaces_;
  NeighborUpkeep upkeep_;
  DetectionPhase detection_;
  StoringPhase storing_;
  PairBounding bounding_;
  bool is_new_ = true;
};

}  // namespace shaken
