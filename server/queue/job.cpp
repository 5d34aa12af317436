#include "server/queue/job.h"

#include <charconv>
#include <numeric>

namespace shaken::server {
namespace {

constexpr std::array<std::string_view, kJobStates.size()> kWords{"queued", "held",   "running",   "stopping",
                                                                 "done",   "failed", "timed out", "cancelled"};

}  // namespace

std::string_view to_word(JobState state) { return kWords[static_cast<std::size_t>(state)]; }

std::optional<JobState> job_state(std::string_view word) {
  for (const JobState state : kJobStates) {
    if (to_word(state) == word) return state;
  }
  return std::nullopt;
}

bool has_ended(JobState state) {
  using enum JobState;
  return state == kDone || state == kFailed || state == kTimedOut || state == kCancelled;
}

std::int64_t JobCounts::total() const { return std::accumulate(n.begin(), n.end(), std::int64_t{0}); }

std::int64_t JobCounts::ended() const {
  return std::accumulate(
      kJobStates.begin(), kJobStates.end(), std::int64_t{0},
      [this](std::int64_t sum, JobState state) { return sum + (has_ended(state) ? (*this)[state] : 0); });
}

std::string sweep_word(std::int64_t id) { return std::string("s").append(std::to_string(id)); }

std::optional<std::int64_t> sweep_number(std::string_view word) {
  if (word.size() < 2 || word.front() != 's') return std::nullopt;
  std::int64_t id = 0;
  std::from_chars(word.data() + 1, word.data() + word.size(), id);
  return id > 0 && sweep_word(id) == word ? std::optional(id) : std::nullopt;  // "s022" may be a name
}

std::string to_word(const Target& target) {
  const std::int64_t* sweep = std::get_if<std::int64_t>(&target);
  return sweep != nullptr ? sweep_word(*sweep) : std::get<std::string>(target);
}

Target target_named(const std::string& word) {
  const auto sweep = sweep_number(word);
  return sweep ? Target(*sweep) : Target(word);
}

}  // namespace shaken::server
