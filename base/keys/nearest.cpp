#include "base/keys/nearest.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <vector>

namespace shaken::keys {

namespace {

char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

}  // namespace

std::size_t edit_distance(std::string_view a, std::string_view b) {
  // Three rows of the table of distances between the first i letters of a and the first j of b.
  std::vector<std::size_t> before(b.size() + 1), last(b.size() + 1), row(b.size() + 1);
  std::iota(last.begin(), last.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const bool same = lower(a[i - 1]) == lower(b[j - 1]);
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, last[j - 1] + (same ? 0 : 1)});
      const bool swapped = i > 1 && j > 1 && lower(a[i - 1]) == lower(b[j - 2]) && lower(a[i - 2]) == lower(b[j - 1]);
      if (swapped) row[j] = std::min(row[j], before[j - 2] + 1);
    }
    before.swap(last);
    last.swap(row);
  }
  return last[b.size()];
}

std::string nearest(std::string_view word, std::span<const std::string> candidates) {
  if (word.size() > 100) return {};
  std::string best;
  std::size_t shortest = 0;
  for (const std::string& candidate : candidates) {
    // each letter that the one has more is an insertion: such a candidate is no nearer, and need not be compared
    const std::size_t at_least = std::max(word.size(), candidate.size()) - std::min(word.size(), candidate.size());
    if (!best.empty() && at_least >= shortest) continue;
    const std::size_t distance = edit_distance(word, candidate);
    if (best.empty() || distance < shortest) {
      best = candidate;
      shortest = distance;
    }
  }
  const std::size_t allowed = std::max<std::size_t>(1, std::max(word.size(), best.size()) / 3);
  return shortest <= allowed && shortest < best.size() ? best : std::string{};
}

std::string did_you_mean(std::string_view name) {
  return name.empty() ? std::string{} : fmt::format("; did you mean {}?", name);
}

}  // namespace shaken::keys
