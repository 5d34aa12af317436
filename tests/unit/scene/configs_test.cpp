// Every file that is shipped as an example is right, and its rods fit into their box.
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

#include "scene/keys/observables.h"
#include "scene/sweeps/sweep.h"
#include "sim/rod/species.h"
#include "sim/simulation.h"
#include "tests/support/effort.h"
#include "tests/support/generated_page.h"
#include "tests/unit/scene/scene_support.h"

namespace shaken::scene {
namespace {

std::vector<std::filesystem::path> config_files() {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(SHAKEN_SOURCE_DIR "/configs")) {
    if (entry.path().extension() == ".json") files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

TEST(Configs, AreThere) { EXPECT_GE(config_files().size(), 5U); }

// A test for each file: packing rods in disorder takes seconds, under sanitizers minutes.
class Config : public testing::TestWithParam<std::filesystem::path> {};

TEST_P(Config, IsValidAndCanStart) {
  const Loaded<Sweep> sweep = load_sweep(content_of(GetParam().string()), GetParam().string());
  ASSERT_TRUE(sweep) << to_string(sweep.error());
  for (const SweepPoint& point : sweep->points) {
    const auto started = Simulation::start(point.plan.system);
    EXPECT_TRUE(started) << point.label << ": " << started.error().message;
    if (!test::at_night()) break;  // one of each sweep
  }
}

INSTANTIATE_TEST_SUITE_P(All, Config, testing::ValuesIn(config_files()), [](const auto& file) {
  std::string name;
  for (const char c :
       std::filesystem::relative(file.param, SHAKEN_SOURCE_DIR "/configs").replace_extension().string()) {
    name += std::isalnum(static_cast<unsigned char>(c)) ? c : '_';
  }
  return name;
});

// `shaken explain` of it tells what each observable costs. SHAKEN_UPDATE_DOCS=1 writes it anew.
TEST(Configs, OneMeasuresEveryObservable) {
  std::string blocks, line = "   ";
  for (const Observable& one : observables()) {
    const std::string block = fmt::format(" \"{}\": {{}}{}", one.name, &one == &observables().back() ? "" : ",");
    if (line.size() + block.size() > 120) blocks += line + '\n', line = "   ";
    line += block;
  }
  expect_generated(SHAKEN_SOURCE_DIR "/configs/observables.json", "observables", blocks + line + '\n');
}

// The indented blocks of two pages that begin with a brace.
TEST(Configs, TheExamplesOfTheReferenceAreValid) {
  std::istringstream in(content_of(SHAKEN_SOURCE_DIR "/docs/scene.md") +
                        content_of(SHAKEN_SOURCE_DIR "/docs/sweeps.md"));
  int n_examples = 0;
  std::string example;
  for (std::string line; std::getline(in, line);) {
    if (line.starts_with("    ") && (!example.empty() || line.starts_with("    {"))) {
      example += line + "\n";
    } else if (!example.empty()) {
      const Loaded<Sweep> sweep = load_sweep(example, "docs");
      EXPECT_TRUE(sweep) << example << to_string(sweep.error());
      ++n_examples;
      example.clear();
    }
  }
  EXPECT_EQ(n_examples, 4);
}

}  // namespace
}  // namespace shaken::scene
