// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

#include "bench/report.h"

namespace shaken::bench {

/// convergence.png: errors against the step; work_precision.png: against CPU time. A panel for each case.
void draw_convergence(const std::filesystem::path& folder, const Report& report);
/// bias.png and tilt.png of steps, model.png of the other knobs.
void draw_statistics(const std::filesystem::path& folder, const Report& report);
/// error.png: the error of S against simulated time and against CPU time.
void draw_order_error(const std::filesystem::path& folder, const Report& report);

}  // namespace shaken::bench
