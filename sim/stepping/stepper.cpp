#include "sim/stepping/stepper.h"

#include "base/core/check.h"
#include "sim/stepping/reference_stepper.h"
#include "sim/stepping/scheduled_stepper.h"

namespace shaken {

std::unique_ptr<Stepper> make_stepper(const World& world, int n_threads, int grain) {
  switch (world.system.stepper) {
    case StepperKind::kReference:
      return std::make_unique<ReferenceStepper>(world);
    case StepperKind::kScheduled:
      return std::make_unique<ScheduledStepper>(world, n_threads, grain);
  }
  SHAKEN_CHECK(false, "unknown stepper");
}

}  // namespace shaken
