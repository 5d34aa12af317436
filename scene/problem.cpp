// SPDX-License-Identifier: MIT
#include "scene/problem.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

namespace shaken::scene {

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

}  // namespace shaken::scene
