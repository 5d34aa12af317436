#pragma once

#include <cstdint>
#include <string>

namespace shaken::run {

/// Where the numbers of an HDF5 file come from: its attributes `run_id`, `seed` and `shaken_version`.
struct Provenance {
  std::string run_id;      ///< scene/canonical.h; empty: no run, and no attributes
  std::uint64_t seed = 0;  ///< of all random numbers; the scene's time.seed
};

}  // namespace shaken::run
