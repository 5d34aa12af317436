#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "base/text.h"

namespace shaken::client {

/// Keeps the order of keys, so that `--json` prints what the daemon sent.
using Json = nlohmann::ordered_json;

/// As `--json` prints it: indented, with a line break at the end. Characters that a terminal would obey are escaped.
inline std::string json_text(const Json& json) {
  // printable() escapes as JSON does; what is no UTF-8 has no form in JSON.
  return printable(json.dump(2, ' ', false, Json::error_handler_t::replace), Lines::kMany) + "\n";
}

}  // namespace shaken::client
