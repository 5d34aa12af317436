#pragma once

#include <chrono>
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "base/scratch_folder.h"

namespace shaken::client {

/// Answers requests on ROOT/shakend.sock with what was laid down for them. Everything else gets 404.
class FakeDaemon {
 public:
  struct Answer {
    int status = 200;
    std::string body;
    std::chrono::milliseconds delay{0};  ///< before it; others are answered meanwhile
  };
  struct Request {
    std::string line;  ///< "GET /v1/status"
    std::string body;
  };

  explicit FakeDaemon(const std::filesystem::path& root);
  FakeDaemon(const FakeDaemon&) = delete;
  FakeDaemon& operator=(const FakeDaemon&) = delete;
  ~FakeDaemon();

  /// `line` is "METHOD /path?query". Several answers are given one after the other, the last one for ever.
  void on(const std::string& line, std::vector<Answer> answers);
  void on(const std::string& line, const std::string& body) { on(line, {{200, body}}); }
  std::vector<Request> requests() const;

 private:
  struct Server;
  std::unique_ptr<Server> server_;
  mutable std::mutex mutex_;
  std::map<std::string, std::vector<Answer>> answers_;
  std::vector<Request> requests_;
};

}  // namespace shaken::client
