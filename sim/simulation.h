#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/core/result.h"
#include "sim/snapshot.h"
#include "sim/start/compression.h"
#include "sim/stepping/phase_times.h"
#include "sim/stepping/work_counts.h"
#include "sim/system.h"
#include "sim/world.h"

namespace shaken {

class Stepper;

/// A world and the stepper that moves it: the one door through which everything outside sim/ runs a simulation.
/// Nothing behind this door depends on which stepper is in use, and the trajectory does not either.
class Simulation {
 public:
  /// Places the rods as the scene says. Fails, with the largest area fraction that fits, if they cannot be packed.
  /// A compressed start takes CPU seconds; it asks `go_on` now and then, and fails once that says false.
  static Result<Simulation> start(const System& system, const GoOn& go_on = {});
  /// Begins with the rods as they are in `left` (sim/start/from_another_run.h), in a box and a gap that may be others
  /// (make_resized_world() in sim/start/compression.h, which asks `go_on`); fails as those do.
  static Result<Simulation> start(const System& system, const World& left, const GoOn& go_on = {});
  /// Continues from bytes made by checkpoint(), bitwise as if there had been no stop.
  /// Fails if the bytes are damaged or belong to another scene.
  static Result<Simulation> resume(const System& system, std::span<const std::byte> checkpoint);

  /// Begins with a world made by hand: empty_world(scene), at any tick, with a prepared flight for each of its rods.
  /// What they have then is what the energy balance begins with.
  static Simulation start_from(World world);

  Simulation(Simulation&&) noexcept;
  Simulation& operator=(Simulation&&) noexcept;
  ~Simulation();

  /// Steps to tick `target` (>= tick()), or up to the tick at which numerical trouble was met.
  /// Trouble is final: the simulation must not be advanced further.
  [[nodiscard]] std::optional<NumericalTrouble> advance_to(Tick target);

  /// Shares the work of each tick among so many threads; the trajectory stays bitwise the same. Worth it from about
  /// 2,000 rods on. Times of phases start anew. A tick is shared if the one before it had at least `grain` visits and
  /// bounds for each thread.
  void use_threads(int n_threads, int grain = kGrain);
  static constexpr int kGrain = 12;
  /// From now on, and until use_threads(), loops are shared only where that is faster by `clock` (time on the wall), as
  /// trials find from time to time (schedule/sharing_trial.h). This does not change a bit either.
  void share_where_faster(PhaseTimes::Clock clock);
  /// From now on, the time spent in each phase of a tick is taken by `clock`; nullptr ends it.
  void time_phases(PhaseTimes::Clock clock);
  const PhaseTimes& phase_times() const;
  /// What the scheduled stepper has looked at since the start, or since use_threads(). The reference stepper looks at
  /// everything, and counts nothing.
  WorkCounts work_counts() const;
  /// Memory of the rods' states and of all that the stepper derives from them [bytes].
  std::size_t bytes() const;

  Tick tick() const;
  double time() const;
  const World& world() const { return *world_; }
  Snapshot snapshot() const;
  std::vector<std::byte> checkpoint() const;
  /// Hash of the stored state of every rod; equal hashes mean bitwise equal states.
  std::uint64_t state_hash() const;

 private:
  explicit Simulation(World world);
  std::unique_ptr<World> world_;
  std::unique_ptr<Stepper> stepper_;
};

}  // namespace shaken
