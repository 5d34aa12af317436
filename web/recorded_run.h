#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "base/core/result.h"
#include "client/live/rod_frame.h"
#include "run/files/directory.h"
#include "run/files/observables_file.h"
#include "run/files/order_curve.h"
#include "run/files/trajectory.h"

namespace shaken::web {

struct FileEntry {
  std::string name;
  std::uintmax_t size = 0;  ///< [bytes]
};

/// What a run directory holds, for pages. Frames and curves are read by HDF5, which damaged files can end or keep for
/// ever: the page has another process ask for them (web/run_reader.h).
class RecordedRun {
 public:
  explicit RecordedRun(std::filesystem::path directory) : directory_{std::move(directory)} {}

  /// Number of frames that are recorded so far; times of the first and of the last one [s]; why there are none.
  struct Frames {
    std::size_t n = 0;
    double first = 0, last = 0;
    std::string reason{};
  };
  Result<Frames> frames() const;
  Result<client::RodFrame> frame(std::size_t index) const;
  /// S(t) of at most `most` of the recorded frames (run/files/order_curve.h).
  Result<run::OrderCurve> order(std::size_t most) const;
  /// One rod in the frames from `first` to `last`, both included: times [s], places in the box [mm], and n_z.
  struct Path {
    std::vector<double> times, x, y, n_z;
  };
  Result<Path> path(std::size_t rod, std::size_t first, std::size_t last) const;
  /// All curves of a run that is done.
  Result<run::Observables> curves() const;

  /// Its plain files, in alphabetical order. Empty where there is no such directory.
  std::vector<FileEntry> files() const;

 private:
  Result<run::TrajectoryReader> reader() const;

  run::RunDirectory directory_;
};

}  // namespace shaken::web
