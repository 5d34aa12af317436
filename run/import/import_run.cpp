#include "run/import/import_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <iostream>
#include <nlohmann/json.hpp>
#include <utility>

#include "base/files.h"
#include "base/paths.h"
#include "base/program.h"
#include "base/text.h"
#include "run/files/checkpoint_file.h"
#include "run/files/directory.h"
#include "run/files/recorded_frames.h"
#include "run/files/trajectory.h"
#include "run/files/version.h"
#include "run/import/place_rods.h"
#include "run/loop/import_id.h"
#include "run/loop/open_run.h"
#include "scene/canonical.h"
#include "scene/load.h"
#include "sim/simulation.h"

namespace shaken::run {
namespace {

using OrderedJson = nlohmann::ordered_json;

constexpr std::size_t kMostBytes = std::size_t{1} << 30;  ///< of a table: a million rods have some 0.2 GB
constexpr double kMicrometres = 1000;                     ///< in a millimetre
constexpr const char* kExamples = R"(Examples:
  shaken-worker import rods.csv --scene scene.json
  shaken-worker import runs/first/trajectory.h5 --frame 10 --scene scene.json

Exit codes: 0 done, 1 failed, 2 bad input.)";

/// "FILE: what" and "FILE what" without the name of the file, which stands before every problem.
std::string without_name(const std::string& message, const std::string& file) {
  if (!message.starts_with(file)) return message;
  const std::size_t begin = message.find_first_not_of(": ", file.size());
  return begin == std::string::npos ? message : message.substr(begin);
}

/// As keys::tidied, with what concerns a whole file however many of its lines are wrong.
std::vector<keys::Problem> in_order(std::vector<keys::Problem> problems) {
  const auto of_files =
      std::stable_partition(problems.begin(), problems.end(), [](const auto& p) { return p.line > 0; });
  const std::vector<keys::Problem> files(of_files, problems.end());
  problems.erase(of_files, problems.end());
  problems = keys::tidied(std::move(problems));
  problems.insert(problems.end(), files.begin(), files.end());
  return problems;
}

bool moves(const ImportedRod& rod) { return !rod.velocity.isZero(0) || !rod.angular_velocity.isZero(0); }

/// The rods of the file in the scene, or all that is wrong with both.
struct Import {
  scene::RunPlan plan;
  PlacedRods rods;
  std::vector<std::string> remarks;
};
keys::Loaded<Import> read_import(const ImportOptions& asked) {
  const std::string text = value_or_fail(read_input(asked.scene), ExitCode::kBadInput);
  auto plan = scene::load_scene(text, asked.scene, asked.settings);
  std::vector<keys::Problem> problems = plan ? std::vector<keys::Problem>{} : plan.error();
  const bool is_table = !is_trajectory(asked.file);
  std::vector<ImportedRod> rods;
  std::vector<std::string> remarks;
  if (is_table) {
    if (asked.frame) problems.push_back({asked.file, 0, 0, "", "a table has one frame: leave out --frame"});
    const std::string table = value_or_fail(read_input(asked.file, kMostBytes), ExitCode::kBadInput);
    rods = read_csv_rods(table, asked.file, plan ? species_names(plan->system) : std::vector<std::string>{}, problems,
                         remarks);
  } else if (plan) {
    auto recorded = read_recorded_rods(asked.file, asked.frame, plan->system);
    if (!recorded) problems.push_back({asked.file, 0, 0, "", without_name(recorded.error().message, asked.file)});
    if (recorded) rods = *std::move(recorded);
  }
  if (!plan || (rods.empty() && !problems.empty())) return in_order(std::move(problems));
  auto placed = place_rods(plan->system, rods, asked.file, is_table, problems);
  if (asked.random_velocities && std::any_of(rods.begin(), rods.end(), moves))
    problems.push_back({asked.file, 0, 0, "", "the rods have velocities: leave out --random-velocities"});
  if (!problems.empty()) return in_order(std::move(problems));
  if (asked.random_velocities) {
    draw_velocities(placed->world);
    placed->n_still = 0;
  }
  return Import{without_start(*std::move(plan)), *std::move(placed), std::move(remarks)};
}

/// The scene as text. How the rods of a run start, it does not say: they were not placed.
std::string text_of_scene(const scene::RunPlan& plan) {
  OrderedJson scene = scene::to_json(plan);
  scene["rods"].erase("start");
  return scene.dump(2) + "\n";
}

/// Whether the rods are there already, as they are now.
bool holds(const RunDirectory& directory, const std::string& id, const Checkpoint& rods) {
  std::error_code ignored;
  for (const auto& file : {directory.scene(), directory.imported(), directory.trajectory()}) {
    if (!std::filesystem::exists(file, ignored)) return false;
  }
  const Result<Checkpoint> saved = read_checkpoint(directory.checkpoint(), id);
  return saved && saved->simulation == rods.simulation;
}

/// The run from which others can start. Its scene comes last: without it, it is not found.
void write_run(const RunDirectory& directory, const std::string& id, const ImportOptions& asked,
               const scene::RunPlan& plan, const Simulation& simulation, const OrderedJson& report) {
  done_or_fail(make_folder(directory.root));
  const auto lock = DirectoryLock::acquire(directory.lock());  // another one at work beside this writes the same
  for (const auto& file : {directory.checkpoint(), directory.trajectory(), directory.imported(), directory.scene()}) {
    if (lock) remove_unfinished(file);  // of an import that was killed
  }
  const std::string scene = text_of_scene(plan);
  const Provenance provenance{id, plan.system.seed};
  done_or_fail(write_checkpoint(directory, id, {simulation.checkpoint(), {}, 0, 0}));
  done_or_fail(write_trajectory(
      directory.trajectory(),
      FramesInMemory(trajectory_header(simulation.world(), scene, provenance), {record(simulation.snapshot())})));
  OrderedJson origin = report;
  origin["file"] = asked.file;
  origin["frame"] = asked.frame ? OrderedJson(*asked.frame) : OrderedJson(nullptr);
  origin["shaken_version"] = version();
  done_or_fail(write_file_atomically(directory.imported(),
                                     origin.dump(2, ' ', false, OrderedJson::error_handler_t::replace) + "\n"));
  done_or_fail(write_file_atomically(directory.scene(), scene));
}

ExitCode import_rods(const ImportOptions& asked) {
  const std::filesystem::path root = value_or_fail(data_root(asked.root), ExitCode::kBadInput);
  auto read = read_import(asked);
  if (!read) return refuse(asked.file, read.error(), asked.json);
  auto& [plan, rods, remarks] = *read;
  const Simulation simulation = Simulation::start_from(std::move(rods.world));
  const std::string id = import_id(plan, simulation);
  const RunDirectory directory{root / "runs" / id};
  const OrderedJson report{{"run_id", id},
                           {"n_rods", plan.system.n_all_rods()},
                           {"n_resting", rods.n_resting},
                           {"n_still", rods.n_still},
                           {"deepest_overlap_um", rods.deepest * kMicrometres}};
  const bool was_there = holds(directory, id, {simulation.checkpoint(), {}, 0, 0});
  if (!was_there) write_run(directory, id, asked, plan, simulation, report);
  if (asked.json) {
    OrderedJson out = report;
    out["directory"] = directory.root.string();
    out["start"] = {{"run", id}, {"time", 0}};
    out["was_there"] = was_there;
    out["remarks"] = remarks;
    std::cout << out.dump(2, ' ', false, OrderedJson::error_handler_t::replace) << "\n";
    return ExitCode::kOk;
  }
  std::cout << fmt::format("{} of {} {} run {}, in {}\n",
                           counted(static_cast<std::size_t>(plan.system.n_all_rods()), "rod"), printable(asked.file),
                           was_there ? "are already" : "are now", id, printable(directory.root.string()));
  for (const std::string& remark : remarks) std::cout << remark << "\n";
  if (rods.n_resting > 0) std::cout << fmt::format("{} without a height: they rest on the base\n", rods.n_resting);
  if (rods.deepest > 0) {
    std::cout << fmt::format("deepest overlap {:.2g} um, as hits have them: accepted\n", rods.deepest * kMicrometres);
  }
  if (rods.n_still == plan.system.n_all_rods()) {
    std::cout << "all lie flat and at rest: plates throw them straight up, and nothing moves them in the plane; give "
                 "velocities, or --random-velocities\n";
  }
  std::cout << fmt::format("A scene that starts from them has\n  \"start\": {{\"run\": \"{}\", \"time\": 0}}\n", id);
  return ExitCode::kOk;
}

}  // namespace

