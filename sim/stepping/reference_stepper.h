#pragma once

#include <vector>

#include "sim/neighbors/neighbor_list.h"
#include "sim/stepping/stepper.h"
#include "sim/tick/tick.h"

namespace shaken {

/// The paper's time-driven algorithm: visits every rod and every neighbour pair at every tick. Slow and obvious; the
/// oracle that any other stepper must match bit by bit.
class ReferenceStepper final : public Stepper {
 public:
  explicit ReferenceStepper(const World& world);
  std::size_t bytes() const override;

 private:
  std::optional<NumericalTrouble> step(World& world, Tick now) override;

  TickRules rules_;
  NeighborList neighbors_;
  std::vector<RodAtTick> rods_;
  std::vector<Pose> poses_;
  std::vector<BeadContact> bead_contacts_;
  std::vector<PairContact> contacts_;
};

}  // namespace shaken
