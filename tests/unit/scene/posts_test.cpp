// The block `posts` of a scene: what follows from it, and what is refused.
#include "sim/posts.h"

#include <gmock/gmock.h>

#include <set>
#include <string>

#include "scene/canonical.h"
#include "scene/keys/derived.h"
#include "scene/keys/observables.h"
#include "scene/placement.h"
#include "tests/unit/scene/scene_support.h"

namespace shaken::scene {
namespace {

using testing::EndsWith;
using testing::HasSubstr;

TEST(Posts, ASceneWithoutThemHasNone) {
  EXPECT_FALSE(plan_of("{}").system.posts.has_value());
  EXPECT_FALSE(plan_of(R"({"posts": null})").system.posts.has_value());
  EXPECT_FALSE(to_json(plan_of("{}")).contains("posts"));
}

TEST(Posts, ALatticeByItsColumnsAndRows) {
  const System system =
      plan_of(R"({"box": {"side": 40}, "posts": {"diameter": "3 mm", "columns": 5, "rows": 2}})").system;
  EXPECT_EQ(*system.posts, (Posts{.diameter = 3, .columns = 5, .rows = 2}));
  EXPECT_EQ(standing_posts(system).centres.front(), Vec2(4, 10));
}

TEST(Posts, PlacesOneByOne) {
  const RunPlan plan = plan_of(R"({"box": {"side": 40}, "posts": {"places": [[10, 12.5], ["2 cm", 12.5]]}})");
  const std::vector<Vec2> places{{10, 12.5}, {20, 12.5}};
  EXPECT_EQ(plan.system.posts->places, places);
  const auto canonical = to_json(plan).at("posts");
  EXPECT_EQ(canonical.dump(),
            R"({"diameter":4.0,"places":[[10.0,12.5],[20.0,12.5]],"friction":0.01,"restitution":0.3})");
}

TEST(Posts, ReadBackAsTheIdenticalPlan) {
  for (const char* text :
       {R"({"posts": {}})", R"({"posts": {"diameter": 7, "columns": 3, "restitution": 0.9}})",
        R"({"posts": {"places": [[0, 0], [83.73, 40], [9, 9]], "friction": 0.2}})",
        R"({"walls": {"arena": "disc"}, "posts": {"diameter": 3}})",
        R"({"walls": {"arena": "stadium", "size": 30}, "posts": {"diameter": 3, "columns": 8}})",
        R"({"walls": {"arena": "channel", "size": 30}, "posts": {"diameter": 3, "rows": 2}, "rods": {"count": 90}})",
        R"({"rods": {"count": 200, "area_fraction": 0.4}, "posts": {"columns": 3, "rows": 3}})",
        R"({"rods": {"start": "compressed"}, "rods_2": {"count": 5}, "posts": {"rods_2": {"friction": 0.5}}})"}) {
    const RunPlan plan = plan_of(text);
    EXPECT_EQ(plan_of(to_json(plan).dump()), plan) << text;
  }
}

// Rods share what posts leave: of 1600 mm^2, 16 posts of 6 mm take 144 pi.
TEST(Posts, AreaFractionsAreOfTheAreaThatTheyLeave) {
  const RunPlan plan = plan_of(R"({"rods": {"area_fraction": 0.5}, "box": {"side": 40}, "posts": {"diameter": 6}})");
  const double rod = species_of(plan.system.rod).area;
  EXPECT_EQ(plan.system.n_rods, std::lround(0.5 * (1600 - 144 * kPi) / rod));
  EXPECT_NEAR(area_fraction_of(plan.system), 0.5, 1e-3);
}

TEST(Posts, ABoxThatFollowsFromRodsHasRoomForPostsToo) {
  const RunPlan plan = plan_of(R"({"rods": {"count": 200, "area_fraction": 0.4}, "posts": {"columns": 3, "rows": 3}})");
  const double free = 200 * species_of(plan.system.rod).area / 0.4;
  EXPECT_NEAR(plan.system.box_side * plan.system.box_side, free + 36 * kPi, 1e-9);
}

TEST(Posts, ContactsOfSpeciesAreTheirOwn) {
  const System system =
      plan_of(
          R"({"rods_2": {"count": 5}, "posts": {"friction": 0.1, "rods_2": {"friction": 0.4, "restitution": 0.3}}})")
          .system;
  EXPECT_EQ(system.posts->contact.of(0), (ContactParameters{0.1, 0.3, 0}));
  EXPECT_EQ(system.posts->contact.of(1), (ContactParameters{0.4, 0.3, 0}));
  EXPECT_FALSE(system.posts->contact.own[Contacts::place(0, 1)].restitution.has_value());
  EXPECT_THAT(problem_of(R"({"posts": {"rods_2": {"friction": 0.4}}})"),
              HasSubstr("posts.rods_2.friction is about rods_2"));
}

TEST(PostProblems, PlacesAndALattice) {
  EXPECT_EQ(
      problem_of(R"({"posts": {"places": [[1, 2]], "rows": 3}})"),
      "run.json:1:40: /posts/rows: posts stand at posts.places or at the sites of a lattice: remove posts.places, "
      "or posts.columns and posts.rows");
}

TEST(PostProblems, PlacesThatAreNone) {
  EXPECT_EQ(
      problem_of(R"({"posts": {"places": []}})"),
      "run.json:1:22: /posts/places: expected a list of at most 1000 pairs of numbers, [[a, b], [c, d], ...], not "
      "an array");
  EXPECT_THAT(problem_of(R"({"posts": {"places": [1, 2]}})"), HasSubstr("/posts/places: expected a list of at most"));
  EXPECT_THAT(problem_of(R"({"posts": {"places": [[1, -2]]}})"),
              EndsWith("/posts/places: -2 mm is outside [0, 2000] mm"));
  EXPECT_THAT(problem_of(R"({"posts": {"places": [[1, "2 s"]]}})"), HasSubstr("a unit of time, not of length"));
  EXPECT_THAT(problem_of(R"({"box": {"side": 40}, "posts": {"places": [[30, 41]]}})"),
              EndsWith("the post at [30, 41] mm stands outside of the box, 40 mm by 40 mm"));
  EXPECT_THAT(problem_of(R"({"walls": {"arena": "disc", "size": 30}, "box": {"side": 40},
                             "rods": {"area_fraction": 0.3}, "posts": {"diameter": 2, "places": [[34.1, 20]]}})"),
              EndsWith("the post at [34.1, 20] mm does not stand within the walls: its axis must be 1 mm from them"));
}

TEST(PostProblems, PostsThatOverlap) {
  EXPECT_THAT(problem_of(R"({"box": {"side": 40}, "posts": {"places": [[5, 5], [12, 30], [12, 33]]}})"),
              EndsWith("the posts at [12, 30] mm and [12, 33] mm overlap: they are 3 mm apart, and 4 mm thick"));
  EXPECT_THAT(problem_of(R"({"box": {"side": 40}, "posts": {"places": [[1, 5], [39, 5]]}})"),
              EndsWith("the posts at [1, 5] mm and [39, 5] mm overlap: they are 2 mm apart, and 4 mm thick"));
  EXPECT_THAT(problem_of(R"({"box": {"side": 40}, "posts": {"diameter": 5, "columns": 10}})"),
              EndsWith("posts of 5 mm overlap: 10 columns in 40 mm stand 4 mm apart"));
  EXPECT_THAT(problem_of(R"({"box": {"side": 40}, "posts": {"diameter": 5, "columns": 2, "rows": 9}})"),
              EndsWith("posts of 5 mm overlap: 9 rows in 40 mm stand 4.444444444 mm apart"));
  // those that touch do not
  EXPECT_TRUE(load_scene(R"({"box": {"side": 40}, "posts": {"places": [[5, 5], [9, 5], [12.2, 7.4]]}})", "f"));
  EXPECT_TRUE(load_scene(R"({"box": {"side": 40}, "posts": {"diameter": 4, "columns": 10, "rows": 3}})", "f"));
}

TEST(PostProblems, PostsThatLeaveNoRoom) {
  EXPECT_THAT(problem_of(R"({"box": {"side": 20}, "posts": {"diameter": 9, "columns": 3, "rows": 3}})"),
              HasSubstr("9 posts of 9 mm leave no room for rods"));
  EXPECT_THAT(problem_of(R"({"box": {"side": 20}, "posts": {"diameter": 19.5, "columns": 1, "rows": 1}})"),
              EndsWith("a post of 19.5 mm is 0.5 mm from its own image, so that beads of 0.8 mm would touch both: make "
                       "it thinner, or the box larger"));
  EXPECT_THAT(
      problem_of(R"({"walls": {"arena": "disc", "size": 20}, "posts": {"diameter": 9, "columns": 2, "rows": 2}})"),
      HasSubstr("no post of 9 mm stands within the walls"));
  // no rod of 4.5 mm fits between them, whatever the area
  const Loaded<Sweep> refused = load_runs(R"({"rods": {"count": 4}, "box": {"side": 20},
                                             "posts": {"diameter": 4.7, "columns": 4, "rows": 4}})",
                                          "f");
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().front().message, HasSubstr("in rows at most 0 rods"));
}

