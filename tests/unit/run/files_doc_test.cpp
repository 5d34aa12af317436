// docs/files.md and docs/observables.md against the files themselves: they name all that a run writes, with the units
// that the files say, and nothing else.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <hdf5.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>
#include <sstream>
#include <string>

#include "base/files.h"
#include "base/keys/markdown.h"
#include "base/scratch_folder.h"
#include "run/files/directory.h"
#include "run/files/trajectory.h"
#include "run/files/unit_of_name.h"
#include "run/loop/loop.h"
#include "run/loop/summary.h"
#include "run/loop/trouble_file.h"
#include "run/measure/measurement_kinds.h"
#include "scene/keys/observables.h"
#include "sim/effects/registry.h"
#include "tests/support/generated_page.h"
#include "tests/unit/run/hdf5_attributes.h"

namespace shaken::run {
namespace {

using keys::table_head, keys::table_line;

/// A page from the headline "## title" to the next.
std::string section(const std::string& title, const char* name = "files.md") {
  const auto page = read_file(std::filesystem::path(SHAKEN_SOURCE_DIR) / "docs" / name);
  EXPECT_TRUE(page) << page.error().message;
  const std::size_t begin = page->find("\n## " + title + "\n");
  EXPECT_NE(begin, std::string::npos) << title;
  return begin == std::string::npos ? "" : page->substr(begin, page->find("\n## ", begin + 1) - begin);
}

/// A row of a table of data sets.
struct Row {
  std::string unit;
  bool has_error = false;
};

/// The rows by path, by the titles of the columns "unit" and, where there is one, "error".
std::map<std::string, Row> rows_of(const std::string& section) {
  std::map<std::string, Row> rows;
  std::istringstream lines(section);
  std::vector<std::string> columns;
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with("| ")) continue;
    std::vector<std::string> cells;
    std::istringstream parts(line.substr(1));
    for (std::string cell; std::getline(parts, cell, '|');) {
      const std::size_t first = cell.find_first_not_of(' ');
      cells.push_back(first == std::string::npos ? "" : cell.substr(first, cell.find_last_not_of(' ') + 1 - first));
    }
    if (columns.empty()) columns = cells;
    if (!cells.front().starts_with("`/")) continue;
    Row row;
    for (std::size_t c = 0; c < std::min(cells.size(), columns.size()); ++c) {
      if (columns[c] == "unit") row.unit = cells[c];
      if (columns[c] == "error") row.has_error = cells[c] == "±";
    }
    rows[cells.front().substr(1, cells.front().size() - 2)] = row;
  }
  EXPECT_FALSE(rows.empty()) << section;
  return rows;
}

/// Every data set of an HDF5 file with its unit; "1" if it has none.
std::map<std::string, std::string> data_sets(const std::filesystem::path& path) {
  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  EXPECT_GE(file, 0) << path;
  std::vector<std::string> names;
  // by links: one data set may have several names
  const auto collect = [](hid_t root, const char* name, const H5L_info_t*, void* context) -> herr_t {
    H5O_info_t info;
    if (H5Oget_info_by_name2(root, name, &info, H5O_INFO_BASIC, H5P_DEFAULT) < 0) return -1;
    if (info.type == H5O_TYPE_DATASET)
      static_cast<std::vector<std::string>*>(context)->push_back("/" + std::string(name));
    return 0;
  };
  EXPECT_GE(H5Lvisit(file, H5_INDEX_NAME, H5_ITER_INC, collect, &names), 0);
  std::map<std::string, std::string> found;
  for (const std::string& name : names) {
    const std::string unit = hdf5_text_attribute(file, name, "unit");
    found[name] = unit.empty() ? "1" : unit;
  }
  H5Fclose(file);
  return found;
}

/// A small run that measures and records everything, of rods and spheres.
scene::RunPlan everything() {
  scene::RunPlan plan;
  plan.system.rod.n_beads = 7;
  plan.system.rod.length = 2.5;
  plan.system.n_rods = 40;
  plan.system.added[0] = plan.system.added[1] = AddedRods{{0.8, 0.8, 0.8, 1}, 5};
  plan.system.box_side = 14;
  plan.system.dt = 2e-5;
  plan.measure_time = 0.4;
  for (const scene::Observable& observable : scene::observables()) {
    observable.block.store(plan, true);
    observable.every.store(plan, 0.01);
  }
  for (double* every : {&plan.order->every, &plan.msd->every, &plan.rotation->every, &plan.velocity->every}) {
    *every = 0.002;
  }
  plan.tilt = scene::MeasureTilt{0.001, 10};
  plan.defects = scene::MeasureDefects{0.02, 1.25, 0.3125, true, 0.02};
  plan.velocity->window = 0.01;
  plan.rods = scene::MeasureRods{0.01, 2, 0.2};
  plan.pairs = scene::MeasurePairs{0.02, 9, 6};
  plan.density->duration = 0.02;
  plan.trajectory = scene::Trajectory{0.1};
  return plan;
}

