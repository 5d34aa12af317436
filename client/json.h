// SPDX-License-Identifier: MIT
#pragma once

#include <nlohmann/json.hpp>

namespace shaken::client {

/// Keeps the order of keys, so that `--json` prints what the daemon sent.
using Json = nlohmann::ordered_json;

}  // namespace shaken::client
