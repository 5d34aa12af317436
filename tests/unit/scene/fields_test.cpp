#include "scene/keys/fields.h"

#include <fnmatch.h>

#include <set>
#include <sstream>

#include "scene/canonical.h"
#include "scene/keys/settings.h"
#include "sim/effects/registry.h"
#include "tests/support/everything_on.h"
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

// An effect that is switched off changes keys that its line names, or turns off the block that they are in.
TEST(Fields, AreAllThatAnEffectSwitchesOff) {
  RunPlan on;
  on.system = test::everything_on();
  for (const Effect& effect : all_effects()) {
    const auto is_named = [&](const Field& key) {
      std::istringstream patterns{std::string(effect.keys)};
      for (std::string pattern; patterns >> pattern;) {
        if (fnmatch(pattern.c_str(), key.path.c_str(), 0) == 0) return true;
      }
      return false;
    };
    RunPlan off = on;
    if (effect.switch_off != nullptr) effect.switch_off(off.system);
    for (const Field& key : fields()) {
      const bool follows = key.path == "plates.gamma" || key.path.ends_with("area_fraction");
      if (fields().value(off, key) == fields().value(on, key) || is_named(key) || follows) continue;
      const Field* block = key.form == Form::kBlock ? &key : fields().block_of(key);
      const bool is_gone = block != nullptr && block->fetch(off) == Value(false) &&
                           std::ranges::any_of(fields(), [&](const Field& other) {
                             return fields().block_of(other) == block && is_named(other);
                           });
      EXPECT_TRUE(is_gone) << effect.name << " changes " << key.path;
    }
  }
}

TEST(Settings, ReplaceWhatTheFileSays) {
  const std::string text = R"({"rods": {"length": 4.5}, "time": {"seed": 3}})";
  EXPECT_EQ(plan_of(text, {"rods.length=2.5 mm"}).system.rod.length, 2.5);
  EXPECT_EQ(plan_of(text, {"rods.length=2.5"}).system.rod.length, 2.5);
  EXPECT_EQ(plan_of(text, {"rods.length=\"2500 um\""}).system.rod.length, 2.5);
  EXPECT_EQ(plan_of(text, {" rods.length = 2.5 ", "rods.length=3.5"}).system.rod.length, 3.5);
  EXPECT_EQ(plan_of(text, {"time.steady=auto"}).steady, std::nullopt);
  EXPECT_EQ(plan_of(text, {"time.steady=2 s"}).steady, 2.0);
  EXPECT_EQ(plan_of(text, {"rods.start=random", "rods.area_fraction=0.1"}).system.start, Start::kRandom);
  EXPECT_EQ(plan_of(text, {"contacts.rod_rod={\"friction\":0.2}"}).system.rod_rod, (Contacts{0.2, 0.3}));
}

TEST(Settings, SwitchBlocksOnAndOff) {
  const RunPlan on = plan_of("{}", {"measure.tilt={}", "movie.size=[640,480]", "trajectory.every=2 ms"});
  EXPECT_TRUE(on.order);  // a setting adds to what is there
  EXPECT_TRUE(on.tilt);
  EXPECT_EQ(on.movie, (Movie{0.05, 640, 480}));
  EXPECT_EQ(on.trajectory, Trajectory{0.002});
  const RunPlan off = plan_of(R"({"movie": {}, "measure": {"msd": {}}})", {"movie=null", "stream=false", "measure={}"});
  EXPECT_FALSE(off.movie || off.stream || off.msd || off.order);
}

TEST(Settings, NullTakesAKeyBack) {
  const std::string text = R"({"rods": {"area_fraction": 0.5}, "box": {"side": 40}})";
  EXPECT_EQ(plan_of(text, {"rods.area_fraction=null", "rods.count=300"}).system.n_rods, 300);
  EXPECT_NEAR(plan_of(text, {"box.side=null", "rods.count=300"}).system.box_side, 38.67, 0.01);
}

TEST(Settings, ProblemsNameTheSetting) {
  EXPECT_EQ(problem_of("{}", {"rods.lenght=2"}),
            "-s rods.lenght=2: /rods/lenght: unknown key; did you mean rods.length?");
  EXPECT_EQ(problem_of("{}", {"lengh=2"}), "-s lengh=2: /lengh: unknown key");
  EXPECT_EQ(problem_of("{}", {"rods.length"}), "-s rods.length: expected path=value, for example rods.length=2.5");
  EXPECT_EQ(problem_of("{}", {"=3"}), "-s =3: expected path=value, for example rods.length=2.5");
  EXPECT_EQ(problem_of("{}", {"box.gap=0.7"}),
            "-s box.gap=0.7: /box/gap: a gap of 0.7 mm is too small for rods 0.8 mm thick");
  EXPECT_EQ(problem_of("{}", {"movie={\"size\": [2,"}),
            "-s movie={\"size\": [2,: /movie: expected an object, not the text \"{\"size\": [2,\"");
  EXPECT_EQ(problem_of("{}", {"rods.length=2.5,3.5"}),
            "-s rods.length=2.5,3.5: /rods/length: 2 values make a sweep; a single scene takes one");
  EXPECT_EQ(problem_of("{}", {"rods.length=2.5:4.5:0.5"}),
            "-s rods.length=2.5:4.5:0.5: /rods/length: 5 values make a sweep; a single scene takes one");
  EXPECT_EQ(problem_of("{}", {"rods.length="}), "-s rods.length=: /rods/length: \"\" is not a number");
}

TEST(Settings, ADecimalCommaIsNotTakenForTwoValues) {
  EXPECT_EQ(problem_of("{}", {"box.gap=1,3 mm"}),
            "-s box.gap=1,3 mm: /box/gap: one number with a decimal comma, or two values? Write 1.3 mm, or 1 mm,3 mm");
  EXPECT_EQ(problem_of("{}", {"box.gap=1,3"}),
            "-s box.gap=1,3: /box/gap: 2 values make a sweep; a single scene takes one")
      << "a list, as ever";
}

TEST(Settings, CommasInsideOfBracketsAndQuotesDoNotSeparate) {
  std::vector<Problem> problems;
  EXPECT_EQ(parse_setting("a=[1,2],{\"b\":[3,4]},\"x,y\"", problems)->value.items.size(), 3u);
  EXPECT_EQ(parse_setting("a=\"x\\\",y\"", problems)->value.kind, Node::Kind::kString);
  EXPECT_EQ(parse_setting("a=b=c", problems)->value.text, "b=c");
  EXPECT_TRUE(problems.empty());
}

}  // namespace
}  // namespace shaken::scene
