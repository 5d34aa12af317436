#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "base/core/result.h"
#include "sim/world.h"

namespace shaken {

/// Tick and stored state of every rod, exactly; what state_hash() is made of. Fixed order, little-endian.
std::vector<std::byte> state_bytes(const World& world);

/// XXH3 (64 bit) of state_bytes().
std::uint64_t state_hash(const World& world);

/// state_bytes(), the counters, and enough of the scene to refuse another one's checkpoint. Nothing derived is stored:
/// a stepper made anew from the restored world goes on bitwise as if it had never stopped.
std::vector<std::byte> save_checkpoint(const World& world);
Result<World> restore_checkpoint(const System& system, std::span<const std::byte> bytes);

}  // namespace shaken
