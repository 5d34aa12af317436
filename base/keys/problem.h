#pragma once

#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/core/result.h"

namespace shaken::keys {

/// Where something was written.
struct Place {
  std::shared_ptr<const std::string> file;  ///< name of the file, or "-s path=value" for a setting
  int line = 0;                             ///< from 1; 0 where lines mean nothing (settings)
  int column = 0;                           ///< from 1, in characters
};

/// One thing wrong with what the user wrote.
struct Problem {
  std::string file;
  int line = 0;
  int column = 0;
  std::string path;     ///< JSON pointer, "/rods/length"; empty for the text as a whole
  std::string message;  ///< what was met, what is allowed, and the nearest name

  friend bool operator==(const Problem&, const Problem&) = default;
};

/// "run.json:12:9: /rods/length: 450 mm is outside [0.5, 50] mm; did you mean 4.5 mm?"
std::string to_string(const Problem& problem);

/// All of them, one a line.
std::string to_string(const std::vector<Problem>& problems);

/// A list of objects with "file", "line", "column", "path" and "message", as the daemon's answers have it.
nlohmann::ordered_json to_json(std::span<const Problem> problems);

/// The problem `message` with what stands at `place`; `path` is dotted ("rods.length").
Problem problem_at(const Place& place, std::string_view path, std::string message);

/// As many problems are told, and the number of the others.
inline constexpr std::size_t kMaxProblems = 100;

/// What `suggest()` finds, which takes its time; nothing if so many problems are known that this one is hardly told.
template <class Suggest>
std::string suggestion(const std::vector<Problem>& problems, Suggest suggest) {
  return problems.size() < kMaxProblems ? suggest() : std::string{};
}

/// In the order of the text, each once, and kMaxProblems at most.
std::vector<Problem> tidied(std::vector<Problem> problems);

/// A value read from a text, or everything that is wrong with the text: in its order, each once.
template <class T>
using Loaded = Result<T, std::vector<Problem>>;

}  // namespace shaken::keys
