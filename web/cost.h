#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <mutex>

#include "base/http/http_server.h"

namespace shaken::web {

/// What a scene or sweep would cost on this machine: `shaken submit --dry-run` steps a piece of some of its runs. That
/// takes some CPU-seconds, so it is done for one scene at a time. May be asked from many threads at once.
class CostEstimates {
 public:
  /// `client`: the program `shaken`. `limit`: for one estimate. `stop`: whether one that is made is to end.
  CostEstimates(std::filesystem::path client, std::chrono::milliseconds limit, std::function<bool()> stop)
      : client_(std::move(client)), limit_(limit), stop_(std::move(stop)) {}

  /// Of `{"text", "replicas"?}`, as JSON. 400: no such body; 422: no scene that can be run; 429: another one is being
  /// made; 504: it takes too long.
  http::Reply answer(const http::Request& request);

 private:
  std::filesystem::path client_;
  std::chrono::milliseconds limit_;
  std::function<bool()> stop_;
  std::mutex busy_;
};

}  // namespace shaken::web
