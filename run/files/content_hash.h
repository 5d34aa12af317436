// Hashes of whole files. summary.json has those of trajectory.h5 and observables.h5: a damaged file can end a program
// that hands it to HDF5, keep it for ever, or be read with other numbers than were written.
#pragma once

#include <cstdint>
#include <filesystem>

#include "base/core/result.h"

namespace shaken::run {

struct ContentHash {
  std::uintmax_t size = 0;  ///< [bytes]
  std::uint64_t xxh3 = 0;   ///< XXH3, 64 bits

  bool operator==(const ContentHash&) const = default;
};

/// The hash of a regular file. It is read as a whole, some GB in a second at best.
Result<ContentHash> content_hash(const std::filesystem::path& file);

/// Fails, with what to do, if `file` is not what the summary.json beside it says that the run has written. Nothing is
/// known, and nothing wrong, where that has no hash of it: the run is of an older version, or has not ended. A file
/// that has been found whole is not read again by this process as long as its size, time and inode stay. From any
/// thread.
Result<void> check_content(const std::filesystem::path& file);

/// Whether the summary.json beside it has a hash of `file`.
bool has_hash(const std::filesystem::path& file);

/// Takes `file`, as it is now, for one that has been found whole: another process has looked.
void assume_whole(const std::filesystem::path& file);

}  // namespace shaken::run
