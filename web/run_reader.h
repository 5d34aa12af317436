#pragma once

#include <chrono>
#include <condition_variable>
#include <filesystem>
#include <functional>
#include <map>
#include <mutex>
#include <set>
#include <string>
#include <vector>

#include "base/core/result.h"

namespace shaken::web {

/// Has recorded runs read by other processes (`shaken-web read`), one for each question: HDF5 does not survive every
/// damaged file, and with some it comes to no end. A run whose file does that is read no more for a minute, and keeps
/// nobody who asks for another run. May be asked from many threads at once.
class RunReader {
 public:
  static constexpr std::chrono::seconds kLimit{20};

  /// `runs`: the folder of the run directories. `stop`: whether readers that are at work are to end. `limit`: for one
  /// reader, and for the wait for the one before it on the same run.
  RunReader(std::filesystem::path runs, std::function<bool()> stop, std::chrono::milliseconds limit = kLimit)
      : runs_(std::move(runs)), stop_(std::move(stop)), limit_(limit) {}

  /// What `shaken-web read` answers. The files are held against their hashes in summary.json before.
  Result<std::string> ask(const std::string& run, const std::vector<std::string>& question);

 private:
  using Clock = std::chrono::steady_clock;
  /// What ended its reader, or kept it.
  struct Bad {
    std::string stamp;  ///< of the file: another one may do
    std::string why;
    Clock::time_point until;
  };
  Result<std::string> read(const std::string& run, const std::filesystem::path& file,
                           const std::vector<std::string>& question);

  std::filesystem::path runs_;
  std::function<bool()> stop_;
  std::chrono::milliseconds limit_;
  std::mutex mutex_;
  std::condition_variable free_;
  std::set<std::string> busy_;  ///< runs that are being read
  std::map<std::filesystem::path, Bad> bad_;
};

/// `shaken-web read DIR QUESTION...`: what one run directory holds, for RunReader. DIR is the run's; its files are
/// taken for whole. The question is one of
/// - `frames`: {"n", "first_s", "last_s"}
/// - `frame K`: the bytes of web/packed_frame.h
/// - `curves NAME...`: {"names", "curves"} of observables.h5, with the values of those that are named
/// The answer goes to stdout. Returns the exit code: 0, or 1 with the reason on stdout in place of the answer.
int read_run_command(int argc, char** argv);

}  // namespace shaken::web
