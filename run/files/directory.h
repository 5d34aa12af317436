#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <system_error>
#include <utility>

#include "base/core/result.h"
#include "base/descriptor.h"

namespace shaken::run {

/// Where everything of one run lives.
struct RunDirectory {
  std::filesystem::path root;

  std::filesystem::path scene() const { return root / "scene.json"; }
  std::filesystem::path trajectory() const { return root / "trajectory.h5"; }
  /// Frames as they are recorded, until the run is done (run/files/frame_log.h).
  std::filesystem::path frames() const { return root / "trajectory.part"; }
  /// Where all frames are that there are so far: the one or the other.
  std::filesystem::path recorded() const {
    std::error_code hidden;  // a folder of somebody else's
    return std::filesystem::exists(frames(), hidden) ? frames() : trajectory();
  }
  std::filesystem::path observables() const { return root / "observables.h5"; }
  std::filesystem::path summary() const { return root / "summary.json"; }
  std::filesystem::path progress() const { return root / "progress.json"; }
  std::filesystem::path checkpoint() const { return root / "checkpoint.bin"; }
  std::filesystem::path previous_checkpoint() const { return root / "checkpoint.prev.bin"; }
  /// Both, the newer first.
  std::array<std::filesystem::path, 2> checkpoints() const { return {checkpoint(), previous_checkpoint()}; }
  std::filesystem::path trouble() const { return root / "trouble.json"; }
  /// Says where the rods of a run come from that begins with those of a file (run/import/).
  std::filesystem::path imported() const { return root / "imported.json"; }
  std::filesystem::path log() const { return root / "worker.log"; }
  std::filesystem::path movie() const { return root / "movie.mp4"; }
  std::filesystem::path lock() const { return root / "lock"; }
};

/// Sole ownership of a directory for as long as the object lives: flock(2) on DIR/lock, so it is never stale.
class DirectoryLock {
 public:
  /// Creates the lock file if need be. Fails with the owner's pid in the message if another process holds it.
  static Result<DirectoryLock> acquire(const std::filesystem::path& lock_file);
  /// Whether another process holds it just now; false where that cannot be told, as on a file system without locks.
  static bool is_held(const std::filesystem::path& lock_file);

 private:
  explicit DirectoryLock(Descriptor file) : file_(std::move(file)) {}
  Descriptor file_;  ///< the lock goes with it
};

}  // namespace shaken::run
