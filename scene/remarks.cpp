// SPDX-License-Identifier: MIT
#include "scene/remarks.h"

#include <fmt/format.h>

#include <string>

#include "scene/derived.h"
#include "scene/fields.h"
#include "scene/units.h"

namespace shaken::scene {

std::vector<std::string> remarks(const RunPlan& plan) {
  std::vector<std::string> list;
  const double total = plan.total_time();
  const auto remark_one_frame = [&](const char* path, double every) {
    if (every <= total) return;
    list.push_back(fmt::format("{} {} is longer than the run, {}: there will be a single frame, of the start", path,
                               format_quantity(every, Dimension::kTime), format_quantity(total, Dimension::kTime)));
  };
  if (plan.trajectory) remark_one_frame("trajectory.every", plan.trajectory->every);
  if (plan.movie) remark_one_frame("movie.every", plan.movie->every);
  for (const Field& field : fields()) {
    const std::string block(block_around(field.path));
    if (!block.starts_with("measure.") || field.path != block + ".every" ||
        !std::get<bool>(field_at(block).fetch(plan)) || std::get<double>(field.fetch(plan)) <= total) {
      continue;
    }
    list.push_back(fmt::format("{} {} is longer than the run, {}: there will be a single sample, of the start",
                               field.path, format_quantity(std::get<double>(field.fetch(plan)), Dimension::kTime),
                               format_quantity(total, Dimension::kTime)));
  }
  const auto gamma = gamma_of(plan.system);
  if (gamma && *gamma < 1 && plan.system.base) {
    list.push_back(
        fmt::format("plates.gamma is {:.4g}: below 1 the base never falls faster than the rods, which come "
                    "to rest on it",
                    *gamma));
  }
  return list;
}

}  // namespace shaken::scene
