#include "run/measure/measurement_kinds.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <sstream>

#include "run/files/recorded_frames.h"
#include "scene/keys/fields.h"
#include "scene/keys/observables.h"

namespace shaken::run {

std::span<const MeasurementKind> measurement_kinds() {
#define SHAKEN_KIND(name, Settings) name##_kind(),
  static const std::vector<MeasurementKind> kinds{SHAKEN_OBSERVABLES(SHAKEN_KIND)};
#undef SHAKEN_KIND
  return kinds;
}

namespace {
constexpr std::array<std::string_view, 7> kNeeds{"impacts",
                                                 "angular velocities",
                                                 "velocities",
                                                 "tilts out of the plane",
                                                 kFollowedRods,
                                                 "every rod in every frame",
                                                 "heads (all rods point to one half of the plane)"};  // as in Needs
constexpr std::string_view kBetweenNeeds = ", ";
}  // namespace

std::string_view word_of(Needs need) { return kNeeds.at(static_cast<std::size_t>(need)); }

std::string words_of(const Lacking& lacking) {
  std::string words;
  for (const Needs need : lacking) words += std::string(words.empty() ? "" : kBetweenNeeds).append(word_of(need));
  return words;
}

Lacking lacking_of(std::string_view words) {
  Lacking lacking;
  while (!words.empty()) {
    const std::size_t end = std::min(words.find(kBetweenNeeds), words.size());
    const auto* const need = std::ranges::find(kNeeds, words.substr(0, end));
    if (need != kNeeds.end()) lacking.insert(static_cast<Needs>(need - kNeeds.begin()));
    words.remove_prefix(std::min(end + kBetweenNeeds.size(), words.size()));
  }
  return lacking;
}

std::optional<double> MeasurementKind::every(const scene::RunPlan& plan) const {
  return scene::observable(name).period(plan);
}

std::optional<Cadence> MeasurementKind::cadence(const scene::RunPlan& plan) const {
  const std::optional<double> period = every(plan);
  if (!period) return std::nullopt;
  const System& system = plan.system;
  if (scene::observable(name).is_spread(plan)) return Cadence::spread(*period, system.dt, system.seed);
  return Cadence(*period, system.dt);
}

namespace {

/// "tracks/" of "tracks/span_s".
std::string_view group_of(std::string_view array) { return array.substr(0, array.find_last_of('/') + 1); }

/// What `array`, or an axis, is said to be measured at.
std::vector<std::string> listed_axes(const MeasurementKind& kind, std::string_view array) {
  const auto said = [&](std::string_view of) {
    return std::ranges::find(kind.axes, of, [](auto& row) { return row.first; });
  };
  auto found = said(array);
  if (found == kind.axes.end()) found = said(group_of(array));
  if (found == kind.axes.end()) {
    return {
        std::string(std::ranges::find(kind.arrays, group_of(array), [](auto& a) { return group_of(a.name); })->name)};
  }
  std::istringstream names{std::string(found->second)};
  return {std::istream_iterator<std::string>(names), {}};
}

}  // namespace

std::vector<std::string> MeasurementKind::axes_of(std::string_view array) const {
  for (const Output& other : arrays) {
    const std::vector<std::string> its_axes = listed_axes(*this, other.name);
    if (std::ranges::find(its_axes, array) != its_axes.end()) return {};
  }
  return listed_axes(*this, array);
}

std::string MeasurementKind::meaning(const Output& output) const {
  if (output.over.empty()) return std::string(output.meaning);
  return fmt::format("{}; over {}`measure.{}.{}`", output.meaning,
                     output.times > 1 ? fmt::format("{} × ", output.times) : "", name, output.over);
}

double MeasurementKind::time_over(const Output& output, const scene::RunPlan& plan, double interval) const {
  if (output.over.empty()) return std::numeric_limits<double>::quiet_NaN();
  const scene::Field& key = scene::field_at(fmt::format("measure.{}.{}", name, output.over));
  return output.times * std::max(1.0, std::round(std::get<double>(key.fetch(plan)) / interval)) * interval;
}

scene::RunPlan only(scene::RunPlan plan, const MeasurementKind& kind) {
  plan.steady = 0;
  for (const scene::Observable& other : scene::observables()) {
    if (other.name != kind.name) other.switch_off(plan);
  }
  return plan;
}

}  // namespace shaken::run
