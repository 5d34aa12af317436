#pragma once

#include <chrono>
#include <filesystem>
#include <string>
#include <utility>

#include "base/core/result.h"
#include "base/http/http_server.h"

namespace shaken::web {

/// Hands requests on to the daemon of a root directory, by its socket, and its answers back as they are.
class DaemonLink {
 public:
  /// `patience`: how long an answer may take; what is asked waits for the disk at times.
  explicit DaemonLink(std::filesystem::path root, std::chrono::seconds patience = std::chrono::seconds(50))
      : root_(std::move(root)), patience_(patience) {}
  /// The daemon's answer; 503 with the reason if there is none. May be called from many threads at once.
  http::Reply ask(const http::Request& request) const;
  /// The body of GET `path`, or why there is none.
  Result<std::string> get(const std::string& path) const;

 private:
  std::filesystem::path root_;
  std::chrono::seconds patience_;
};

}  // namespace shaken::web
