#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "scene/keys/keys.h"
#include "scene/keys/run_plan.h"
#include "scene/sweeps/slurm_settings.h"

namespace shaken::scene {

/// One run of a sweep.
struct SweepPoint {
  std::string label;                  ///< "rods.length=2.5 rods.area_fraction=0.6 replica=2"; empty for a plain scene
  nlohmann::ordered_json parameters;  ///< {dotted path: value in default units}, the swept paths only
  int replica = 1;                    ///< from 1
  RunPlan plan;
};

struct Sweep {
  std::string name;  ///< from the file, or the file's own name without folder and ending
  std::vector<SweepPoint> points;
  std::string executor{};  ///< where its runs are to run, by name; empty: where those of the daemon do
  SlurmSettings slurm{};   ///< what they ask of Slurm, if they run there
};

/// What a sweep's name lacks, as a sentence; none if it will do: 1 to 200 bytes of UTF-8, without '/' and without
/// characters that a terminal obeys (base/text.h), for scenes are passed round and names are printed.
std::optional<std::string> name_problem(std::string_view name);

/// The same of one that is submitted, if it is sound but for that: "s9" could be mistaken for a sweep's id.
std::optional<std::string> id_problem(std::string_view name);
/// The name that load_sweep gives, without the points; the file's own name where the text cannot be read.
std::string sweep_name(std::string_view text, const std::string& file);

/// Reads a sweep file, or a scene file as a sweep of one point.
///   {"name"?, "executor"?, "slurm"?: {...}, "scene": {...}, "sweep": {"grid": {path: values}, "zip": {path: values},
///   "list": [{path: value}, ...], "stages": [{path: values}, ...], "replicas": n}}
/// The points are the product of all paths of the grid, the tuples of zip and the entries of list, the first varying
/// slowest, and `replicas` runs of each: replica k has time.seed + k - 1. With stages each run is a chain of runs, one
/// after the other in time (RunPlan::start), whose points have the further parameter "stage", from 1; the stages vary
/// faster than all but the replicas. A "sweep" may also be an array of such products: then the points are those of the
/// first, of the second and so on; of points that name the same run, the first is kept.
///
/// Settings are applied to every point, of every product. One with several values, "rods.length=2.5,3.5" or
/// "box.gap=0.9:1.5:0.1", is an axis of the grid; one for a path that the file's grid has takes the place of that axis.
/// `replicas` replaces the file's. Everything wrong with any point is listed at once.
Loaded<Sweep> load_sweep(std::string_view text, const std::string& file, std::span<const std::string> settings = {},
                         std::optional<int> replicas = std::nullopt);

}  // namespace shaken::scene
