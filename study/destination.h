// SPDX-License-Identifier: MIT
// Where the sweeps of a study go: what the command line says of it, put into their texts.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "client/arguments.h"
#include "client/json.h"
#include "study/selection.h"

namespace shaken::study {

using client::Json;

/// An executor, and what is asked of Slurm there.
class Destination {
 public:
  void declare(client::Arguments& arguments);

  /// All that is wrong with the options, a line each; empty if nothing is.
  std::string problems() const;
  /// Whether it is Slurm by the command line, whatever sweeps say.
  bool is_slurm() const { return executor_ == "slurm"; }
  /// Makes the sweeps go there: their texts name it, and they are read anew. Without options they go where they say.
  void redirect(Selection& selection) const;

 private:
  /// What the options ask of Slurm, as in a sweep's "slurm".
  Json settings() const;

  std::string executor_, partition_, account_, time_, memory_;
  std::optional<int> runs_per_task_;
  std::vector<std::string> options_;
};

/// The text of a sweep or a scene, as a sweep that names `executor` and has these settings in its "slurm" over those
/// that it has; nothing else is changed but layout and comments. Throws nlohmann's exceptions for what is no JSON.
std::string sent_to(const std::string& text, const std::string& executor, const Json& settings);

}  // namespace shaken::study
