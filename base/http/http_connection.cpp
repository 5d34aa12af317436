#include "base/http/http_connection.h"

#include <poll.h>
#include <strings.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstring>

namespace shaken::http {
namespace {

using namespace std::chrono_literals;

constexpr std::size_t kLongestHead = std::size_t{64} << 10;  // of it, cpp-httplib takes 8 KiB for a line
constexpr std::size_t kLargestBody = std::size_t{16} << 20;
constexpr std::size_t kLongestPath = 1024;
constexpr auto kOneRead = 2s;     // until the next bytes of a request
constexpr auto kRequest = 5s;     // from the first to the last byte of a request
constexpr auto kOneWrite = 5s;    // until the client takes the next bytes of an answer
constexpr auto kAfterwards = 2s;  // for what a client still sends when it has its answer

bool is(const std::string& value, const char* word) { return strcasecmp(value.c_str(), word) == 0; }

/// The number of bytes that a head announces.
std::size_t content_length(const httplib::Request& request) {
  const std::string text = request.get_header_value("Content-Length");
  std::size_t length = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), length);
  const bool is_number = !text.empty() && end == text.data() + text.size() && error != std::errc::invalid_argument;
  if (!is_number || request.get_header_value_count("Content-Length") > 1) {
    throw UnreadableRequest(400, "Content-Length must be one number");
  }
  if (error == std::errc::result_out_of_range || length > kLargestBody) {
    throw UnreadableRequest(413, "the request is larger than 16 MiB");
  }
  return length;
}

}  // namespace

std::string error_body(const std::string& message) { return "{\"error\":\"" + message + "\"}\n"; }

HttpConnection::~HttpConnection() {
  ::shutdown(socket(), SHUT_WR);
  if (request_ended() || client_is_gone_) return;
  const auto end = Clock::now() + kAfterwards;
  while (wait(POLLIN, end) && recv(socket(), buffer_.data(), buffer_.size(), MSG_DONTWAIT) > 0) {
  }
}

bool HttpConnection::wait(short events, Clock::time_point end) const {
  for (;;) {
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(end - Clock::now());
    if (left <= 0ms) return false;  // even if the socket is ready: it may be so for ever
    pollfd watched{socket(), events, 0};
    const int ready = ::poll(&watched, 1, static_cast<int>(left.count()));
    if (ready >= 0 || errno != EINTR) return ready > 0;
  }
}

bool HttpConnection::is_of_own_user() const {
  ucred client{};
  socklen_t size = sizeof(client);
  const bool known = getsockopt(socket(), SOL_SOCKET, SO_PEERCRED, &client, &size) == 0;
  return known && (client.uid == geteuid() || client.uid == 0);
}

bool HttpConnection::next_request() {
  client_is_gone_ = begin_ == end_ && !wait(POLLIN, Clock::now() + kIdle);
  allowance_ = kLongestHead;
  in_body_ = chunked_ = false;
  request_end_ = Clock::now() + kRequest;
  answer_end_.reset();
  return !client_is_gone_;
}

void HttpConnection::head_ended(const httplib::Request& request) {
  if (request.path.size() > kLongestPath) throw UnreadableRequest(414, "the path is too long");
  // Decompressed, a body of any size would come out of a small one.
  if (request.has_header("Content-Encoding") && !is(request.get_header_value("Content-Encoding"), "identity")) {
    throw UnreadableRequest(415, "the body must not be compressed");
  }
  if (request.is_multipart_form_data()) {
    throw UnreadableRequest(415, "the body must be JSON, not multipart/form-data");
  }
  const bool has_length = request.has_header("Content-Length");
  const bool chunked = request.has_header("Transfer-Encoding");
  const bool only_chunked = request.get_header_value_count("Transfer-Encoding") == 1 &&
                            is(request.get_header_value("Transfer-Encoding"), "chunked");
  if (chunked && (!only_chunked || has_length)) {
    throw UnreadableRequest(400, "Transfer-Encoding must be chunked, without Content-Length");
  }
  // Of chunks, what frames them counts as well: it is read into memory too.
  allowance_ = chunked ? kLargestBody : has_length ? content_length(request) : 0;
  chunked_ = chunked;
  in_body_ = true;
}

void HttpConnection::refuse(const UnreadableRequest& problem, const Headers& headers) {
  const std::string body = error_body(problem.what());
  std::string answer = "HTTP/1.1 " + std::to_string(problem.status) +
                       " Refused\r\nConnection: close\r\nContent-Type: application/json\r\nContent-Length: " +
                       std::to_string(body.size()) + "\r\n";
  for (const auto& [name, value] : headers) answer += name + ": " + value + "\r\n";
  answer += "\r\n" + body;
  write(answer.data(), answer.size());
}

bool HttpConnection::is_readable() const {
  return begin_ < end_ || wait(POLLIN, std::min(Clock::now() + kOneRead, request_end_));
}

bool HttpConnection::is_writable() const {
  const auto end = Clock::now() + kOneWrite;
  return wait(POLLOUT, answer_end_ ? std::min(end, *answer_end_) : end);
}

ssize_t HttpConnection::read(char* bytes, std::size_t size) {
  if (allowance_ == 0) {
    throw in_body_ ? UnreadableRequest(413, "the request is larger than 16 MiB")
                   : UnreadableRequest(431, "the request's head is larger than 64 KiB");
  }
  if (!is_readable()) {
    client_is_gone_ = true;
    throw UnreadableRequest(408, "the request did not come in time");
  }
  if (begin_ == end_) {
    const ssize_t n = recv(socket(), buffer_.data(), buffer_.size(), MSG_DONTWAIT);
    if (n <= 0) {
      client_is_gone_ = true;
      return n;
    }
    begin_ = 0;
    end_ = static_cast<std::size_t>(n);
  }
  const std::size_t n = std::min({size, end_ - begin_, allowance_});
  std::memcpy(bytes, buffer_.data() + begin_, n);
  begin_ += n;
  allowance_ -= n;
  return static_cast<ssize_t>(n);
}

ssize_t HttpConnection::write(const char* bytes, std::size_t size) {
  if (!answer_end_) answer_end_ = Clock::now() + kAnswer;
  if (!is_writable()) return -1;
  const ssize_t n = send(socket(), bytes, size, MSG_NOSIGNAL | MSG_DONTWAIT);
  if (n > 0) *answer_end_ += std::chrono::microseconds(1'000'000 * n / static_cast<ssize_t>(kBytesPerSecond));
  return n;
}

}  // namespace shaken::http
