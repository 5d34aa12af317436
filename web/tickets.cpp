#include "web/tickets.h"

#include <stdexcept>
#include <utility>

#include "web/guard.h"

namespace shaken::web {
namespace {

constexpr std::chrono::minutes kLast{1};

}  // namespace

std::string Tickets::give(const std::string& path, const std::multimap<std::string, std::string>& query) {
  Result<std::string> ticket = make_token();
  if (!ticket) throw std::runtime_error(ticket.error().message);
  const std::lock_guard lock(mutex_);
  const Clock::time_point now = now_();
  std::erase_if(given_, [&](const auto& entry) { return entry.second.end < now; });
  given_[*ticket] = {{.method = "GET", .path = path, .query = query, .body = ""}, now + kLast};
  return *ticket;
}

std::optional<http::Request> Tickets::take(const std::string& ticket) {
  const std::lock_guard lock(mutex_);
  auto node = given_.extract(ticket);
  if (node.empty() || node.mapped().end < now_()) return std::nullopt;
  return std::move(node.mapped().request);
}

}  // namespace shaken::web
