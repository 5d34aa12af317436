// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "sim/core/result.h"

namespace shaken::web {

/// The secret that opens the page: 32 hex digits, 128 random bits, in ROOT/web.token (mode 0600). It is made where
/// there is none, and stays: a bookmark goes on working. Remove the file to lock out whoever knows it. Fails where the
/// file cannot be read or made, or does not hold a token.
Result<std::string> read_or_make_token(const std::filesystem::path& root);

/// Whether they are equal; takes as long for every `given` of the same length.
bool is_token(std::string_view given, std::string_view token);

}  // namespace shaken::web
