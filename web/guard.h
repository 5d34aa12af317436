#pragma once

#include <chrono>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "base/core/result.h"
#include "base/http/http_server.h"

namespace shaken::web {

/// A secret that nobody can guess: 32 hex digits, 128 random bits. Fails where the system has none.
Result<std::string> make_token();

/// Whether they are equal; takes as long for every `given` of the same length.
bool is_token(std::string_view given, std::string_view token);

/// Decides who is answered. Every user of the machine, and every web site that its browser has open, can send requests
/// to a port of 127.0.0.1; the token is what they do not know. The page carries it in a header of each request, not in
/// a cookie: browsers send cookies to every port of a machine.
class Guard {
 public:
  Guard(std::string token, int port) : token_(std::move(token)), port_(port) {}

  /// Why a request is not answered, as of its head; nothing if it may pass. It must
  /// - be addressed to 127.0.0.1 and this port. A name is refused (403): a web site may make its own point here, and
  ///   for localhost browsers may ask [::1] first, where another user can listen;
  /// - come from this page, or from no page, if it changes something (403);
  /// - carry "Authorization: Bearer TOKEN" (401), but for the page's own files, which anybody may read, and for what a
  ///   ticket has been given for.
  std::optional<http::TurnedAway> stop(const http::Request& head) const;

  /// The headers of every answer, refusals too: nothing but what is served here is loaded, run or asked; text that came
  /// from outside stays text.
  static const http::Headers& headers();

  /// What to open in a browser. The token is in a part of it that is not sent.
  std::string address() const;

 private:
  bool is_host(const std::string& host) const;

  std::string token_;
  int port_;
};

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
