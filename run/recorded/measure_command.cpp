#include "run/recorded/measure_command.h"

#include <fmt/format.h>
#include <xxhash.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>

#include "base/clock.h"
#include "base/files.h"
#include "base/interrupt.h"
#include "base/keys/units.h"
#include "base/program.h"
#include "base/progress_line.h"
#include "base/text.h"
#include "run/files/content_hash.h"
#include "run/files/directory.h"
#include "run/files/done.h"
#include "run/files/foreign_file.h"
#include "run/files/trajectory.h"
#include "run/import/import_run.h"
#include "run/loop/summary.h"
#include "run/recorded/measure_frames.h"
#include "run/recorded/track_table.h"
#include "run/recorded/tracks.h"
#include "scene/canonical.h"
#include "scene/load.h"

namespace shaken::run {
namespace {

namespace fs = std::filesystem;
using OrderedJson = nlohmann::ordered_json;

constexpr const char* kMeasureExamples = R"(Examples:
  shaken-worker measure runs/first --out wide -s measure.g2.bins=200
  shaken-worker measure first.h5 --scene other-bins.json --out other
  shaken-worker measure tracks.csv --scene dish.json --scale 0.05 --interval "20 ms" --flip-y --out seen

Exit codes: 0 done, 1 failed, 2 bad input.)";
constexpr std::size_t kMostOfTable = std::size_t{4} << 30;  ///< of a table

/// What the folder is to hold may take the place of another measurement, and of nothing else.
void claim(const RunDirectory& directory) {
  std::error_code none;
  if (!fs::exists(directory.root, none) || fs::is_empty(directory.root, none) || is_of_frames(directory)) return;
  throw Failure(ExitCode::kBadInput,
                fmt::format("{} is not empty, and holds no whole measurement of frames: choose another folder by --out",
                            printable(directory.root.string())));
}

/// XXH3-64 of frames that are made of a table: the same table, read in another way, has others.
std::uint64_t hash_of(const RecordedFrames& frames) {
  std::uint64_t hash = 0;
  for (std::size_t k = 0; k < frames.n_frames(); ++k) {
    const RecordedFrame frame = value_or_fail(frames.frame(k));
    for (const std::vector<float>* numbers : {&frame.position, &frame.orientation, &frame.velocity})
      hash = XXH3_64bits_withSeed(numbers->data(), numbers->size() * sizeof(float), hash);
    hash = XXH3_64bits_withSeed(frame.image.data(), frame.image.size() * sizeof(std::int32_t), hash);
  }
  return hash;
}

/// 16 hex digits that name a measurement: XXH3-64 of the frames, or of their file, and of what is measured.
std::string id_of(const scene::RunPlan& plan, std::uint64_t frames) {
  const std::string text = fmt::format("shaken measure\n{}\n{:016x}", scene::run_id(plan), frames);
  return fmt::format("{:016x}", XXH3_64bits(text.data(), text.size()));
}

/// What is measured, on what, and what is said of it.
struct Task {
  FramesPlan by;
  const RecordedFrames* frames;
};

keys::Loaded<Task> task_of(const MeasureOptions& asked, const TrajectoryReader& frames) {
  const std::string& own = frames.header().scene_json;
  const std::string name = frames.path().string() + ", its scene";
  const auto spacing = frame_spacing(frames.recorded());
  if (!spacing) return std::vector<keys::Problem>{{asked.file, 0, 0, "", spacing.error().message}};
  const std::string given = asked.scene.empty() ? own : value_or_fail(read_input(asked.scene), ExitCode::kBadInput);
  Lacking lacking = lacking_of(frames.header().lacking);
  lacking.insert(kLackingInFiles.begin(), kLackingInFiles.end());
  auto made = SHAKEN_TRY(plan_for_frames({own, name}, {given, asked.scene.empty() ? name : asked.scene}, asked.settings,
                                         *spacing, lacking));
  const bool is_tracked = !frames.header().lacking.empty();
  if (is_tracked && !lacking.contains(Needs::kVelocities)) {
    const double interval = static_cast<double>(*spacing) * frames.header().dt;
    made.remarks.insert(made.remarks.begin(), remark_on_velocities(frames.recorded().n_frames(), interval));
  }
  return Task{std::move(made), &frames.recorded()};
}

/// A word on each observable of which a short film leaves few samples: its period is longer than frames are apart.
std::vector<std::string> remarks_on_few_samples(const scene::RunPlan& plan, Tick spacing) {
  constexpr double kFew = 20;
  std::vector<std::string> remarks;
  for (const MeasurementKind& kind : measurement_kinds()) {
    const double each = static_cast<double>(spacing) * plan.system.dt, every = kind.every(plan).value_or(each);
    if (every < 1.5 * each || every * kFew < plan.total_time()) continue;
    remarks.push_back(fmt::format("measure.{0} is of one frame in {1:.0f}: -s measure.{0}.every={2:.6g} is of each",
                                  kind.name, every / each, each));
  }
  return remarks;
}

/// The task of measuring a table; `tracks` takes what it is of.
keys::Loaded<Task> task_of(const MeasureOptions& asked, std::optional<TrackedRods>& tracks) {
  if (asked.scene.empty()) {
    return std::vector<keys::Problem>{
        {asked.file, 0, 0, "", "--scene is missing: a table says nothing of the box, and of what is to be measured"}};
  }
  const auto plan =
      scene::load_scene(value_or_fail(read_input(asked.scene), ExitCode::kBadInput), asked.scene, asked.settings);
  if (!plan) return plan.error();
  std::vector<keys::Problem> problems;
  const std::string table = value_or_fail(read_input(asked.file, kMostOfTable), ExitCode::kBadInput);
  tracks = read_tracks(table, asked.file, *plan, asked.conventions, problems);
  if (!tracks) return keys::tidied(std::move(problems));
  const auto spacing = frame_spacing(*tracks->frames);
  if (!spacing) return std::vector<keys::Problem>{{asked.file, 0, 0, "", spacing.error().message}};
  const std::string& own = tracks->frames->header().scene_json;
  auto made = SHAKEN_TRY(plan_for_frames({own, asked.scene}, {own, asked.scene}, {}, *spacing, tracks->lacking));
  made.remarks.insert(made.remarks.begin(), tracks->remarks.begin(), tracks->remarks.end());
  if (tracks->frames->n_frames() > 1)
    std::ranges::move(remarks_on_few_samples(made.plan, *spacing), std::back_inserter(made.remarks));
  return Task{std::move(made), tracks->frames.get()};
}

/// Measures, and fills the directory; the summary comes last.
MeasuredFrames write_run(const Task& task, const RunDirectory& directory, const std::string& file,
                         const std::string& id) {
  const scene::RunPlan& plan = task.by.plan;
  const RecordedFrames& frames = *task.frames;
  const std::string started = utc_now();
  const auto begin = std::chrono::steady_clock::now();
  const InterruptGuard guard;
  ProgressLine progress("measuring");
  const auto n = static_cast<double>(frames.n_frames());
  Result<MeasuredFrames> measured = measure_frames(plan, frames, [&](std::size_t frame) {
    progress.show(static_cast<double>(frame) / n);
    return !guard.interrupted();
  });
  progress.clear();
  if (guard.interrupted()) throw Failure(ExitCode::kInterrupted, "interrupted: nothing is written");
  MeasuredFrames found = value_or_fail(std::move(measured));
  done_or_fail(make_folder(directory.root));
  const DirectoryLock lock = value_or_fail(DirectoryLock::acquire(directory.lock()));

  Summary summary = summary_of(task.by, found, file);
  summary.run_id = id;
  summary.started = started;
  summary.cpu_seconds = cpu_seconds();
  summary.wall_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();

  TrajectoryHeader header = frames.header();
  header.scene_json = scene::to_json(plan).dump(2) + "\n";
  header.provenance = {id, plan.system.seed};
  done_or_fail(write_trajectory(directory.trajectory(), header, frames));
  done_or_fail(write_observables(directory.observables(), found.reduction.arrays, header.provenance));
  done_or_fail(write_file_atomically(directory.scene(), header.scene_json));
  for (const fs::path& each : {directory.trajectory(), directory.observables()})
    summary.files[each.filename().string()] = value_or_fail(content_hash(each));
  summary.finished = utc_now();
  done_or_fail(write_summary(directory.summary(), summary));
  return found;
}

ExitCode measure(const MeasureOptions& asked) {
  const fs::path file = fs::is_directory(asked.file) ? RunDirectory{asked.file}.recorded() : fs::path(asked.file);
  if (!value_or_fail(file_exists(file)))
    throw Failure(ExitCode::kBadInput, fmt::format("there is no {}: no frames", printable(file.string())));
  std::optional<TrajectoryReader> trajectory;
  std::optional<TrackedRods> tracks;
  if (is_trajectory(file)) {
    done_or_fail(try_to_read(file));
    trajectory = value_or_fail(TrajectoryReader::open(file));
  }
  const keys::Loaded<Task> task = trajectory ? task_of(asked, *trajectory) : task_of(asked, tracks);
  if (!task) return refuse(asked.file, task.error(), asked.json);

  const std::string id =
      id_of(task->by.plan, tracks ? hash_of(*tracks->frames) : value_or_fail(content_hash(file)).xxh3);
  const RunDirectory directory{asked.out.empty() ? "measured-" + id.substr(0, 8) : asked.out};
  claim(directory);
  const MeasuredFrames found = write_run(*task, directory, asked.file, id);
  const std::vector<std::string>& remarks = task->by.remarks;
  if (asked.json) {
    std::cout << OrderedJson{{"ok", true},
                             {"run_id", id},
                             {"directory", directory.root.string()},
                             {"n_frames", task->frames->n_frames()},
                             {"remarks", remarks}}
                     .dump(2, ' ', false, OrderedJson::error_handler_t::replace)
              << "\n";
    return ExitCode::kOk;
  }
  std::cout << fmt::format("{} of {}, {:.6g} s to {:.6g} s: measured in {}\n",
                           counted(task->frames->n_frames(), "frame"),
                           counted(static_cast<std::size_t>(task->by.plan.system.n_all_rods()), "rod"), found.first,
                           found.last, printable(directory.root.string()));
  for (const std::string& remark : remarks) std::cout << remark << "\n";
  return ExitCode::kOk;
}

/// By their names, the values of an option that has "NAME=VALUE" each.
std::map<std::string, std::string> pairs_of(const CLI::Option* option, const std::vector<std::string>& values) {
  std::map<std::string, std::string> pairs;
  for (const std::string& each : values) {
    const std::size_t equals = each.find('=');
    if (equals == std::string::npos) {
      throw Failure(ExitCode::kBadInput,
                    fmt::format("{} takes {}, not '{}'", option->get_name(), option->get_type_name(), printable(each)));
    }
    pairs[each.substr(0, equals)] = each.substr(equals + 1);
  }
  return pairs;
}

}  // namespace

