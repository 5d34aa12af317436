// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

namespace shaken::server {

struct DaemonConfig {
  std::filesystem::path root;
  std::filesystem::path worker;          ///< the program that does one run
  int slots = 1;                         ///< workers that may run at once
  int threads = 1;                       ///< of each worker
  std::uint64_t keep_free = 64'000'000;  ///< bytes on the disk, below which no run is started
  std::string lcm_url;                   ///< empty: no live state
  std::optional<int> web_port;           ///< of the page in a browser; none: no page
  std::string log_level = "info";
  bool quiet = false;                       ///< log to ROOT/shakend.log only, not to stderr
  std::chrono::milliseconds grace{20'000};  ///< between the request that a worker stops and its kill
};

/// Runs the daemon until SIGTERM, SIGINT or SIGHUP; then its workers write a checkpoint and their jobs go back into the
/// queue. A second signal kills the workers. Prints "shakend ready: ROOT (pid N)" to stdout once the socket answers.
/// Throws Failure, with the reason in words, if it cannot start. Blocks signals in the calling thread.
void run_daemon(const DaemonConfig& config);

}  // namespace shaken::server
