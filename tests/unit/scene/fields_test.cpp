// SPDX-License-Identifier: MIT
#include "scene/keys/fields.h"

#include <set>

#include "scene/canonical.h"
#include "tests/support/generated_page.h"
#include "tests/unit/scene/scene_support.h"

namespace shaken::scene {
namespace {

TEST(Fields, PathsAreUniqueAndInsideOfTheirBlocks) {
  std::set<std::string> paths;
  for (const Field& field : fields()) {
    EXPECT_TRUE(paths.insert(field.path).second) << field.path;
    const Field* block = fields().block_of(field);
    EXPECT_TRUE(!block || paths.contains(block->path)) << field.path << " stands before its block";
    EXPECT_FALSE(field.doc.empty()) << field.path;
    EXPECT_EQ(field_at(field.path).path, field.path);
  }
}

TEST(Fields, EveryDefaultIsAllowedAndReadsBack) {
  for (const Field& field : fields()) {
    if (const double* number = std::get_if<double>(&field.fallback)) {
      EXPECT_GE(*number, field.low) << field.path;
      EXPECT_LE(*number, field.high) << field.path;
    }
    if (field.form == Form::kBlock || std::holds_alternative<std::monostate>(field.fallback)) continue;
    if (fields().block_of(field) != nullptr) continue;
    // Saying what holds anyway changes nothing.
    const std::string setting = field.path + "=" + to_json(field, field.fallback).dump();
    EXPECT_EQ(plan_of("{}", {setting}), plan_of("{}")) << setting;
  }
}

TEST(Fields, KnowTheTreeOfNames) {
  EXPECT_EQ(
      fields().names_in(""),
      (std::vector<std::string>{"rods", "rods_2", "rods_3", "start", "box", "plates", "gravity", "walls", "posts",
                                "contacts", "accuracy", "time", "until", "measure", "trajectory", "stream", "movie"}));
  EXPECT_EQ(fields().names_in("contacts.rod_lid"),
            (std::vector<std::string>{"friction", "restitution", "restitution_speed", "rods_2", "rods_3"}));
  EXPECT_TRUE(fields().is_group("contacts.rod_lid"));
  EXPECT_FALSE(fields().is_group("movie"));
  EXPECT_FALSE(fields().is_group("contacts.rod"));
  EXPECT_EQ(fields().block_of(field_at("measure.tilt.every")), &field_at("measure.tilt"));
  EXPECT_EQ(fields().block_of(field_at("rods.length")), nullptr);
  EXPECT_EQ(field_index("rods"), -1);
}

TEST(Fields, SuggestPaths) {
  EXPECT_EQ(fields().suggest_path("rods.lenght"), "; did you mean rods.length?");
  EXPECT_EQ(fields().suggest_path("rod.length"), "; did you mean rods.length?");
  EXPECT_EQ(fields().suggest_path("length"), "; did you mean rods.length?");
  EXPECT_EQ(fields().suggest_path("box.frequency"), "; did you mean plates.frequency?");
  EXPECT_EQ(fields().suggest_path("movi"), "; did you mean movie?");
  EXPECT_EQ(fields().suggest_path("colour"), "");
}

// The table in docs/scene.md. To write it anew: SHAKEN_UPDATE_DOCS=1 and run this test.
TEST(Fields, TheReferenceIsUpToDate) {
  expect_generated(SHAKEN_SOURCE_DIR "/docs/scene.md", "keys", fields().as_markdown());
}

}  // namespace
}  // namespace shaken::scene