/// The files of such a run, made once.
const RunDirectory& files() {
  static const ScratchFolder folder;
  static const RunDirectory directory = [] {
    RunOptions options;
    options.directory = folder / "run";
    const RunOutcome outcome = run(everything(), options);
    EXPECT_EQ(outcome.state, RunState::kDone) << outcome.message;
    return RunDirectory{options.directory};
  }();
  return directory;
}

nlohmann::json json_in(const std::filesystem::path& file) {
  const auto text = read_file(file);
  EXPECT_TRUE(text) << text.error().message;
  return nlohmann::json::parse(*text);
}

TEST(ObservablesPage, NamesEveryArrayWithItsUnit) {
  const auto documented = rows_of(section("Arrays", "observables.md"));
  std::map<std::string, std::string> written;
  for (const auto& [path, unit] : data_sets(files().observables())) {
    written[std::regex_replace(path, std::regex("/trace/[0-9]+/"), "/trace/K/")] = unit;
  }
  for (const auto& [path, unit] : written) {
    const bool is_error = path.find("_sem") != std::string::npos;
    const auto row = documented.find(is_error ? std::regex_replace(path, std::regex("_sem"), "") : path);
    ASSERT_NE(row, documented.end()) << path << " is not in docs/observables.md";
    EXPECT_EQ(row->second.unit, unit) << path;
    EXPECT_TRUE(!is_error || row->second.has_error) << path << " has no ± in docs/observables.md";
  }
  for (const auto& [path, row] : documented) {
    EXPECT_TRUE(written.count(path)) << path << " is in docs/observables.md only";
    const bool has_error = std::any_of(written.begin(), written.end(), [&, &name = path](const auto& other) {
      return other.first.find("_sem") != std::string::npos &&
             std::regex_replace(other.first, std::regex("_sem"), "") == name;
    });
    EXPECT_EQ(has_error, row.has_error) << path;
  }
}

// docs/observables.md has a row for each of these.
TEST(ObservablesPage, NamesEveryNumberThatARunWrites) {
  std::set<std::string> declared, written;
  for (const MeasurementKind& kind : measurement_kinds()) {
    for (const Output& number : kind.numbers) EXPECT_TRUE(declared.emplace(number.name).second) << number.name;
  }
  const nlohmann::json measured = json_in(files().summary())["measured"];
  for (const auto& [name, scalar] : measured.items()) written.insert(name);
  EXPECT_EQ(written, declared) << "run/measure/NAME.cpp: what NAME_kind() lists and what reduce() gives";
}

TEST(FilesPage, NamesEveryPartOfTheTrajectoryWithItsUnit) {
  const auto documented = rows_of(section("trajectory.h5"));
  auto written = data_sets(files().trajectory());
  const ScratchFolder folder;
  scene::RunPlan of_sizes = everything();
  of_sizes.system.rod.spread.length = 0.02;
  RunOptions options;
  options.directory = folder / "sizes";
  ASSERT_EQ(run(of_sizes, options).state, RunState::kDone);
  written.merge(data_sets(RunDirectory{options.directory}.trajectory()));
  const auto simulated = TrajectoryReader::open(files().trajectory());
  TrajectoryHeader tracked = simulated->header();
  tracked.lacking = words_of({Needs::kVelocities});
  ASSERT_TRUE(write_trajectory(folder / "tracked.h5", tracked, simulated->recorded()));
  written.merge(data_sets(folder / "tracked.h5"));
  for (const auto& [path, unit] : written) {
    // one data set under several names, and the third species or shape as the second
    std::string name =
        std::regex_replace(path, std::regex("/(image|velocity|orientation|box/edges)/(step|time)"), "/position/$2");
    name = std::regex_replace(name, std::regex("(species|shape)_[0-9]+"), "$1_2");
    const auto row = documented.find(name);
    ASSERT_NE(row, documented.end()) << path << " is not in docs/files.md";
    EXPECT_EQ(row->second.unit, unit) << path;
  }
  for (const auto& [path, row] : documented) EXPECT_TRUE(written.count(path)) << path << " is in docs/files.md only";
}

/// Expects every key of `json`, and of the objects in it down to `depth`, in backticks.
void expect_named(const std::string& text, const nlohmann::json& json, int depth, const std::string& above = "") {
  for (const auto& [key, value] : json.items()) {
    EXPECT_NE(text.find("`" + key + "`"), std::string::npos) << above << key << " is not in docs/files.md";
    if (key == "why_null") continue;  // its keys are paths of others
    if (value.is_object() && depth > 1) expect_named(text, value, depth - 1, above + key + ".");
  }
}

TEST(FilesPage, NamesEveryKeyOfTheJsonFiles) {
  nlohmann::json summary = json_in(files().summary());
  const nlohmann::json measured = summary["measured"];
  ASSERT_FALSE(measured.empty());
  for (const char* named_elsewhere : {"measured", "effects"}) summary[named_elsewhere] = nlohmann::json::object();
  expect_named(section("summary.json"), summary, 3);
  for (const auto& [name, scalar] : measured.items()) expect_named(section("summary.json"), scalar, 1, name + ".");

  expect_named(section("progress.json"), json_in(files().progress()), 1);

  CloseUp before;
  before.rods.push_back({});
  before.contacts.push_back({});
  before.contacts.push_back({});
  before.contacts.back().other = -1;
  ASSERT_TRUE(write_trouble(files().trouble(), everything(), {{}, 0, before}));
  nlohmann::json trouble = json_in(files().trouble());
  trouble.erase("scene");
  for (const char* list : {"rods", "contacts"}) {
    for (const nlohmann::json& entry : trouble["before"][list]) expect_named(section("trouble.json"), entry, 1);
  }
  expect_named(section("trouble.json"), trouble, 2);
}

