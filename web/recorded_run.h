// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <filesystem>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "client/watch/rod_frame.h"
#include "run/files/observables_file.h"
#include "run/files/trajectory.h"
#include "sim/core/result.h"

namespace shaken::web {

struct FileEntry {
  std::string name;
  std::uintmax_t size = 0;  ///< [bytes]
};

/// What run directories hold, for pages. HDF5 does one thing at a time, and so does this; may be asked from many
/// threads.
class RecordedRuns {
 public:
  explicit RecordedRuns(std::filesystem::path runs) : runs_(std::move(runs)) {}

  /// Number of frames that are recorded so far; times of the first and of the last one [s].
  struct Frames {
    std::size_t n = 0;
    double first = 0, last = 0;
  };
  Result<Frames> frames(const std::string& run);
  Result<client::RodFrame> frame(const std::string& run, std::size_t index);
  /// All curves of a run that is done.
  Result<run::Observables> curves(const std::string& run);

  /// Its plain files, in alphabetical order. Empty where there is no such directory.
  std::vector<FileEntry> files(const std::string& run) const;
  std::filesystem::path directory(const std::string& run) const { return runs_ / run; }

  /// Whether `text` has the form of an id: 16 hex digits.
  static bool is_id(const std::string& text);

 private:
  /// The reader of a trajectory; kept, for a page asks for one frame after the other.
  Result<const run::TrajectoryReader*> reader(const std::string& run);

  std::filesystem::path runs_;
  std::mutex mutex_;
  std::string opened_;  ///< run, size and time of the file that `reader_` has open
  std::optional<run::TrajectoryReader> reader_;
};

}  // namespace shaken::web
