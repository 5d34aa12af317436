#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "run/measure/cadence.h"
#include "run/measure/measurement.h"

namespace shaken::run {

/// One array of observables.h5, or one number of summary.json.
struct Output {
  std::string_view name;     ///< ends in the unit; of an array: its path below "/NAME/"
  std::string_view meaning;  ///< for the pages
  bool has_error = false;    ///< of an array: whether there is one with `_sem` as well (every number has an error)
  /// Why a number has no value where it has none and the measurement says no more.
  std::string_view if_none = "too few samples, or too short a run";
  /// The key of its block that sets the time over which it is taken, where its value depends on that ("window"), and
  /// how many such times.
  std::string_view over = {};
  int times = 1;
  std::string_view title = {};   ///< in figures, in few words: "wavelength of the layers"
  std::string_view symbol = {};  ///< in LaTeX's mathematics
  bool needs_axis = false;       ///< where others of the same measurement do not: spheres lack it
};
inline constexpr bool kWithError = true;

/// `output` as figures call it (Output::title, symbol).
constexpr Output called(std::string_view title, std::string_view symbol, Output output) {
  output.title = title;
  output.symbol = symbol;
  return output;
}

/// `output`, whose value depends on the time over which it is taken (Output::over).
constexpr Output over(std::string_view key, Output output, int times = 1) {
  output.over = key;
  output.times = times;
  return output;
}

/// `output` of rods that have axes (Output::needs_axis).
constexpr Output of_axis(Output output) {
  output.needs_axis = true;
  return output;
}

/// What recorded or tracked rods may lack.
enum class Needs {
  kImpacts,     ///< counts of impacts
  kSpins,       ///< angular velocities
  kVelocities,  ///< of centres at an instant
  kTilts,       ///< directions out of the plane
  kIdentities,  ///< which rod of one frame is which of another
  kEveryRod,    ///< in every frame: none is missed
  kHeads,       ///< which end of a rod is its head
};
using Lacking = std::set<Needs>;
/// "impacts", "angular velocities", ...
std::string_view word_of(Needs need);
/// "impacts, velocities", and what such words say.
std::string words_of(const Lacking& lacking);
Lacking lacking_of(std::string_view words);

/// One thing that can be measured, the block "measure.NAME" of a scene, and all that becomes of it.
struct MeasurementKind {
  std::string_view name;     ///< as in scene/keys/observables.cpp
  std::string_view sources;  ///< files of analysis/, "msd, lags/lag_fits"
  std::unique_ptr<Measurement> (*make)(const MeasureContext&) = nullptr;
  bool only_steady = false;  ///< samples before a given time.steady are left out
  std::vector<Output> arrays = {};
  /// A group of arrays, or one of them, and those that it is measured at, the slowest first, as in {"area_fraction",
  /// "time_s y_mm x_mm"}. All others are measured at the first array of their group.
  std::vector<std::pair<std::string_view, std::string_view>> axes = {};
  std::vector<Output> numbers = {};
  /// What it needs of its rods besides their places and their directions in the plane.
  std::vector<Needs> needs = {};

  /// The period asked for [s]; none: it is not measured (Observable::period).
  std::optional<double> every(const scene::RunPlan& plan) const;
  /// When samples are taken: spread over their intervals where Observable::is_spread. None: it is not measured.
  std::optional<Cadence> cadence(const scene::RunPlan& plan) const;

  /// Names of the arrays that one is measured at, the slowest first; none of an axis itself.
  std::vector<std::string> axes_of(std::string_view array) const;

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
