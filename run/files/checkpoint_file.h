#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "base/core/result.h"
#include "run/files/directory.h"

namespace shaken::run {

/// All that a run needs to go on as if it had not stopped.
struct Checkpoint {
  std::vector<std::byte> simulation;    ///< Simulation::checkpoint()
  std::vector<std::byte> measurements;  ///< Measurements::save()
  double cpu_seconds = 0;               ///< spent so far
  double wall_seconds = 0;              ///< spent so far
};

/// Writes DIR/checkpoint.bin atomically and keeps its predecessor as checkpoint.prev.bin. At any instant, also if the
/// disk fills up meanwhile, at least one whole checkpoint is left.
///
/// File, little-endian: "SHKNCKPT", version u32, run id (u32 length, bytes), length of the payload u64, payload, XXH3
/// (64 bit) of all before it.
Result<void> write_checkpoint(const RunDirectory& directory, const std::string& run_id, const Checkpoint& checkpoint);

/// What is wrong with one checkpoint file, or what it holds.
Result<Checkpoint> read_checkpoint(const std::filesystem::path& file, const std::string& run_id);

}  // namespace shaken::run