TEST(FilesPage, NamesEveryFile) {
  const std::string page = read_file(std::filesystem::path(SHAKEN_SOURCE_DIR) / "docs" / "files.md").value();
  for (const auto& file : std::filesystem::directory_iterator(files().root)) {
    EXPECT_NE(page.find("\n| `" + file.path().filename().string() + "` |"), std::string::npos) << file.path();
  }
  for (const auto& path : {files().scene(), files().checkpoint(), files().previous_checkpoint(), files().progress(),
                           files().trouble(), files().log(), files().movie(), files().lock()}) {
    EXPECT_NE(page.find("\n| `" + path.filename().string() + "` |"), std::string::npos) << path;
  }
}

// The pages say what the records of observables (run/measure/, scene/keys/observables.cpp) and effects say, and these
// say what a run writes. To write the tables of the pages anew: SHAKEN_UPDATE_DOCS=1 and run these tests.

const std::string kPages = SHAKEN_SOURCE_DIR "/docs/";

/// "`tilt`, `tilt_summary`"
std::string in_backticks(std::string_view names) {
  return "`" + std::regex_replace(std::string(names), std::regex(",? "), "`, `") + "`";
}

TEST(EffectsPage, ListsEveryEffect) {
  std::string table = table_head({"effect", "what it is", "on and off by", "work"});
  for (const Effect& effect : all_effects()) {
    table += table_line({in_backticks(effect.name), effect.what, in_backticks(effect.keys),
                         std::regex_replace(std::string(effect.unit), std::regex("_"), " × ")});
  }
  expect_generated(kPages + "effects.md", "effects", table);
}

TEST(FilesPage, ListsEveryKeyOfTheSummary) {
  std::string table = table_head({"key", "unit", "meaning", "null"});
  for (const SummaryKey& key : summary_keys())
    table += table_line({in_backticks(key.name), key.unit, key.meaning, key.if_null});
  expect_generated(kPages + "files.md", "summary", table);
}

TEST(ObservablesPage, ListsEveryBlock) {
  std::string table = table_head({"block", "observable", "with side walls", "among posts", "code in `analysis/`"});
  const auto yes_or_no = [](bool is_so) { return is_so ? "yes" : "no"; };
  for (const scene::Observable& observable : scene::observables()) {
    for (const MeasurementKind& kind : measurement_kinds()) {
      if (kind.name != observable.name) continue;
      table += table_line({in_backticks(kind.name), observable.doc, yes_or_no(observable.within_walls()),
                           yes_or_no(observable.among_posts()), in_backticks(kind.sources)});
    }
  }
  expect_generated(kPages + "observables.md", "blocks", table);
}

TEST(ObservablesPage, ListsEveryNumber) {
  std::string table = table_head({"block", "number", "unit", "meaning"});
  for (const MeasurementKind& kind : measurement_kinds()) {
    for (const Output& number : kind.numbers) {
      EXPECT_FALSE(number.meaning.empty()) << number.name;
      table += table_line(
          {in_backticks(kind.name), in_backticks(number.name), unit_of_name(number.name), kind.meaning(number)});
    }
  }
  expect_generated(kPages + "observables.md", "numbers", table);
}

TEST(ObservablesPage, ListsEveryArray) {
  std::string table = table_head({"data set", "unit", "error", "meaning"});
  for (const MeasurementKind& kind : measurement_kinds()) {
    for (const Output& array : kind.arrays) {
      EXPECT_FALSE(array.meaning.empty()) << array.name;
      table += table_line({fmt::format("`/{}/{}`", kind.name, array.name), unit_of_name(array.name),
                           array.has_error ? "±" : "", kind.meaning(array)});
    }
  }
  expect_generated(kPages + "observables.md", "arrays", table);
}

TEST(MeasurementKinds, AreTheObservablesOfScenes) {
  std::set<std::string_view> kinds, blocks;
  for (const MeasurementKind& kind : measurement_kinds()) EXPECT_TRUE(kinds.insert(kind.name).second) << kind.name;
  for (const scene::Observable& observable : scene::observables()) blocks.insert(observable.name);
  EXPECT_EQ(kinds, blocks);
}

TEST(MeasurementKinds, SayWhereTheirCodeIs) {
  for (const MeasurementKind& kind : measurement_kinds()) {
    std::istringstream names{std::regex_replace(std::string(kind.sources), std::regex(","), "")};
    for (std::string name; names >> name;) {
      EXPECT_TRUE(std::filesystem::exists(std::string(SHAKEN_SOURCE_DIR "/analysis/") + name + ".h")) << name;
    }
  }
}

}  // namespace
}  // namespace shaken::run