TEST(PostProblems, WhatAPlaneWithPostsDoesNotHave) {
  EXPECT_EQ(problem_of(R"({"posts": {}, "measure": {"g2": {}}})"),
            "run.json:1:33: /measure/g2: measure.g2 is of lines of sight, which posts interrupt: remove it or posts");
  EXPECT_THAT(
      problem_of(R"({"posts": {}, "measure": {"structure": {}}})"),
      EndsWith("measure.structure is of the waves of a periodic box, which posts interrupt: remove it or posts"));
  const std::set<std::string> lost{"defects", "fluctuations", "frank", "g2",     "pairs",       "layers",
                                   "lattice", "structure",    "flow",  "mixing", "defect_maps", "density"};
  for (const Observable& one : observables())
    EXPECT_NE(!!load_scene(R"({"posts": {}, "measure": {")" + one.name + R"(": {}}})", "f"), lost.contains(one.name))
        << one.name;
  EXPECT_THAT(problem_of(R"({"posts": {}, "rods": {"start_angle": 30}})"),
              HasSubstr("remove rods.start_angle or posts"));
}

TEST(RunId, DependsOnPosts) {
  const std::string id = run_id(plan_of(R"({"posts": {}})"));
  EXPECT_NE(id, run_id(plan_of("{}")));
  EXPECT_EQ(id, run_id(plan_of(R"({"posts": {"columns": 4, "restitution": 0.3}})")));
  EXPECT_NE(id, run_id(plan_of(R"({"posts": {"columns": 5}})")));
}

}  // namespace
}  // namespace shaken::scene
