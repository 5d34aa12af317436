// SPDX-License-Identifier: MIT
#pragma once

#include <sys/types.h>

#include <filesystem>

namespace shaken::client {

/// A daemon for as long as it is needed. Where one already serves the root directory, that one is used and left alone.
class OwnDaemon {
 public:
  /// Starts shakend for `root` unless somebody listens there. Throws Failure if it does not come up within 20 s.
  explicit OwnDaemon(const std::filesystem::path& root);
  OwnDaemon(const OwnDaemon&) = delete;
  OwnDaemon& operator=(const OwnDaemon&) = delete;
  /// Stops the daemon in order, if it was started here: running jobs write their checkpoints.
  ~OwnDaemon();

  bool started_here() const { return pid_ != 0; }

 private:
  pid_t pid_ = 0;
};

}  // namespace shaken::client
