#include "server/queue/terms.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

namespace shaken::server {
namespace {

constexpr std::int64_t kLeastEnded = 5;

std::int64_t n_ended(const JobCounts& counts) { return counts[JobState::kDone] + counts.of(has_failed); }

}  // namespace

Result<StopRule> StopRule::parse(std::string_view text) {
  const Error wrong{
      fmt::format("'{}' is no rule to stop: write \"failed>10%\", or \"failed>3\" for a number of jobs", text)};
  std::string word(text);
  std::erase(word, ' ');
  constexpr std::string_view kStart = "failed>";
  if (!word.starts_with(kStart)) return wrong;
  word.erase(0, kStart.size());
  const bool is_percentage = word.ends_with('%');
  if (is_percentage) word.pop_back();
  double most = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), most, std::chars_format::fixed);
  if (error != std::errc() || end != word.data() + word.size() || std::signbit(most)) return wrong;
  constexpr double kMostJobs = 1e9;
  if (is_percentage ? most >= 100 : (most > kMostJobs || most != std::floor(most))) return wrong;
  return StopRule(most, is_percentage);
}

std::string StopRule::text() const { return fmt::format("failed>{}{}", most_, is_percentage_ ? "%" : ""); }

bool StopRule::is_broken(const JobCounts& counts) const {
  const auto failed = static_cast<double>(counts[JobState::kFailed]);
  if (!is_percentage_) return failed > most_;
  return n_ended(counts) >= kLeastEnded && 100 * failed > most_ * static_cast<double>(n_ended(counts));
}

std::string StopRule::reason(const JobCounts& counts) const {
  return fmt::format("{}: {} of {} jobs that ended have failed", text(), counts[JobState::kFailed], n_ended(counts));
}

}  // namespace shaken::server
