#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace shaken::http {

using Headers = std::vector<std::pair<std::string, std::string>>;

/// What was asked.
struct Request {
  std::string method;
  std::string path;
  std::multimap<std::string, std::string> query;
  std::string body;
  std::multimap<std::string, std::string> headers = {};  ///< names in lower case

  /// The first value of a header or of the query; empty where there is none.
  std::string header(const std::string& name) const;
  std::string parameter(const std::string& name) const;
};

/// Why a request is not answered: the status, and a sentence without characters that JSON escapes.
struct TurnedAway {
  int status = 403;
  std::string reason;
};

/// What is answered.
struct Reply {
  int status = 200;
  std::string body = {};
  std::string allow = {};                 ///< methods that the path has; with status 405
  std::string type = "application/json";  ///< of the body
  Headers headers = {};
  /// In place of `body`: one piece after the other, until nothing comes; what it throws breaks the connection, so that
  /// nobody takes a part for the whole. It may wait for a second or so, and must end
  /// before an answer may take no longer (HttpConnection::kAnswer). Called from one thread.
  std::function<std::optional<std::string>()> stream = {};
};

/// HTTP that slow, broken or hostile clients cannot stop: requests and answers have limits of size and time
/// (base/http/http_connection.h), and each connection a thread of its own.
class HttpServer {
 public:
  /// Called from many threads at once; must not throw.
  using Handler = std::function<Reply(const Request&)>;

  /// Answers from now on, on a Unix socket of mode 0600; whoever connects must be this process's user or root. A socket
  /// file that is there already is replaced: the caller holds the directory's lock. Throws Failure with the reason if
  /// the socket cannot be made.
  HttpServer(std::filesystem::path socket, Handler handler);
  /// Looks at a request when only its head is there; a request that it refuses has no body read.
  using Gate = std::function<std::optional<TurnedAway>(const Request& head)>;
  /// The same on a port of 127.0.0.1 (0: any that is free), where every user of this machine may ask. `headers` are
  /// those of every answer, also where it is a refusal. Throws Failure if the port is taken.
  HttpServer(int port, Gate gate, Handler handler, const Headers& headers = {});
  /// Waits for every connection to end.
  ~HttpServer();
  /// The port of 127.0.0.1 at which it listens.
  int port() const;
  /// Whether clients find it: its socket file, if it has one, is still there, and still its own.
  bool is_reachable() const;
  /// Whether the system has ended its listening, as it does where an accept() fails: nobody new is answered any more,
  /// those who are connected are to the end of their request.
  bool has_failed() const;
  /// Accepts nothing any more and removes the socket file; returns at once.
  void close();
  /// After close(): whether every connection has ended within the time.
  bool ended_within(std::chrono::milliseconds timeout);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace shaken::http
