#include "base/keys/problem.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <unordered_set>
#include <utility>

namespace shaken::keys {

std::string to_string(const Problem& problem) {
  std::string text = problem.file;
  if (problem.line > 0) text += fmt::format(":{}:{}", problem.line, problem.column);
  text += ": ";
  if (!problem.path.empty()) text += problem.path + ": ";
  return text + problem.message;
}

std::string to_string(const std::vector<Problem>& problems) {
  std::string text;
  for (const Problem& problem : problems) text += to_string(problem) + "\n";
  return text;
}

nlohmann::ordered_json to_json(std::span<const Problem> problems) {
  auto list = nlohmann::ordered_json::array();
  for (const Problem& problem : problems) {
    list.push_back({{"file", problem.file},
                    {"line", problem.line},
                    {"column", problem.column},
                    {"path", problem.path},
                    {"message", problem.message}});
  }
  return list;
}

Problem problem_at(const Place& place, std::string_view path, std::string message) {
  std::string pointer;
  if (!path.empty()) {
    pointer = fmt::format("/{}", path);
    std::replace(pointer.begin(), pointer.end(), '.', '/');
  }
  return {place.file ? *place.file : std::string{}, place.line, place.column, std::move(pointer), std::move(message)};
}

std::vector<Problem> tidied(std::vector<Problem> problems) {
  std::vector<Problem> kept;
  std::unordered_set<std::string> seen;
  for (Problem& problem : problems) {
    if (seen.insert(to_string(problem)).second) kept.push_back(std::move(problem));
  }
  // Settings, which have no line, come after the file, in their order.
  std::stable_sort(kept.begin(), kept.end(), [](const Problem& a, const Problem& b) {
    if ((a.line == 0) != (b.line == 0)) return b.line == 0;
    return std::pair(a.line, a.column) < std::pair(b.line, b.column);
  });
  if (kept.size() > kMaxProblems) {
    const std::size_t n_more = kept.size() - kMaxProblems;
    kept.resize(kMaxProblems);
    kept.push_back({kept.front().file, 0, 0, {}, fmt::format("and {} more problems", n_more)});
  }
  return kept;
}

}  // namespace shaken::keys
