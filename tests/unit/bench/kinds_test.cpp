// SPDX-License-Identifier: MIT
#include "bench/kinds.h"

#include <gtest/gtest.h>

#include <set>

#include "base/failure.h"
#include "scene/canonical.h"

namespace shaken::bench {
namespace {

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

}  // namespace
}  // namespace shaken::bench
