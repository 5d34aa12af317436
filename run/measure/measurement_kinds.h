// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "run/cadence.h"
#include "run/measure/measurement.h"

namespace shaken::run {

/// One array of observables.h5, or one number of summary.json.
struct Output {
  std::string_view name;     ///< ends in the unit; of an array: its path below "/NAME/"
  std::string_view meaning;  ///< for the pages
  bool has_error = false;    ///< of an array: whether there is one with `_sem` as well (every number has an error)
  /// Of a number: why it has no value where it has none and the measurement says no more.
  std::string_view if_none = "too few samples, or too short a run";
  /// The key of its block that sets the time over which it is taken, where its value depends on that ("window"), and
  /// how many such times.
  std::string_view over = {};
  int times = 1;
};
inline constexpr bool kWithError = true;

/// `output`, whose value depends on the time over which it is taken (Output::over).
constexpr Output over(std::string_view key, Output output, int times = 1) {
  output.over = key;
  output.times = times;
  return output;
}

/// One thing that can be measured, the block "measure.NAME" of a scene, and all that becomes of it.
struct MeasurementKind {
  std::string_view name;     ///< as in scene/observables.cpp
  std::string_view sources;  ///< files of analysis/, "tilt, tilt_summary"
  std::unique_ptr<Measurement> (*make)(const MeasureContext&) = nullptr;
  std::vector<Output> arrays = {};
  std::vector<Output> numbers = {};
  /// Names of arrays and numbers that need an axis, where others of the same measurement do not: spheres lack them.
  std::vector<std::string_view> of_axis = {};
  /// Whether samples are spread over their intervals, because they depend on the phase of the vibration; null: no.
  bool (*is_spread)(const scene::RunPlan&) = nullptr;

  /// The period asked for [s]; none: it is not measured (Observable::period).
  std::optional<double> every(const scene::RunPlan& plan) const;
  /// When samples are taken; none: it is not measured.
  std::optional<Cadence> cadence(const scene::RunPlan& plan) const;

  /// For the pages: the meaning, and the key that sets the time over which it is taken.
  std::string meaning(const Output& output) const;
  /// That time with `interval` between samples, a multiple of it [s]; NaN if the value depends on no such time.
  double time_over(const Output& output, const scene::RunPlan& plan, double interval) const;
};

/// All of them, in the order in which they sample and are saved.
std::span<const MeasurementKind> measurement_kinds();

/// The plan with `kind` as all that is measured, from its start on.
scene::RunPlan only(scene::RunPlan plan, const MeasurementKind& kind);

/// NAME_kind() of each observable: one in each file of this folder.
#define SHAKEN_KIND(name, Settings) MeasurementKind name##_kind();
SHAKEN_OBSERVABLES(SHAKEN_KIND)
#undef SHAKEN_KIND

}  // namespace shaken::run
