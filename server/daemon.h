#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "proto/relay/address.h"

namespace shaken::server {

struct DaemonConfig {
  std::filesystem::path root;
  std::filesystem::path worker;                  ///< the program that does one run
  int slots = 1;                                 ///< workers that may run at once
  int threads = 1;                               ///< of each worker
  std::uint64_t keep_free = 64'000'000;          ///< bytes on the disk, below which no run is started
  bool slurm_is_default = false;                 ///< for sweeps that name no executor
  int max_pending = 100;                         ///< tasks that wait in Slurm's queue at most
  int runs_per_task = 1;                         ///< of Slurm, where a sweep does not say
  std::vector<std::string> slurm_options;        ///< of sbatch, for every batch
  std::chrono::milliseconds slurm_poll{10'000};  ///< from one question to Slurm to the next
  std::string lcm_url;                           ///< empty: no live state
  bool lcm_url_is_asked_for = false;             ///< by the user, so that no other one is taken in its place
  std::optional<relay::Address> relay;           ///< where LCM messages are handed on over TCP; none: nowhere
  std::optional<int> web_port;                   ///< of the page in a browser; none: no page
  std::string log_level = "info";
  bool quiet = false;                       ///< log to ROOT/shakend.log only, not to stderr
  std::chrono::milliseconds grace{20'000};  ///< between the request that a worker stops and its kill
};

/// Runs the daemon until SIGTERM, SIGINT or SIGHUP; then its workers write a checkpoint and their jobs go back into the
/// queue. A second signal kills the workers. Prints "shakend ready: ROOT (pid N)" to stdout once the socket answers.
/// Throws Failure, with the reason in words, if it cannot start. Blocks signals in the calling thread.
void run_daemon(const DaemonConfig& config);

}  // namespace shaken::server
