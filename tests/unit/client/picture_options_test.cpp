// SPDX-License-Identifier: MIT
#include "client/picture_options.h"

#include <gtest/gtest.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <fstream>
#include <set>
#include <string>

namespace shaken::client {
namespace {

// The renderer writes its table into the page, so the page knows what it takes.
TEST(PictureOptions, AreTheKeysOfTheRenderersStyles) {
  std::ifstream page(SHAKEN_SOURCE_DIR "/docs/pictures.md");
  std::set<std::string> keys;
  bool is_inside = false;
  for (std::string line; std::getline(page, line);) {
    if (line.starts_with("<!-- style keys:")) is_inside = line.find("begin") != std::string::npos;
    if (!is_inside || !line.starts_with("| `")) continue;
    std::string key = line.substr(3, line.find('`', 3) - 3);
    std::replace(key.begin(), key.end(), '_', '-');
    keys.insert(key);
  }
  std::set<std::string> options;
  for (const PictureOption& option : picture_options()) options.insert(option.name);
  ASSERT_FALSE(keys.empty());
  EXPECT_EQ(options, keys);
}

TEST(PictureOptions, GoOnAsTheyWereGiven) {
  CLI::App app;
  Arguments arguments(app);
  PictureOptions options;
  options.declare(arguments);
  app.parse("1f0c --style mine.json --colour tilt --range=-0.2,0.2 --no-legend --defects --bare -o x.png");
  EXPECT_EQ(options.jobs, std::vector<std::string>{"1f0c"});
  EXPECT_EQ(options.out, "x.png");
  EXPECT_EQ(options.words({"rods.length=2.5"}),
            (std::vector<std::string>{"--style=mine.json", "--colour=tilt", "--range=-0.2,0.2", "--defects",
                                      "--no-legend", "--label=rods.length=2.5", "--bare"}));
}

TEST(PictureOptions, TheLabelOfTheCommandLineComesFirst) {
  CLI::App app;
  Arguments arguments(app);
  PictureOptions options;
  options.declare(arguments);
  app.parse("1f0c --label mine");
  EXPECT_EQ(options.words({"rods.length=2.5"}), (std::vector<std::string>{"--label=mine"}));
}

TEST(PictureOptions, EachOfSeveralRunsHasItsHeadline) {
  CLI::App app;
  Arguments arguments(app);
  PictureOptions options;
  options.declare(arguments);
  app.parse("1f0c 22ab");
  EXPECT_EQ(options.jobs, (std::vector<std::string>{"1f0c", "22ab"}));
  EXPECT_EQ(options.words({"rods.length=2.5", ""}), (std::vector<std::string>{"--label=rods.length=2.5", "--label="}));
  EXPECT_EQ(options.words({"", ""}), std::vector<std::string>{});
  EXPECT_EQ(labels_of({{.directory = "a", .name = "a"}, {.directory = "b", .name = "b", .label = "x"}}),
            (std::vector<std::string>{"a", "x"}))
      << "panels without a headline cannot be told apart";
  EXPECT_EQ(labels_of({{.directory = "a", .name = "a"}}), std::vector<std::string>{""});
}

}  // namespace
}  // namespace shaken::client
