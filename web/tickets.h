#pragma once

#include <chrono>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

#include "base/http/http_server.h"

namespace shaken::web {

/// Leave to fetch one thing once, within a minute, without the token: a browser that saves a file sends no header of
/// the page's. May be asked from many threads at once.
class Tickets {
 public:
  using Clock = std::chrono::steady_clock;
  explicit Tickets(std::function<Clock::time_point()> now = Clock::now) : now_(std::move(now)) {}

  /// The ticket for GET of `path` with `query`. Throws std::runtime_error if the system has no random numbers.
  std::string give(const std::string& path, const std::multimap<std::string, std::string>& query);
  /// What a ticket is for, the first time within its minute.
  std::optional<http::Request> take(const std::string& ticket);

 private:
  struct Given {
    http::Request request;
    Clock::time_point end;
  };
  std::function<Clock::time_point()> now_;
  std::mutex mutex_;
  std::map<std::string, Given> given_;
};

}  // namespace shaken::web
