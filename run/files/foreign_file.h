#pragma once

#include <filesystem>

#include "base/core/result.h"

namespace shaken::run {

/// Fails if a file in HDF5 that no hash vouches for (run/files/content_hash.h), as that of a stranger, ends or keeps a
/// process of its own that reads it: damaged metadata make HDF5 do so, and then it would be the caller's process.
/// Nothing is said of other files.
Result<void> try_to_read(const std::filesystem::path& file);

/// `shaken-worker read FILE`: that process.
int read_command(int argc, char** argv);

}  // namespace shaken::run
