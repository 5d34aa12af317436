#pragma once

#include <vector>

#include "sim/schedule/sharing_trial.h"
#include "sim/stepping/detection_phase.h"
#include "sim/stepping/neighbor_upkeep.h"
#include "sim/stepping/pair_bounding.h"
#include "sim/stepping/stepper.h"
#include "sim/stepping/storing_phase.h"
#include "sim/stepping/surfaces_phase.h"

namespace shaken {

/// Visits a rod or a pair only at the ticks at which contact is possible. After each visit a rigorous bound (bounds/)
/// says until when nothing can happen, and a timing wheel brings the rod or pair back in time. What happens at a visit
/// is defined in tick/tick.h, so the trajectory is the reference stepper's, bit for bit. docs/stepper.md says why.
///
/// The life of a pair:
///
///     two rods come near                                                     the rods have parted
///     (NeighborUpkeep)                                                       (NeighborUpkeep)
///          |                                                                       ^
///          v                                                                       |
///       SEARCH -- beads overlap --> response: impulse, new flights                 |
///          |  \_________________________________|                                  |
///          v                                    v                                  |
///        BOUND: the gap is at least `residual` at the bound's end, and closes at `rate`
///          |      tick:  now                 until       end
///          |              |--------------------|----------|
///          |              sleeps               the last part is kept back: what the gap still is at `until`
///          v                                   is shared by the two rods as their BUDGETS (GapBudgets)
///        ASLEEP -- a hit on one of its rods spends a part of that rod's budget
///          |   '-- budget overspent --> SHORTEN: the time that remains follows from the gap, the rate and all hits
///          v                            since; if it is too short to be worth it, a new BOUND is made
///        COMES UP at `until` + 1
///          |-- the bound holds still --> BOUND: the rods cannot touch yet, so nothing is searched
///          '-- it has ended          --> SEARCH
///
/// A tick. Every rod and every pair belongs to a share (Share), and each share may have a thread of its own. Loops
/// marked || run on all shares at once, each on what belongs to it; the first thread alone does those marked 1, which
/// concern several shares; a row without a mark goes on in the loop above. Lists are members of Share.
///
///     phase         loop                               reads                        leaves
///     ------------------------------------------------------------------------------------------------------------
///     1 surfaces    || SurfacesPhase::meet_due         rods' wheel, polled          visited, hit, to_place, failed
///                   1  gather                          visited                      counters of the world, trouble
///     2 detection   1  NeighborUpkeep::place_rods      to_place                     places in the neighbour list
///                   || find_near                       to_place                     near
///                      DetectionPhase::search_due      pairs' wheel, hit            searched, apart, contacts, toggled
///                   1  gather                          contacts, toggled            contacts of all
///                      NeighborUpkeep::replace_pairs   to_place, near               pairs gained and lost
///                      search_gained, search_touching  hit                          contacts in the order of response
///     3 response    1  collide_rods                    contacts                     rods with new motions
///     4 storing     1  StoringPhase::check_hit         contacts, failed             hit: all rods hit; to_schedule
///                   || begin_flights                   hit                          new flights, jumps
///                      spend_budgets                   hit, jumps                   overspent, by the pairs' owners
///       bounds         SurfacesPhase::schedule         visited, to_schedule         rods' wheel, polled
///                   || PairBounding::shorten           searched, apart, overspent   pairs' wheel, to_bound
///                      bound_flights                   to_bound                     flight bounds (each once: claim)
///                   || schedule                        to_bound                     pairs' wheel, new budgets
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
