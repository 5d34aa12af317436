// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string_view>

#include "run/measure/measurement.h"

namespace shaken::run {

/// How state and file of a measurement grow with the number of samples.
enum class Growth {
  kSeries,  ///< with those that are kept one by one (MeasurementKind::kept), but for blocks besides
  kBlocks,  ///< the state up to 64 samples' worth (analysis/blocked.h), the file not at all
  kLags,    ///< with the logarithm
};

/// One thing that can be measured: the block "measure.NAME" of a scene.
struct MeasurementKind {
  std::string_view name;
  std::optional<double> (*every)(const scene::RunPlan&);  ///< the period asked for [s]; none: it is not measured
  void (*switch_off)(scene::RunPlan&);
  std::unique_ptr<Measurement> (*make)(const MeasureContext&);
  Growth growth;
  /// How many of so many samples are kept one by one; null: all.
  std::int64_t (*kept)(const scene::RunPlan&, std::int64_t samples) = nullptr;
};

/// All of them, in the order in which they sample and are saved.
std::span<const MeasurementKind> measurement_kinds();

/// The plan with `kind` as all that is measured, from its start on.
scene::RunPlan only(scene::RunPlan plan, const MeasurementKind& kind);

std::unique_ptr<Measurement> make_order(const MeasureContext& context);
std::unique_ptr<Measurement> make_angles(const MeasureContext& context);
std::unique_ptr<Measurement> make_tilt(const MeasureContext& context);
std::unique_ptr<Measurement> make_defects(const MeasureContext& context);
std::unique_ptr<Measurement> make_g2(const MeasureContext& context);
std::unique_ptr<Measurement> make_fluctuations(const MeasureContext& context);
std::unique_ptr<Measurement> make_frank(const MeasureContext& context);
std::unique_ptr<Measurement> make_msd(const MeasureContext& context);
std::unique_ptr<Measurement> make_rotation(const MeasureContext& context);
std::unique_ptr<Measurement> make_velocity(const MeasureContext& context);
std::unique_ptr<Measurement> make_rods(const MeasureContext& context);
std::unique_ptr<Measurement> make_pairs(const MeasureContext& context);
std::unique_ptr<Measurement> make_layers(const MeasureContext& context);
std::unique_ptr<Measurement> make_lattice(const MeasureContext& context);

}  // namespace shaken::run
