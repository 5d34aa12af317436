// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>

namespace shaken::server {

/// What was asked.
struct Request {
  std::string method;
  std::string path;
  std::multimap<std::string, std::string> query;
  std::string body;
};

/// What is answered; the body is a JSON object.
struct Reply {
  int status = 200;
  std::string body;
  std::string allow;  ///< methods that the path has; with status 405
};

/// HTTP on a Unix socket (mode 0600; whoever connects must be this process's user or root) that slow, broken or hostile
/// clients cannot stop: requests and answers have limits of size and time (server/http_connection.h), and each
/// connection a thread of its own.
class HttpServer {
 public:
  /// Called from many threads at once; must not throw.
  using Handler = std::function<Reply(const Request&)>;

  /// Answers from now on. A socket file that is there already is replaced: the caller holds the directory's lock.
  /// Throws Failure with the reason if the socket cannot be made.
  HttpServer(std::filesystem::path socket, Handler handler);
  /// Waits for every connection to end.
  ~HttpServer();
  /// Whether clients find it: its socket file is still there, and still its own.
  bool is_reachable() const;
  /// Accepts nothing any more and removes the socket file; returns at once.
  void close();
  /// After close(): whether every connection has ended within the time.
  bool ended_within(std::chrono::milliseconds timeout);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace shaken::server
