#include "sim/checkpoint.h"

#include <xxhash.h>

#include <string>

#include "base/core/state_io.h"
#include "sim/physics_version.h"

namespace shaken {
namespace {

constexpr std::uint64_t kMagic = 0x34304e454b414853;               // "SHAKEN04"
constexpr std::uint64_t kMagicWithoutVirial = 0x33304e454b414853;  // "SHAKEN03"

/// One list of a flight's stored fields for both directions.
template <class Archive, class F>
void each_field(Archive&& visit, F& flight) {
  visit(flight.since);
  visit(flight.position);
  visit(flight.velocity);
  visit(flight.director);
  visit(flight.precession);
  visit(flight.spin);
  visit(flight.image[0]);
  visit(flight.image[1]);
}

template <class Archive, class C>
void each_counter(Archive&& visit, C& counters, bool has_posts) {
  const auto one = [&](auto& counter) {
    if (has_posts || static_cast<const void*>(&counter) != &counters.impulses_rod_post) visit(counter);
  };
  std::apply([&](auto... field) { (one(counters.*field), ...); }, Counters::fields());
}

/// What must be the same for a checkpoint to fit: everything that the stored numbers depend on.
template <class Archive>
void each_scene_key(Archive&& visit, const System& system) {
  visit(static_cast<std::int64_t>(system.n_rods));
  visit(static_cast<std::int64_t>(system.n_all_rods()));
  bool mixed = false;  // of several shapes
  const auto shape = [&](const RodShape& rod) {
    visit(static_cast<std::int64_t>(rod.n_beads));
    visit(rod.length);
    visit(rod.mid_diameter);
    visit(rod.end_diameter);
    visit(rod.density);
    visit(static_cast<std::int64_t>(rod.profile));
    if (rod.inertia != Inertia::kSolid) visit(static_cast<std::int64_t>(rod.inertia));
    for (const double diameter : rod.bead_diameters) visit(diameter);
    if (!rod.spread.is_any()) return;
    visit(rod.spread.length);
    visit(rod.spread.end_diameter);
    mixed = true;
  };
  shape(system.rod);
  for (const auto& more : system.added) {
    if (!more) continue;
    visit(static_cast<std::int64_t>(more->count));
    shape(more->rod);
    mixed = true;
  }
  if (mixed) visit(static_cast<std::int64_t>(system.seed));  // it says which rod is of which shape
  visit(static_cast<std::int64_t>(system.base));
  visit(static_cast<std::int64_t>(system.lid));
  if (system.walls) {
    visit(static_cast<std::int64_t>(system.walls->arena));
    visit(system.walls->size);
    visit(system.walls->inner);
    if (system.walls->has_length()) visit(system.walls->length);
    if (system.walls->arena == Arena::kWedge) visit(system.walls->narrow);
  }
  if (system.posts) {
    const StandingPosts posts = standing_posts(system);
    visit(posts.diameter);
    for (const Vec2& centre : posts.centres) {
      visit(centre.x());
      visit(centre.y());
    }
  }
  visit(system.box_side);
  if (system.box_aspect != 1) visit(system.box_aspect);
  visit(system.gap);
  visit(system.amplitude);
  visit(system.frequency);
  if (system.horizontal_amplitude > 0) {
    visit(system.horizontal_amplitude);
    visit(system.horizontal_phase);
    visit(system.horizontal_angle);
  }
  if (system.has_second_vibration()) {
    visit(system.second->amplitude);
    visit(system.second->frequency);
    visit(system.second->phase);
  }
  if (system.has_lid_motion()) {
    visit(system.lid_motion->amplitude);
    visit(system.lid_motion->phase);
  }
  visit(system.gravity);
  if (system.has_inclination()) {
    visit(system.inclination);
    visit(system.inclination_angle);
  }
  visit(system.dt);
}

void put_state(StateWriter& writer, const World& world) {
  writer.put(world.tick);
  for (const Flight& flight : world.rods) each_field([&](const auto& field) { writer.put(field); }, flight);
}

/// What follows the physics version. Throws StateError if there is too little or too much of it.
Result<World> restore_world(const System& system, StateReader& reader, bool has_virial) {
  const auto is_next = [&](const auto& key) {
    auto stored = key;
    reader.get(stored);
    return stored == key;
  };
  bool same_scene = true;
  each_scene_key([&](const auto& key) { same_scene = same_scene && is_next(key); }, system);
  if (!same_scene) return Error{"the checkpoint belongs to another scene"};

  World world = empty_world(system);
  each_counter([&](auto& counter) { reader.get(counter); }, world.counters, system.posts.has_value());
  Ledger::each_sum(
      [&](auto& sum) {
        std::uint64_t low = 0;
        std::int64_t high = 0;
        std::uint8_t overflow = 0;
        reader.get(low);
        reader.get(high);
        reader.get(overflow);
        if (overflow > 1) throw StateError("a sum that neither overflowed nor did not");
        sum.restore(low, high, overflow != 0);
      },
      has_virial, world.counters.ledger);
  reader.get(world.start.tick);
  reader.get(world.start.energy);
  reader.get(world.start.momentum);
  reader.get(world.tick);
  world.rods.resize(static_cast<std::size_t>(system.n_all_rods()));
  for (Flight& flight : world.rods) {
    each_field([&](auto& field) { reader.get(field); }, flight);
    flight.prepare();
  }
  reader.end();
  return world;
}

}  // namespace

std::vector<std::byte> state_bytes(const World& world) {
  StateWriter writer;
  put_state(writer, world);
  return writer.take();
}

std::uint64_t state_hash(const World& world) {
  const std::vector<std::byte> bytes = state_bytes(world);
  return XXH3_64bits(bytes.data(), bytes.size());
}

std::vector<std::byte> save_checkpoint(const World& world) {
  StateWriter writer;
  writer.put(kMagic);
  writer.put(static_cast<std::int64_t>(physics_version(world.system)));
  each_scene_key([&](const auto& key) { writer.put(key); }, world.system);
  each_counter([&](const auto& counter) { writer.put(counter); }, world.counters, world.system.posts.has_value());
  Ledger::each_sum(
      [&](const auto& sum) {
        writer.put(sum.low());
        writer.put(sum.high());
        writer.put(static_cast<std::uint8_t>(sum.overflow()));
      },
      true, world.counters.ledger);
  writer.put(world.start.tick);
  writer.put(world.start.energy);
  writer.put(world.start.momentum);
  put_state(writer, world);
  return writer.take();
}

Result<World> restore_checkpoint(const System& system, std::span<const std::byte> bytes) {
  StateReader reader(bytes);
  try {
    std::uint64_t magic = 0;
    if (bytes.size() >= sizeof magic) reader.get(magic);
    if (magic != kMagic && magic != kMagicWithoutVirial) return Error{"not a checkpoint of this version of Shaken"};
    std::int64_t physics = 0;
    reader.get(physics);
    if (physics != physics_version(system)) {
      return Error{"the checkpoint is of physics version " + std::to_string(physics) + ", this program has version " +
                   std::to_string(physics_version(system)) +
                   " and would go on in another way: finish the run with the program that began it, or start it anew"};
    }
    return restore_world(system, reader, magic == kMagic);
  } catch (const StateError&) {
    return Error{"the checkpoint has the wrong length"};
  }
}

}  // namespace shaken
