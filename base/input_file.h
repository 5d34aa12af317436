// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <filesystem>
#include <istream>
#include <string>

#include "sim/core/result.h"

namespace shaken {

/// A scene has no more: as much as a request to the daemon may have.
constexpr std::size_t kMostSceneBytes = std::size_t{16} << 20;

/// The whole of a file that a user names, or why it cannot be read. Fails at `most` bytes: it may be a device, a pipe
/// or a file of quite another kind.
Result<std::string> read_input_file(const std::filesystem::path& file, std::size_t most = kMostSceneBytes);
/// The same of what comes through `in`, which messages call `name`.
Result<std::string> read_input(std::istream& in, const std::string& name, std::size_t most = kMostSceneBytes);

}  // namespace shaken
