#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace shaken::client {

/// Keeps the order of keys, so that `--json` prints what the daemon sent.
using Json = nlohmann::ordered_json;

/// As `--json` prints it: indented, with a line break at the end. Characters that a terminal would obey are escaped.
std::string json_text(const Json& json);

}  // namespace shaken::client
