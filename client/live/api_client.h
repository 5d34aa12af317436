#pragma once

#include <chrono>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "base/core/result.h"
#include "client/live/json.h"

namespace shaken::client {

/// Text of one segment of a URL's path, or of one value of its query.
std::string url_encoded(std::string_view text);

/// One entry of the daemon's list of problems: "file:line:column: path: message", without what is not known.
std::string problem_text(const Json& problem);

/// Requests to the daemon of one root directory (docs/protocol.md). An answer is waited for as long as the daemon
/// answers others: that to a submit of 100,000 runs takes minutes. Every function throws Failure: kNoDaemon if nobody
/// listens, kBadInput with the daemon's words (and the list of problems) for 4xx, kFailed for 5xx and for answers that
/// are not JSON objects.
class ApiClient {
 public:
  /// `patience`: for a daemon that answers nothing at all.
  explicit ApiClient(const std::filesystem::path& root, std::chrono::milliseconds patience = std::chrono::seconds(120));
  ApiClient(ApiClient&&) noexcept;
  ~ApiClient();

  Json get(const std::string& path);
  Json post(const std::string& path, const Json& body);
  /// As get, but the daemon's words where it answers 404.
  Result<Json> find(const std::string& path);

 private:
  struct Connection;
  std::unique_ptr<Connection> connection_;
};

}  // namespace shaken::client
