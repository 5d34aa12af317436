// SPDX-License-Identifier: MIT
// The pages say what the records of observables (run/measure/, scene/keys/observables.cpp) and effects say, and these
// say what a run writes (files_doc_test.cpp). To write the tables of the pages anew: SHAKEN_UPDATE_DOCS=1 and run these
// tests.
#include <gtest/gtest.h>

#include <filesystem>
#include <regex>
#include <set>
#include <sstream>
#include <string>

#include "run/files/unit_of_name.h"
#include "run/measure/measurement_kinds.h"
#include "scene/keys/observables.h"
#include "sim/effects/registry.h"
#include "tests/support/generated_page.h"

namespace shaken::run {
namespace {

const std::string kPages = SHAKEN_SOURCE_DIR "/docs/";

/// "`tilt`, `tilt_summary`"
std::string in_backticks(std::string_view names) {
  return "`" + std::regex_replace(std::string(names), std::regex(",? "), "`, `") + "`";
}

TEST(ObservablesPage, ListsEveryBlock) {
  std::ostringstream table;
  table << "| block | observable | with side walls | among posts | code in `analysis/` |\n|---|---|---|---|---|\n";
  const auto yes_or_no = [](bool is_so) { return is_so ? "yes" : "no"; };
  for (const scene::Observable& observable : scene::observables()) {
    for (const MeasurementKind& kind : measurement_kinds()) {
      if (kind.name != observable.name) continue;
      table << "| `" << kind.name << "` | " << observable.doc << " | " << yes_or_no(observable.within_walls()) << " | "
            << yes_or_no(observable.among_posts()) << " | " << in_backticks(kind.sources) << " |\n";
    }
  }
  expect_generated(kPages + "observables.md", "blocks", table.str());
}

TEST(ObservablesPage, ListsEveryNumber) {
  std::ostringstream table;
  table << "| block | number | unit | meaning |\n|---|---|---|---|\n";
  for (const MeasurementKind& kind : measurement_kinds()) {
    for (const Output& number : kind.numbers) {
      EXPECT_FALSE(number.meaning.empty()) << number.name;
      table << "| `" << kind.name << "` | `" << number.name << "` | " << unit_of_name(number.name) << " | "
            << kind.meaning(number) << " |\n";
    }
  }
  expect_generated(kPages + "observables.md", "numbers", table.str());
}

TEST(EffectsPage, ListsEveryEffect) {
  std::ostringstream table;
  table << "| effect | what it is | on and off by | work |\n|---|---|---|---|\n";
  for (const Effect& effect : all_effects()) {
    table << "| `" << effect.name << "` | " << effect.what << " | " << in_backticks(effect.keys) << " | "
          << std::regex_replace(std::string(effect.unit), std::regex("_"), " × ") << " |\n";
  }
  expect_generated(kPages + "effects.md", "effects", table.str());
}

TEST(FilesPage, ListsEveryArray) {
  std::ostringstream table;
  table << "| data set | unit | error | meaning |\n|---|---|---|---|\n";
  for (const MeasurementKind& kind : measurement_kinds()) {
    for (const Output& array : kind.arrays) {
      EXPECT_FALSE(array.meaning.empty()) << array.name;
      table << "| `/" << kind.name << "/" << array.name << "` | " << unit_of_name(array.name) << " |"
            << (array.has_error ? " ± " : " ") << "| " << kind.meaning(array) << " |\n";
    }
  }
  expect_generated(kPages + "files.md", "arrays", table.str());
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
