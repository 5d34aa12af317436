#include "server/queue/job.h"

#include <charconv>
#include <numeric>

namespace shaken::server {

std::int64_t JobCounts::total() const { return std::accumulate(n.begin(), n.end(), std::int64_t{0}); }

std::int64_t JobCounts::of(bool (*are_so)(JobState)) const {
  std::int64_t sum = 0;
  for (const JobState state : states_that(are_so)) sum += (*this)[state];
  return sum;
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
