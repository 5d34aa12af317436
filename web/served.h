// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>

namespace shaken::web {

/// Whether the page of this root directory is already served at `port`, by another shaken-web with the same token.
bool is_served(const std::filesystem::path& root, int port, const std::string& token);

}  // namespace shaken::web
