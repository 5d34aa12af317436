#pragma once

#include <chrono>
#include <cstdint>
#include <string>

namespace shaken::relay {

/// Warnings about clients for the log, one in ten seconds at most: a client that comes again and again must not fill
/// it.
class ClientWarnings {
 public:
  void note(const std::string& what, std::chrono::steady_clock::time_point now);

 private:
  std::chrono::steady_clock::time_point next_{};
  std::int64_t kept_back_ = 0;
};

}  // namespace shaken::relay
