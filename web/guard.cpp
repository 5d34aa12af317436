#include "web/guard.h"

#include <string_view>

#include "web/token.h"

namespace shaken::web {
namespace {

bool is_open(const std::string& path) {
  return path == "/" || path == "/chart.js" || path.starts_with("/page/") || path.starts_with("/tickets/");
}

}  // namespace

std::string Guard::address() const { return "http://127.0.0.1:" + std::to_string(port_) + "/#token=" + token_; }

bool Guard::is_host(const std::string& host) const { return host == "127.0.0.1:" + std::to_string(port_); }

const http::Headers& Guard::headers() {
  static const http::Headers kHeaders{{"Content-Security-Policy",
                                       "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' blob:; "
                                       "media-src 'self' blob:; connect-src 'self'; "
                                       "base-uri 'none'; form-action 'none'; frame-ancestors 'none'"},
                                      {"X-Content-Type-Options", "nosniff"},
                                      {"Referrer-Policy", "no-referrer"},
                                      {"Cross-Origin-Resource-Policy", "same-origin"},
                                      {"Cache-Control", "no-store"}};
  return kHeaders;
}

std::optional<http::TurnedAway> Guard::stop(const http::Request& head) const {
  static constexpr std::string_view kBearer = "Bearer ";
  if (!is_host(head.header("host"))) {
    return http::TurnedAway{403, "this page is at 127.0.0.1:" + std::to_string(port_) + " only"};
  }
  const bool reads = head.method == "GET" || head.method == "HEAD";
  const std::string origin = head.header("origin");
  if (!reads && !origin.empty() && !(origin.starts_with("http://") && is_host(origin.substr(7)))) {
    return http::TurnedAway{403, "this comes from another page"};
  }
  if (reads && is_open(head.path)) return std::nullopt;
  const std::string authorization = head.header("authorization");
  if (authorization.starts_with(kBearer) && is_token(std::string_view(authorization).substr(kBearer.size()), token_)) {
    return std::nullopt;
  }
  return http::TurnedAway{401,
                          "open the address that `shaken web` prints: it ends in #token=... and changes whenever "
                          "the page's program is started"};
}

}  // namespace shaken::web
