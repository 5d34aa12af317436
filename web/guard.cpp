// SPDX-License-Identifier: MIT
#include "web/guard.h"

#include <string_view>
#include <utility>

#include "web/token.h"

namespace shaken::web {
namespace {

/// The value of `name` in a Cookie header, "a=1; b=2"; empty if it is not there.
std::string_view cookie(std::string_view header, std::string_view name) {
  while (!header.empty()) {
    std::string_view pair = header.substr(0, header.find(';'));
    header.remove_prefix(std::min(pair.size() + 1, header.size()));
    while (pair.starts_with(' ')) pair.remove_prefix(1);
    if (pair.starts_with(name) && pair.substr(name.size()).starts_with('=')) return pair.substr(name.size() + 1);
  }
  return {};
}

server::Reply refused(int status, const std::string& sentence) {
  return {.status = status, .body = sentence + "\n", .type = "text/plain; charset=utf-8"};
}

}  // namespace

Guard::Guard(std::string token, int port) : token_(std::move(token)), port_(port) {}

std::string Guard::address() const { return "http://127.0.0.1:" + std::to_string(port_) + "/?token=" + token_; }

bool Guard::is_host(const std::string& host) const {
  const std::string port = ":" + std::to_string(port_);
  return host == "127.0.0.1" + port || host == "localhost" + port;
}

bool Guard::knows_token(const server::Request& request) const {
  static constexpr std::string_view kBearer = "Bearer ";
  const std::string authorization = request.header("authorization"), cookies = request.header("cookie");
  return is_token(cookie(cookies, cookie_name()), token_) ||
         (authorization.starts_with(kBearer) &&
          is_token(std::string_view(authorization).substr(kBearer.size()), token_));
}

std::optional<server::Reply> Guard::stop(const server::Request& request) const {
  if (!is_host(request.header("host"))) {
    return refused(403, "this page is at 127.0.0.1:" + std::to_string(port_) + " only");
  }
  const bool reads = request.method == "GET" || request.method == "HEAD";
  const std::string origin = request.header("origin");
  if (!reads && !origin.empty() && !(origin.starts_with("http://") && is_host(origin.substr(7)))) {
    return refused(403, "this comes from another page");
  }
  const std::string given = request.parameter("token");
  if (request.path == "/" && reads && is_token(given, token_)) {
    return server::Reply{
        .status = 303,
        .body = "",
        .type = "text/plain",
        .headers = {{"Location", "/"},
                    {"Set-Cookie", cookie_name() + "=" + token_ + "; Path=/; HttpOnly; SameSite=Strict"}}};
  }
  if (knows_token(request)) return std::nullopt;
  return refused(401, given.empty()
                          ? "open the address that shaken-web has printed: it ends in ?token=... (`shaken web` "
                            "prints it again)"
                          : "this token is not, or no longer, the right one: `shaken web` prints the address");
}

}  // namespace shaken::web