void declare(CLI::App& app, MeasureOptions& asked) {
  TrackConventions& table = asked.conventions;
  app.add_option("--scene", asked.scene, "Measure what it measures; of frames, what their own does if left out")
      ->type_name("FILE");
  app.add_option("-s,--set", asked.settings, "Change one value; of frames: of measure, or time.steady")
      ->type_name("PATH=VALUE")
      ->allow_extra_args(false);
  app.add_option("-o,--out", asked.out, "Folder of the results; measured-ID if left out")->type_name("DIR");
  app.add_option("--scale", table.scale, "Table: mm in one unit of its lengths, as a pixel")
      ->type_name("MM")
      ->check(CLI::PositiveNumber.description(""));
  app.add_option("--interval", asked.interval, "Table: time from frame to frame, e.g. 20ms; by its times if left out")
      ->type_name("TIME");
  app.add_option("--columns", asked.columns, "Table: what columns are called, as in x=POSITION_X,angle=phi")
      ->type_name("NAME=COLUMN")
      ->delimiter(',')
      ->allow_extra_args(false);
  app.add_option("--species", asked.species, "Table: which species its names are, as in long=rods,short=rods_2")
      ->type_name("NAME=SPECIES")
      ->delimiter(',')
      ->allow_extra_args(false);
  app.add_flag("--flip-y", table.flips_y, "Table: y is counted downwards, from the upper edge");
  app.add_flag("--wrap", table.wraps, "Table: put positions into the periodic box");
  app.add_option("--fill", table.filled, "Table: interpolate rods that are missed for up to N frames")
      ->type_name("N")
      ->check(CLI::Range(0, 1000));
  app.add_flag("--complete", table.only_complete, "Table: leave rods out that are not in every frame");
  app.add_flag("--degrees", asked.degrees, "Table: angles are in degrees, as they are if nothing tells otherwise")
      ->excludes(app.add_flag("--radians", asked.radians, "Table: angles are in radians"));
  app.add_flag("--json", asked.json, "Print JSON, also of problems");
}

int measure_command(int argc, char** argv) {
  Program app("shaken-worker measure", "Measures recorded frames of a run, or tracked rods of an experiment.",
              kMeasureExamples);
  MeasureOptions asked;
  app.add_option("FILE", asked.file, "A run directory, its trajectory.h5 or trajectory.part, or a table in CSV")
      ->required();
  declare(app, asked);
  return app.run(argc, argv, [&] {
    if (asked.radians || asked.degrees) asked.conventions.radians = asked.radians;
    if (!asked.interval.empty()) {
      const auto time = keys::parse_quantity(asked.interval, keys::Dimension::kTime);
      if (!time || !(*time > 0)) {
        throw Failure(ExitCode::kBadInput,
                      "--interval: " + (time ? asked.interval + " is not above 0" : time.error().message));
      }
      asked.conventions.interval = *time;
    }
    asked.conventions.columns = pairs_of(app.get_option("--columns"), asked.columns);
    asked.conventions.species = pairs_of(app.get_option("--species"), asked.species);
    return measure(asked);
  });
}

}  // namespace shaken::run
