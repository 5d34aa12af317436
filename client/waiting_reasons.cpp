#include "client/waiting_reasons.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <set>

#include "client/live/target.h"

namespace shaken::client {
namespace {

/// What changes sooner is on its way.
constexpr std::chrono::seconds kStands{3};
constexpr std::chrono::minutes kIsOver{1};

bool is_digit(char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; }

std::string without_numbers(const std::string& text) {
  std::string rest;
  for (const char c : text) {
    if (!is_digit(c)) {
      rest += c;
    } else if (rest.empty() || rest.back() != '#') {
      rest += '#';
    }
  }
  return rest;
}

}  // namespace

std::vector<std::string> WaitingReasons::news(const std::vector<Json>& jobs, Clock::time_point now) {
  struct Group {
    std::string text;
    int n = 0;
  };
  std::map<std::string, Group> groups;
  for (const Json& job : jobs) {
    const std::string state = text_of(job, "state"), reason = text_of(job, "reason");
    if (reason.empty() || has_ended(job)) continue;
    const std::string text = (state == "running" ? "handed over" : state) + ": " + reason;
    Group& group = groups[without_numbers(text)];
    if (group.n++ == 0) group.text = text;
  }
  std::erase_if(seen_, [&](const auto& entry) { return now - entry.second.last >= kIsOver; });
  std::vector<std::string> lines;
  for (const auto& [key, group] : groups) {
    Reason& reason = seen_.try_emplace(key, Reason{now, now}).first->second;
    reason.last = now;
    if (reason.shown || now - reason.first < kStands) continue;
    reason.shown = true;
    lines.push_back(fmt::format("{} job{} {}", group.n, group.n == 1 ? "" : "s", group.text));
  }
  return lines;
}

}  // namespace shaken::client
