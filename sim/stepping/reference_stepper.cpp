#include "sim/stepping/reference_stepper.h"

#include "base/core/heap_bytes.h"
#include "sim/tick/rod_impacts.h"
#include "sim/tick/surface_impacts.h"

namespace shaken {
namespace {

/// Skin of the neighbour list [mm]. Wider: longer lists; narrower: more rebuilding. No choice changes the trajectory.
constexpr double kReferenceSkin = 0.3;

}  // namespace

ReferenceStepper::ReferenceStepper(const World& world)
    : rules_(world),
      neighbors_(world.species, world.shape_of_rod, world.system.box(), kReferenceSkin),
      rods_(world.rods.size()),
      poses_(world.rods.size()) {}

std::size_t ReferenceStepper::bytes() const {
  return neighbors_.bytes() + heap_bytes(rods_, poses_, bead_contacts_, contacts_);
}

std::optional<NumericalTrouble> ReferenceStepper::step(World& world, Tick now) {
  const int n = static_cast<int>(world.rods.size());
  phase_times.start();
  for (int i = 0; i < n; ++i) {
    rods_[i] = rod_at_tick(world.rods[i], now, rules_);
    poses_[i] = rods_[i].pose;
  }

  // 1. surfaces
  const PlateState plates = world.plates.at(now);
  for (int i = 0; i < n; ++i) {
    if (auto trouble = meet_surfaces(i, rods_[i], world.rods[i], plates, now, rules_, world.counters)) return trouble;
  }

  phase_times.lap(Phase::kSurfaces);

  // 2. detection
  if (neighbors_.is_due(poses_)) neighbors_.build(poses_);
  phase_times.lap(Phase::kNeighbors);
  contacts_.clear();
  for (const auto& [i, j] : neighbors_.pairs()) {
    bead_contacts_.clear();
    const Vec3 D = nearest_image(poses_[i].position, poses_[j].position, rules_.box);
    find_bead_contacts(rules_.species_of(i), poses_[i].director, rules_.species_of(j), poses_[j].director, D,
                       bead_contacts_);
    for (const BeadContact& beads : bead_contacts_) contacts_.push_back({i, j, beads});
  }
  sort_contacts(contacts_, rods_, rules_);

  phase_times.lap(Phase::kDetection);

  // 3. response
  if (auto trouble = collide_rods(contacts_, rods_, world, now, rules_)) return trouble;

  phase_times.lap(Phase::kResponse);

  // 4. storing
  for (int i = 0; i < n; ++i) {
    if (!rods_[i].changed) continue;
    if (!has_sound_motion(rods_[i], rules_)) return motion_trouble(i, rods_[i], now, rules_);
  }
  for (int i = 0; i < n; ++i) {
    if (rods_[i].changed) store(i, world.rods[i], rods_[i], now, rules_);
  }
  phase_times.lap(Phase::kStoring);
  return {};
}

}  // namespace shaken
