#pragma once

#include <string>
#include <string_view>

#include "base/core/result.h"

namespace shaken::web {

/// A secret that nobody can guess: 32 hex digits, 128 random bits. Fails where the system has none.
Result<std::string> make_token();

/// Whether they are equal; takes as long for every `given` of the same length.
bool is_token(std::string_view given, std::string_view token);

}  // namespace shaken::web
