// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "base/failure.h"
#include "bench/speed.h"
#include "scene/canonical.h"

namespace shaken::bench {
namespace {

using ::testing::HasSubstr;

Case kind_named(const std::string& name) {
  for (const SceneKind& kind : scene_kinds()) {
    if (name == kind.name) return case_of(kind, 0.5);
  }
  throw Failure(ExitCode::kFailed, "no kind " + name);
}

TEST(Kinds, CanAllBePlaced) {
  for (const SceneKind& kind : scene_kinds()) {
    const Result<Simulation> started = Simulation::start(case_of(kind, 0.5).system());
    EXPECT_TRUE(started) << kind.name << ": " << (started ? "" : started.error().message);
  }
}

TEST(Kinds, AreAllDifferentScenes) {
  std::set<std::string> names, scenes;
  for (const SceneKind& kind : scene_kinds()) {
    EXPECT_TRUE(names.insert(kind.name).second) << kind.name;
    EXPECT_TRUE(scenes.insert(scene::scene_hash(case_of(kind, 0.5).plan)).second) << kind.name;
  }
}

TEST(Kinds, BeginWithTheBase) {
  const Case base = case_of(scene_kinds().front(), 0.5);
  EXPECT_EQ(base.plan, make_case(4.5, 0.75, 41.865, kPaperStep, 0.5).plan);
}

TEST(Kinds, AreWhatTheirNamesSay) {
  EXPECT_EQ(kind_named("spheres").system().rod.n_beads, 1);
  EXPECT_TRUE(kind_named("two species").system().added[0]);
  EXPECT_EQ(kind_named("polar, annulus").system().walls->arena, Arena::kAnnulus);
  EXPECT_EQ(kind_named("polar, annulus").n_rods(), 175);
  EXPECT_EQ(kind_named("plates at rest").system().amplitude, 0);
}

TEST(Kinds, HaveARowEachWithTheirCost) {
  std::vector<CountedWork> measured;
  for (const SceneKind& kind : scene_kinds()) {
    CountedWork& counted = measured.emplace_back();
    counted.of = {.scene = case_of(kind, 0.5), .state = {}, .ticks = 1000};
    counted.of.speed.ticks = 1000;
    counted.of.speed.cpu = {0.1 * static_cast<double>(measured.size())};
    counted.of.speed.rod_seconds = 10;
    counted.of.speed.plate_impulses = 900;
    counted.of.speed.rod_impulses = 100;
    counted.counts.fill(500);
    counted.phases.fill(0.01);
    counted.cpu = 0.1;
  }
  const Report report = kinds_report({}, measured);
  ASSERT_EQ(report.rows().size(), scene_kinds().size());
  for (std::size_t k = 0; k < scene_kinds().size(); ++k) {
    const Json& row = report.rows().at(k);
    EXPECT_EQ(row.at("kind"), scene_kinds()[k].name);
    EXPECT_DOUBLE_EQ(row.at("relative_cost"), static_cast<double>(k + 1));
    EXPECT_DOUBLE_EQ(row.at("impulses_per_rod_second").at("plates"), 90);
    EXPECT_DOUBLE_EQ(row.at("per_rod_second").at("pairs_bounded"), 500 / measured[k].of.scene.rod_seconds(1000));
    EXPECT_DOUBLE_EQ(row.at("phase_shares").at("tightening"), 0.1);
    EXPECT_THAT(report.text, HasSubstr("\n" + std::string(scene_kinds()[k].name) + " "));
  }
}

}  // namespace
}  // namespace shaken::bench
