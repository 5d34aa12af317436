// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "sim/core/result.h"

namespace shaken::run {

/// Replaces `file` by `content` so that a reader, or a crash at any instant, sees the old file or the new, never a
/// mixture: writes FILE.tmp, fsync, rename, fsync of the folder. Returns the reason if the disk refuses.
[[nodiscard]] std::optional<Error> write_file_atomically(const std::filesystem::path& file, std::string_view content);

/// The whole file, or why it cannot be read.
Result<std::string> read_file(const std::filesystem::path& file);

}  // namespace shaken::run
