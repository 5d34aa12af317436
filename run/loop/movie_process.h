#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <string>

#include "base/core/result.h"

namespace shaken::run {

/// Takes the share of the film that is drawn, in [0, 1], and the wall seconds to its end (negative where unknown).
using OnDrawn = std::function<void(double drawn, double eta)>;

/// Runs `shaken-render movie DIR`, found beside this program, and waits for it. Ends it when `stop` becomes true, or
/// with this process. `label` says in the film what makes the run different; `on_drawn`, if there is one, is called now
/// and then, and when the film is drawn. Returns why there is no movie.
Result<void> render_movie(const std::filesystem::path& directory, const std::atomic<bool>& stop,
                          const std::string& label = "", const OnDrawn& on_drawn = {});

}  // namespace shaken::run
