// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <span>
#include <string_view>

namespace shaken::scene {

/// How far an observable is off at a level, against the limit of a fine step.
struct Bias {
  std::string_view observable;  ///< "order"
  double value = 0;             ///< measured mean difference, in `unit`
  double error = 0;             ///< its standard error
  std::string_view unit;        ///< "%" of the observable's value, or its own unit
};

/// What a word for accuracy stands for.
struct AccuracyLevel {
  std::string_view name;  ///< as in the scene: "paper"
  std::string_view what;  ///< one line
  double step = 0;        ///< time.step [s]
  /// CPU time per simulated second against "paper" and the biases, measured by `shaken bench accuracy`; what has not
  /// been measured is not there.
  std::optional<double> cost;
  std::span<const Bias> bias;
};

/// The levels, from coarse to fine.
std::span<const AccuracyLevel> accuracy_levels();
/// The level of that name; null if there is none.
const AccuracyLevel* accuracy_level(std::string_view name);

}  // namespace shaken::scene
