#pragma once

#include <httplib.h>

#include <array>
#include <chrono>
#include <cstddef>
#include <optional>
#include <stdexcept>
#include <string>

#include "base/descriptor.h"
#include "base/http/http_server.h"

namespace shaken::http {

/// A request that cannot be read, or takes more than a request may: the status of its answer, and a sentence.
struct UnreadableRequest : std::runtime_error {
  UnreadableRequest(int answer_status, const std::string& reason) : std::runtime_error(reason), status(answer_status) {}
  int status;
};

/// The body of an answer that says what is wrong. `message` has no characters that JSON escapes.
std::string error_body(const std::string& message);

/// One client's socket, as cpp-httplib reads and writes it. Everything that a request may take is counted here, where
/// its bytes come in: cpp-httplib bounds only a body that tells its length beforehand, and only the time of one read.
class HttpConnection final : public httplib::Stream {
 public:
  /// How long a connection may be silent between two requests, and before the first.
  static constexpr std::chrono::seconds kIdle{1};
  /// From the first to the last byte of an answer; and a second more for so many bytes that the client has taken.
  static constexpr std::chrono::seconds kAnswer{60};
  static constexpr std::size_t kBytesPerSecond = 100'000;

  explicit HttpConnection(int socket) : socket_(socket) {}
  /// Closes. What the client is still sending is read first, for a while: it would not see its answer otherwise.
  ~HttpConnection() override;

  /// Whether its client was this process's user, or root, when it connected: the second guard behind the socket's mode.
  bool is_of_own_user() const;
  /// Waits until a request begins, and starts to count what it takes; false if none comes.
  bool next_request();
  /// To be called between head and body: says how large the body may be. Throws UnreadableRequest if the head asks for
  /// what is not offered here: bodies that are too large, compressed or of several parts.
  void head_ended(const httplib::Request& request);
  /// Whether the request has been read to its end, so that another one may follow.
  bool request_ended() const { return in_body_ && !chunked_ && allowance_ == 0; }
  /// Answers a request that cpp-httplib could not get through with; the connection must not be used any further.
  void refuse(const UnreadableRequest& problem, const Headers& headers);

  bool is_readable() const override;
  bool is_writable() const override;
  /// Throws UnreadableRequest where the request becomes too large or too slow.
  ssize_t read(char* bytes, std::size_t size) override;
  ssize_t write(const char* bytes, std::size_t size) override;
  void get_remote_ip_and_port(std::string&, int&) const override {}  // a Unix socket has neither
  void get_local_ip_and_port(std::string&, int&) const override {}
  int socket() const override { return socket_.value(); }

 private:
  using Clock = std::chrono::steady_clock;
  /// Waits for the socket, no longer than until `end`; false if it is not ready before.
  bool wait(short events, Clock::time_point end) const;

  Descriptor socket_;
  std::array<char, 4096> buffer_{};
  std::size_t begin_ = 0, end_ = 0;  ///< what of the buffer has not been taken yet
  std::size_t allowance_ = 0;        ///< bytes that the head, or the body, may still have
  bool in_body_ = false;
  bool chunked_ = false;
  bool client_is_gone_ = false;  ///< it sends nothing any more, or not fast enough
  Clock::time_point request_end_;
  std::optional<Clock::time_point> answer_end_;
};

}  // namespace shaken::http
