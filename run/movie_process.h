// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <filesystem>

#include "sim/core/result.h"

namespace shaken::run {

/// Runs `shaken-render movie DIR`, found beside this program, and waits for it. Ends it when `stop` becomes true, or
/// with this process. Returns why there is no movie.
Result<void> render_movie(const std::filesystem::path& directory, const std::atomic<bool>& stop);

}  // namespace shaken::run
