#pragma once

#include <chrono>
#include <filesystem>
#include <string>

namespace shaken::server {

/// What the daemon tells about itself; fixed once it is up.
struct DaemonInfo {
  std::string version;
  std::string host;
  int pid = 0;
  std::filesystem::path root;
  int slots = 1;  ///< workers that may run at once
  std::chrono::steady_clock::time_point started = std::chrono::steady_clock::now();

  std::string lcm_url;  ///< empty with --no-lcm
  bool lcm_ok = false;
  std::string lcm_message;  ///< why there is no live state; otherwise empty

  std::string relay_url;  ///< where LCM messages are handed on over TCP; empty: nowhere

  std::filesystem::path runs() const { return root / "runs"; }
  std::filesystem::path queue() const { return root / "queue.db"; }
  std::filesystem::path lock() const { return root / "shakend.lock"; }
  std::filesystem::path socket() const { return root / "shakend.sock"; }
  double uptime() const {  ///< [s]
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - started).count();
  }
};

}  // namespace shaken::server
