#include "run/loop/start_state.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "base/files.h"
#include "base/paths.h"
#include "run/files/checkpoint_file.h"
#include "run/files/directory.h"
#include "run/loop/import_id.h"
#include "run/loop/saved_run.h"
#include "scene/canonical.h"

namespace shaken::run {
namespace {

using std::filesystem::path;

constexpr const char* kNotSaved = "it has not been saved yet";

/// As the daemon's folders are, of which there may be a hundred thousand: what is in them need not be looked at.
bool is_named_after_a_run(const path& folder) {
  const std::string name = folder.filename().string();
  return name.size() == 16 && name.find_first_not_of("0123456789abcdef") == std::string::npos;
}

/// Whether `folder` holds run `id`, as far as its summary says.
bool is_of_run(const path& folder, const std::string& id) {
  const Result<std::string> text = read_file(RunDirectory{folder}.summary());
  if (!text) return false;
  const auto summary = nlohmann::json::parse(*text, nullptr, false);
  return summary.is_object() && summary.value("run_id", nlohmann::json()) == id;
}

/// Directories that hold run `id`: those named after it, as the daemon's are, first; then those of any other name.
std::vector<RunDirectory> find_run(const std::vector<path>& folders, const std::string& id) {
  std::vector<RunDirectory> found;
  std::error_code ignored;
  for (const path& folder : folders) {
    const Result<bool> is_there = file_exists(RunDirectory{folder / id}.scene());
    if (!is_there || *is_there) found.push_back({folder / id});
  }
  for (const path& folder : folders) {
    std::error_code trouble;
    for (std::filesystem::directory_iterator entry(folder, trouble), end; !trouble && entry != end;
         entry.increment(trouble)) {
      if (is_named_after_a_run(entry->path())) continue;
      if (entry->is_directory(ignored) && is_of_run(entry->path(), id)) found.push_back({entry->path()});
    }
  }
  return found;
}

/// Folders of runs in which one may be found that `directory` starts from.
std::vector<path> folders_near(const path& directory) {
  std::vector<path> folders;
  if (!directory.empty()) {
    const path beside = std::filesystem::absolute(directory / "..").lexically_normal();
    folders.push_back(beside.has_filename() ? beside : beside.parent_path());  // without a slash at its end
  }
  if (const auto root = data_root()) {
    const path runs = std::filesystem::absolute(*root / "runs").lexically_normal();
    if (folders.empty() || folders.front() != runs) folders.push_back(runs);
  }
  return folders;
}

/// The state that run `id` had at `time`, if one of its checkpoints is of then.
Result<Simulation> saved_state(const RunDirectory& directory, const std::string& id, double time) {
  const scene::RunPlan plan = SHAKEN_TRY(read_plan(directory));
  const bool is_imported = SHAKEN_TRY(file_exists(directory.imported()));
  const Error other{directory.root.string() + " holds another run"};
  if (!is_imported && scene::run_id(plan) != id) return other;
  std::string trouble = kNotSaved;
  for (const path& file : directory.checkpoints()) {
    const Result<bool> is_there = file_exists(file);
    if (is_there && !*is_there) continue;
    const Result<Checkpoint> checkpoint = read_checkpoint(file, id);
    if (!checkpoint && may_pass(checkpoint.error())) return checkpoint.error();
    Result<Simulation> simulation =
        checkpoint ? Simulation::resume(plan.system, checkpoint->simulation) : Result<Simulation>(checkpoint.error());
    if (simulation && is_imported && import_id(plan, *simulation) != id) return other;
    if (simulation && simulation->tick() == std::llround(time / plan.system.dt)) return simulation;
    if (trouble != kNotSaved) continue;  // the newest has told
    trouble = simulation ? fmt::format("its last saved state is that at {:.10g} s", simulation->time())
                         : simulation.error().message;
  }
  return Error{fmt::format("there is no state of it at {:.10g} s: {}", time, trouble)};
}

}  // namespace

Result<Simulation> start_simulation(const scene::RunPlan& plan, const path& directory, const GoOn& go_on) {
  if (!plan.start) return Simulation::start(plan.system, go_on);
  const auto& [id, time] = *plan.start;
  const std::vector<path> folders = folders_near(directory);
  Error trouble;
  for (const RunDirectory& parent : find_run(folders, id)) {
    const Result<Simulation> left = saved_state(parent, id, time);
    Result<Simulation> simulation =
        left ? Simulation::start(plan.system, left->world(), go_on) : Result<Simulation>(left.error());
    if (simulation) return simulation;
    if (trouble.message.empty()) trouble = simulation.error();
  }
  if (!trouble.message.empty()) {
    return Error{fmt::format("cannot start from run {}: {}", id, trouble.message), trouble.code};
  }
  std::string places;
  for (const path& folder : folders) places += (places.empty() ? "" : " and ") + folder.string();
  return Error{fmt::format("run {}, from which this one starts, is not in {}", id, places)};
}

}  // namespace shaken::run
