#pragma once

#include <cstddef>
#include <memory>
#include <optional>

#include "sim/stepping/phase_times.h"
#include "sim/stepping/work_counts.h"
#include "sim/world.h"

namespace shaken {

/// Moves a world from tick to tick. What a tick means is fixed (tick/tick.h); a stepper only chooses which rods and
/// pairs it looks at, so every stepper gives bitwise the same trajectory. Neighbour lists and schedules are derived
/// data of the stepper's own: making a new stepper for the same world changes nothing.
class Stepper {
 public:
  virtual ~Stepper() = default;

  /// Steps to `target`, or stops after the tick at which trouble was met: rods and counters are those before it, so
  /// that the balance closes.
  [[nodiscard]] std::optional<NumericalTrouble> advance_to(World& world, Tick target) {
    while (world.tick < target) {
      const Counters before = world.counters;
      auto trouble = step(world, world.tick + 1);
      ++world.tick;
      if (!trouble) continue;
      world.counters = before;
      return trouble;
    }
    return {};
  }

  /// Heap memory of what is derived from the world: lists, records, schedules [bytes].
  virtual std::size_t bytes() const = 0;

  /// The reference stepper, which looks at everything, counts nothing.
  virtual WorkCounts work_counts() const { return {}; }

  /// From now on loops are shared only where trials by `clock` (time on the wall) find that faster.
  virtual void share_where_faster(PhaseTimes::Clock clock) { static_cast<void>(clock); }

  PhaseTimes phase_times;

 private:
  /// Does tick `now`, the one after the world's.
  [[nodiscard]] virtual std::optional<NumericalTrouble> step(World& world, Tick now) = 0;
};

/// The stepper that the scene asks for, on so many threads (the reference stepper uses one).
std::unique_ptr<Stepper> make_stepper(const World& world, int n_threads, int grain);

}  // namespace shaken
