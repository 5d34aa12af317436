#include "sim/simulation.h"

#include "base/core/check.h"
#include "sim/balance.h"
#include "sim/checkpoint.h"
#include "sim/start/compression.h"
#include "sim/start/from_another_run.h"
#include "sim/start/initial.h"
#include "sim/stepping/stepper.h"

namespace shaken {

Simulation::Simulation(World world)
    : world_(std::make_unique<World>(std::move(world))), stepper_(make_stepper(*world_, 1, kGrain)) {}
Simulation::Simulation(Simulation&&) noexcept = default;
Simulation& Simulation::operator=(Simulation&&) noexcept = default;
Simulation::~Simulation() = default;

Result<Simulation> Simulation::start(const System& system, const GoOn& go_on) {
  return Simulation(
      SHAKEN_TRY(is_compressed(system.start) ? make_compressed_world(system, go_on) : make_world(system)));
}

Result<Simulation> Simulation::start(const System& system, const World& left, const GoOn& go_on) {
  auto world =
      SHAKEN_TRY(is_resized(system, left.system) ? make_resized_world(system, left, go_on) : make_world(system, left));
  return Simulation(std::move(world));
}

Result<Simulation> Simulation::resume(const System& system, std::span<const std::byte> checkpoint) {
  return Simulation(SHAKEN_TRY(restore_checkpoint(system, checkpoint)));
}

Simulation Simulation::start_from(World world) {
  SHAKEN_CHECK(world.rods.size() == static_cast<std::size_t>(world.system.n_all_rods()), "as many flights as rods");
  world.start = content(world);
  return Simulation(std::move(world));
}

std::optional<NumericalTrouble> Simulation::advance_to(Tick target) {
  SHAKEN_CHECK(target >= world_->tick, "time runs forwards");
  return stepper_->advance_to(*world_, target);
}

void Simulation::use_threads(int n_threads, int grain) {
  SHAKEN_CHECK(n_threads >= 1 && grain >= 1, "a run needs a thread, and a thread something to do");
  stepper_ = make_stepper(*world_, n_threads, grain);
}

void Simulation::share_where_faster(PhaseTimes::Clock clock) { stepper_->share_where_faster(clock); }
void Simulation::time_phases(PhaseTimes::Clock clock) { stepper_->phase_times.use(clock); }
const PhaseTimes& Simulation::phase_times() const { return stepper_->phase_times; }
WorkCounts Simulation::work_counts() const { return stepper_->work_counts(); }
std::size_t Simulation::bytes() const { return world_->rods.capacity() * sizeof(Flight) + stepper_->bytes(); }

Tick Simulation::tick() const { return world_->tick; }
double Simulation::time() const { return static_cast<double>(world_->tick) * world_->system.dt; }
Snapshot Simulation::snapshot() const { return shaken::snapshot(*world_); }
std::vector<std::byte> Simulation::checkpoint() const { return save_checkpoint(*world_); }
std::uint64_t Simulation::state_hash() const { return shaken::state_hash(*world_); }

}  // namespace shaken
