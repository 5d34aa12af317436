#include "web/guard.h"

#include <sys/random.h>

#include <array>
#include <stdexcept>
#include <utility>

#include "base/descriptor.h"

namespace shaken::web {
namespace {

bool is_open(const std::string& path) {
  return path == "/" || path == "/chart.js" || path.starts_with("/page/") || path.starts_with("/tickets/");
}

constexpr std::chrono::minutes kTicketLasts{1};

}  // namespace

Result<std::string> make_token() {
  std::array<unsigned char, 16> random{};
  if (getrandom(random.data(), random.size(), 0) != static_cast<ssize_t>(random.size())) {
    return system_error("the system gives no random numbers");
  }
  std::string token;
  for (const unsigned char byte : random) {
    token += "0123456789abcdef"[byte >> 4];
    token += "0123456789abcdef"[byte & 15];
  }
  return token;
}

bool is_token(std::string_view given, std::string_view token) {
  if (given.size() != token.size()) return false;
  unsigned different = 0;
  for (std::size_t i = 0; i < token.size(); ++i) {
    different |= static_cast<unsigned>(static_cast<unsigned char>(given[i]) ^ static_cast<unsigned char>(token[i]));
  }
  return different == 0;
}

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

std::string Tickets::give(const std::string& path, const std::multimap<std::string, std::string>& query) {
  Result<std::string> ticket = make_token();
  if (!ticket) throw std::runtime_error(ticket.error().message);
  const std::lock_guard lock(mutex_);
  const Clock::time_point now = now_();
  std::erase_if(given_, [&](const auto& entry) { return entry.second.end < now; });
  given_[*ticket] = {{.method = "GET", .path = path, .query = query, .body = ""}, now + kTicketLasts};
  return *ticket;
}

std::optional<http::Request> Tickets::take(const std::string& ticket) {
  const std::lock_guard lock(mutex_);
  auto node = given_.extract(ticket);
  if (node.empty() || node.mapped().end < now_()) return std::nullopt;
  return std::move(node.mapped().request);
}

}  // namespace shaken::web
