#include "run/import/refusal.h"

#include <fmt/format.h>

#include <iostream>
#include <nlohmann/json.hpp>

namespace shaken::run {

ExitCode refuse(const std::string& file, const std::vector<keys::Problem>& problems, bool json) {
  if (json) {
    std::cout << nlohmann::ordered_json{{"ok", false}, {"problems", keys::to_json(problems)}}.dump(2) << "\n";
    return ExitCode::kBadInput;
  }
  std::string all = to_string(problems);
  all.pop_back();  // the end of the last line
  throw Failure(ExitCode::kBadInput, fmt::format("{} is refused:\n{}", file, all));
}

}  // namespace shaken::run