void declare(CLI::App& app, ImportOptions& asked) {
  app.add_option("--scene", asked.scene, "The scene whose rods these are")->type_name("FILE")->required();
  app.add_option("-s,--set", asked.settings, "Change one value of the scene")
      ->type_name("PATH=VALUE")
      ->allow_extra_args(false);
  app.add_option("--frame", asked.frame, "Of a trajectory: this frame, from 0; the last one if left out")
      ->type_name("N")
      ->check(CLI::Range(0, 1'000'000'000));
  app.add_flag("--random-velocities", asked.random_velocities,
               "Of a table without velocities: as of any other start, by the scene's seed; 0 if left out");
  app.add_flag("--json", asked.json, "Print JSON, also of problems");
}

int import_command(int argc, char** argv) {
  Program app("shaken-worker import", "Makes a run of the rods in a file, from which others can start.", kExamples);
  ImportOptions asked;
  app.add_option("FILE", asked.file, "Table of rods in CSV, or a trajectory.h5")->required();
  declare(app, asked);
  app.add_option("--root", asked.root, "The daemon's root directory")->type_name("DIR");
  return app.run(argc, argv, [&] { return import_rods(asked); });
}

ExitCode refuse(const std::string& file, const std::vector<keys::Problem>& problems, bool json) {
  if (json) {
    std::cout << nlohmann::ordered_json{{"ok", false}, {"problems", keys::to_json(problems)}}.dump(2) << "\n";
    return ExitCode::kBadInput;
  }
  std::string all = to_string(problems);
  all.pop_back();  // the end of the last line
  throw Failure(ExitCode::kBadInput, fmt::format("{} is refused:\n{}", file, all));
}

}  // namespace shaken::run
