#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/time_series.h"
#include "base/core/result.h"
#include "base/core/types.h"
#include "run/files/content_hash.h"
#include "run/measure/reduction.h"
#include "scene/keys/run_plan.h"
#include "sim/balance.h"

namespace shaken::run {

/// One effect of the scene: whether it took part, and how much work that was.
struct EffectReport {
  bool on = false;
  std::map<std::string, double> work;  ///< counts by name ("impulses", "samples"), parameters with their unit
};

/// Recorded frames whose measurement a run directory holds (run/recorded/).
struct FramesOrigin {
  std::string file;
  std::size_t n = 0;
  double first = 0, last = 0;        ///< times of the first and the last [s]
  std::vector<std::string> remarks;  ///< what was measured otherwise than asked for
};

/// What summary.json says of a run.
struct Summary {
  std::string run_id;
  int physics = 0;                         ///< version of the scene's physics (sim/physics_version.h)
  std::optional<scene::StartState> start;  ///< the run that left the rods as they were at the start, if one did
  int n_rods = 0;
  double sim_seconds = 0;
  double cpu_seconds = 0;   ///< of this process and its predecessors
  double wall_seconds = 0;  ///< the same
  std::int64_t collisions_rod_rod = 0;
  std::int64_t collisions_rod_base = 0;
  std::int64_t collisions_rod_lid = 0;
  std::int64_t collisions_rod_wall = 0;
  std::int64_t collisions_rod_post = 0;
  double max_overlap = 0;                        ///< [mm]
  Balance balance;                               ///< of energy and momentum
  double t_steady = 0;                           ///< where the steady state begins [s]
  std::optional<analysis::SteadySummary> order;  ///< if S(t) was measured
  bool has_axis = true;                          ///< of the rods that are measured: spheres have none, and no S
  std::map<std::string, Scalar> scalars;         ///< of the other measurements, in the steady state
  std::optional<double> defects_mean_plus;       ///< in the steady state, if defects were measured
  std::optional<double> defects_mean_minus;
  std::map<std::string, EffectReport> effects;
  std::optional<FramesOrigin> frames{};      ///< that were measured, where nothing was simulated
  std::map<std::string, ContentHash> files;  ///< those of HDF5 that this end of the run has written, by their names
  std::uint64_t state_hash = 0;
  std::string started;   ///< UTC, ISO 8601
  std::string finished;  ///< the same

  std::string state = "done";           ///< done | failed | stopped
  std::string reason;                   ///< unless done
  std::optional<double> done_before{};  ///< the simulated time of an end that the run had, if it went on from there [s]
  Tick tick = 0;                        ///< of the end
  std::vector<int> rods;                ///< concerned by numerical trouble
};

/// The standard error that is shown with a mean: its own where it is of a steady state. Where it is not, or that is not
/// known, the mean may be on its way still: then its drift and the error of that are part of it. NaN: unknown.
double shown_error(double sem, std::optional<bool> steady, double drift, double drift_sem);

double shown_error(const analysis::SteadySummary& order);

/// "still relaxing" or "not known to be steady" (base/steadiness.h), why, and what to do about it: the one sentence
/// that log, summary and last words of a run have. Empty if S is steady.
std::string why_not_steady(const analysis::SteadySummary& order, double sim_seconds);

/// What was measured of a run of `plan`.
void fill(Summary& summary, const scene::RunPlan& plan, const Reduction& reduction);

/// What summary.json says of the whole run besides `measured`: numbers, and blocks of them.
struct SummaryKey {
  std::string_view name;
  std::string_view unit;     ///< "1" of plain numbers, empty of what is none
  std::string_view title;    ///< in figures, in few words; may be empty
  std::string_view meaning;  ///< for docs/files.md
  nlohmann::ordered_json (*value)(const Summary&);
  std::string_view if_null = {};     ///< why there is no value
  std::string_view of_spheres = {};  ///< the same where the measured rods have no axis
  std::string_view averages = {};    ///< its members that are means over time, with blanks between them
};
/// All of them, in the order of the file.
std::span<const SummaryKey> summary_keys();

/// summary.json: every null with its reason.
std::string summary_text(const Summary& summary);
Result<void> write_summary(const std::filesystem::path& file, const Summary& summary);

}  // namespace shaken::run
