#include "sim/posts.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <tuple>
#include <vector>

#include "sim/motion/post_contacts.h"
#include "sim/start/compression.h"
#include "sim/start/from_another_run.h"
#include "sim/start/initial.h"
#include "tests/support/effort.h"
#include "tests/support/flying_rod.h"
#include "tests/support/good.h"
#include "tests/support/random_rods.h"

namespace shaken {
namespace posts_test {

TEST(StandingPosts, LatticeHasOneInTheMiddleOfEachPartOfTheBox) {
  const StandingPosts posts = standing_posts({.diameter = 2, .columns = 2, .rows = 3}, Box(20, 30), std::nullopt);
  const std::vector<Vec2> centres{{5, 5}, {15, 5}, {5, 15}, {15, 15}, {5, 25}, {15, 25}};
  EXPECT_EQ(posts.centres, centres);
  EXPECT_DOUBLE_EQ(posts.area(), 6 * kPi);
}

// Four by four in the square round a disc of 16 mm: sites 2 and 6 mm off the middle. The corners are 8.49 mm off.
TEST(StandingPosts, StandWithinTheWalls) {
  const SideWalls disc{.arena = Arena::kDisc, .size = 16};
  EXPECT_EQ(standing_posts({.diameter = 3, .columns = 4, .rows = 4}, 20, disc).centres.size(), 12U);
  EXPECT_EQ(standing_posts({.diameter = 3.5, .columns = 4, .rows = 4}, 20, disc).centres.size(), 4U);
  const SideWalls square{.arena = Arena::kSquare, .size = 16};
  EXPECT_EQ(standing_posts({.diameter = 4, .columns = 4, .rows = 4}, 20, square).centres.size(), 16U)
      << "they touch it";
  const SideWalls annulus{.arena = Arena::kAnnulus, .size = 16, .inner = 4};
  EXPECT_EQ(standing_posts({.diameter = 2, .columns = 4, .rows = 4}, 20, annulus).centres.size(), 8U);
  const SideWalls channel{.arena = Arena::kChannel, .size = 10};
  const StandingPosts along = standing_posts({.diameter = 4, .columns = 3, .rows = 1}, Box(30, 12), channel);
  EXPECT_EQ(along.centres, (std::vector<Vec2>{{5, 6}, {15, 6}, {25, 6}}));
  const SideWalls stadium{.arena = Arena::kStadium, .size = 10, .length = 10};
  EXPECT_EQ(standing_posts({.diameter = 2, .columns = 4, .rows = 2}, 24, stadium).centres.front(), Vec2(4.5, 9.5));
}

TEST(StandingPosts, TheirAreaIsNotForRods) {
  System system;
  system.box_side = 20;
  system.posts = Posts{.diameter = 2, .columns = 5, .rows = 4};
  EXPECT_DOUBLE_EQ(system.area(), 400 - 20 * kPi);
  system.walls = SideWalls{.arena = Arena::kSquare, .size = 16};
  EXPECT_DOUBLE_EQ(system.area(), 256 - 20 * kPi);
}

StandingPosts random_posts(test::Draw& draw, const Box& box) {
  StandingPosts posts{draw.uniform(0.1, 0.3) * box.shorter(), {}};
  for (int n = draw.integer(0, 30); n > 0; --n)
    posts.centres.emplace_back(box.x() * draw.uniform(0, 1), box.y() * draw.uniform(0, 1));
  if (draw.integer(0, 3) == 0) posts.centres.emplace_back(box.x(), 0);
  return posts;
}

/// All images of all posts whose axes are so near, looked for one by one.
std::vector<std::pair<double, double>> all_within(const StandingPosts& posts, const Vec2& period, const Vec2& point,
                                                  double reach) {
  std::vector<std::pair<double, double>> found;
  for (const Vec2& centre : posts.centres) {
    for (int i = -12; i <= 12; ++i) {
      for (int j = -12; j <= 12; ++j) {
        if ((i != 0 && period.x() == 0) || (j != 0 && period.y() == 0)) continue;
        const Vec2 image = centre + Vec2(i * period.x(), j * period.y());
        if ((image - point).norm() <= reach) found.emplace_back(image.x(), image.y());
      }
    }
  }
  std::sort(found.begin(), found.end());
  return found;
}

TEST(PostGrid, FindsWhatALookAtAllImagesFinds) {
  test::Draw draw(71);
  std::size_t n_found = 0;
  for (int trial = 0; trial < test::draws(4000); ++trial) {
    const Box box(draw.uniform(5, 40), draw.uniform(5, 40));
    const StandingPosts posts = random_posts(draw, box);
    const Vec2 period(draw.integer(0, 1) ? box.x() : 0.0, draw.integer(0, 1) ? box.y() : 0.0);
    const PostGrid grid(posts, box, period);
    EXPECT_EQ(grid.n_posts(), static_cast<int>(posts.centres.size()));
    const Vec2 point(box.x() * draw.uniform(-2, 3), box.y() * draw.uniform(-2, 3));
    const double reach = draw.uniform(0, 1.5) * box.shorter();
    std::vector<std::pair<double, double>> found;
    grid.for_each_within(point, reach, [&](int, const Vec2& centre) { found.emplace_back(centre.x(), centre.y()); });
    std::sort(found.begin(), found.end());
    const auto expected = all_within(posts, period, point, reach);
    ASSERT_EQ(found.size(), expected.size()) << "trial " << trial;
    for (std::size_t k = 0; k < found.size(); ++k) {
      ASSERT_NEAR(found[k].first, expected[k].first, 1e-9) << "trial " << trial;
      ASSERT_NEAR(found[k].second, expected[k].second, 1e-9) << "trial " << trial;
    }
    n_found += found.size();
  }
  EXPECT_GT(n_found, static_cast<std::size_t>(test::draws(10000)));
}

/// A rod that flies among posts, in a periodic box or one with an end, often about as far from the next as asked.
struct RodAmongPosts : test::FlyingRod {
  Box box;
  StandingPosts posts;
  Vec2 period;

  RodAmongPosts(test::Draw& draw, double gap)
      : box(draw.uniform(20, 50), draw.uniform(20, 50)),
        posts{draw.integer(0, 1) ? draw.uniform(0.2, 8) : 3.0, {}},
        period(box.x(), draw.integer(0, 3) ? box.y() : 0.0) {
    species = test::random_species(draw);
    for (int n = draw.integer(1, 12); n > 0; --n)
      posts.centres.emplace_back(box.x() * draw.uniform(0, 1), box.y() * draw.uniform(0, 1));
    Pose pose{Vec3(box.x() * draw.uniform(-1, 2), box.y() * draw.uniform(0, 1), 0.6),
              draw.flat_direction(draw.integer(0, 3) ? 0.38 : 1)};
    const Vec3 way = draw.flat_direction(0);
    for (int step = 0; step < 40; ++step) pose.position -= (overlap(pose) + gap) * way;
    begin(draw, pose, box);
  }

  /// The overlap of the deepest bead, negative if all are free: every bead and every image is looked at [mm].
  double overlap(const Pose& pose) const {
    double most = -box.longer();
    for (int b = 0; b < species.n_beads(); ++b) {
      const Vec3 bead = pose.position + species.bead_offset[b] * pose.director;
      for (const Vec2& centre : posts.centres) {
        Vec2 way = bead.head<2>() - centre;
        for (const int axis : {0, 1}) {
          if (period[axis] > 0) way[axis] = std::remainder(way[axis], period[axis]);
        }
        most = std::max(most, species.bead_radius[b] + 0.5 * posts.diameter - way.norm());
      }
    }
    return most;
  }
  PostGrid grid() const { return {posts, box, period}; }
  double safe_time() const {
    return post_safe_time(grid(), box, species, pose(), flight, horizon, gravity.along_size());
  }
};

TEST(PostSafeTime, NoBeadBeginsToTouchAPostBeforeItsBound) {
  test::Draw draw(72);
  std::vector<double> share;
  test::Tried tried;
  for (int trial = 0; trial < test::draws(60000); ++trial) {
    SCOPED_TRACE(trial);
    const RodAmongPosts rod(draw, (draw.integer(0, 9) ? 1 : -1) * std::pow(10.0, draw.uniform(-7, 0.5)));
    const bool is_timed = trial % test::draws(20) == 0;  // as many in every build
    ASSERT_NO_FATAL_FAILURE(test::expect_free_until_bound(rod, tried, is_timed ? &share : nullptr));
  }
  EXPECT_GT(tried.n_free, test::draws(40000));
  EXPECT_GT(tried.n_short, test::draws(10000));
  test::expect_tight("posts", share, 0.35);
}

TEST(PostContacts, OverlapIsThatOfTheDeepestBead) {
  test::Draw draw(73);
  int n_touch = 0, n_just = 0, n_denied = 0;
  for (int trial = 0; trial < test::draws(60000); ++trial) {
    const double size = std::pow(10.0, draw.uniform(-14, 0.5));
    const RodAmongPosts rod(draw, draw.integer(0, 1) ? size : -size);
    const double overlap = rod.overlap(rod.pose());
    const PostGrid grid = rod.grid();
    const double found = overlap_with_posts(grid, rod.species, rod.pose());
    const bool may = may_touch_posts(grid, rod.species, rod.pose());
    ASSERT_NEAR(found, std::max(0.0, overlap), 1e-12) << "trial " << trial;
    ASSERT_EQ(is_clear_of_posts(grid, rod.species, rod.pose()), !(found > 0)) << "trial " << trial;
    ASSERT_FALSE(overlap > 1e-12 && !may) << "trial " << trial;
    n_touch += overlap > 0;
    n_just += overlap > 0 && overlap < 1e-8;
    n_denied += !may;
  }
  EXPECT_GT(n_touch, test::draws(10000));
  EXPECT_GT(n_just, test::draws(2000));
  EXPECT_GT(n_denied, test::draws(1000));
}

// The tangent is met at once; the circle only where the sphere comes to it. It flies along a chord 3 mm off the axis of
// a post of radius 4.6 mm with its own 0.4: they touch 4 mm short of the middle of the chord.
TEST(PostSafeTime, OfASphereThatFliesAskewAtAPost) {
  const Species sphere = make_species({.length = 0.8, .mid_diameter = 0.8, .end_diameter = 0.8, .n_beads = 1});
  const Box box(60, 60);
  const PostGrid post({9.2, {Vec2(30, 30)}}, box, box.sides());
  Flight flight;
  flight.velocity = Vec3(-40, 0, 0);
  for (const double ahead : {0.4, 4.0}) {
    flight.position = Vec3(34 + ahead, 33, 0.6);
    flight.prepare();
    const auto bound = [&](double horizon) {
      return post_safe_time(post, box, sphere, {flight.position, flight.director}, flight, horizon, 0);
    };
    EXPECT_NEAR(bound(1.0), ahead / 40, 1e-6);
    EXPECT_LE(bound(1.0), ahead / 40);
    EXPECT_EQ(bound(0.2 * ahead / 40), 0.2 * ahead / 40);
  }
  flight.position = Vec3(38, 36, 0.6);  // it passes
  EXPECT_EQ(post_safe_time(post, box, sphere, {flight.position, flight.director}, flight, 0.4, 0), 0.4);
}

/// A weightless sphere of 1 mm, and a post of 4 mm with its axis at (10, 10) in a box of 20 mm.
System sphere_and_post(double restitution) {
  System system;
  system.rod = {.length = 1.0, .mid_diameter = 1.0, .end_diameter = 1.0, .n_beads = 1};
  system.box_side = 20;
  system.n_rods = 1;
  system.gravity = 0;
  system.base = system.lid = false;
  system.posts = Posts{.diameter = 4, .places = {Vec2(10, 10)}, .contact = {0.0, restitution}};
  return system;
}

// Head-on it comes back with e times its speed. It touches 2.5 mm from the axis, after 3.5 mm: at 20 mm/s, after
// 175 ms; in the next 25 ms it flies back.
TEST(Posts, ASphereBouncesOffAPostHeadOn) {
  const System system = sphere_and_post(0.5);
  Simulation simulation = test::flying(system, {{Vec3(16, 10, 0.6), Vec3(-20, 0, 0)}});
  ASSERT_FALSE(simulation.advance_to(static_cast<Tick>(0.2 / system.dt)).has_value());
  EXPECT_EQ(simulation.world().counters.impulses_rod_post, 1);
  EXPECT_EQ(simulation.world().counters.impulses_rod_wall, 0);
  EXPECT_GT(simulation.world().counters.max_overlap_rod_surface, 0);
  EXPECT_LE(simulation.world().counters.max_overlap_rod_surface, 20 * system.dt * (1 + 1e-9));
  EXPECT_NEAR(simulation.world().rods[0].velocity.x(), 10, 1e-12);
  EXPECT_NEAR(simulation.snapshot().position[0].x(), 12.5 + 0.25, 1e-3);
  EXPECT_NEAR(simulation.snapshot().position[0].y(), 10, 1e-12);
}

// At 1.5 mm off the axis the normal is (0.8, 0.6): of the velocity (-20, 0) the part along it, -16, becomes 16 e; with
// e = 1, (5.6, 19.2) remains.
TEST(Posts, ASphereBouncesOffAPostAskew) {
  System system = sphere_and_post(1.0);
  system.impacts = ImpactTime::kAtInstant;  // so that the normal is that of the instant
  Simulation simulation = test::flying(system, {{Vec3(16, 11.5, 0.6), Vec3(-20, 0, 0)}});
  ASSERT_FALSE(simulation.advance_to(static_cast<Tick>(0.4 / system.dt)).has_value());
  EXPECT_EQ(simulation.world().counters.impulses_rod_post, 1);
  EXPECT_NEAR(simulation.world().rods[0].velocity.x(), 5.6, 1e-3);
  EXPECT_NEAR(simulation.world().rods[0].velocity.y(), 19.2, 1e-3);
}

// It leaves the box at x = 20 and meets the image of a post that stands at the border.
TEST(Posts, ASphereMeetsAPostBeyondTheBorder) {
  System system = sphere_and_post(1.0);
  system.posts->places = {Vec2(1, 19)};
  for (const double y : {19.0, 0.5}) {  // of the second, the post is at y = -1
    Simulation simulation = test::flying(system, {{Vec3(15, y, 0.6), Vec3(20, 0, 0)}});
    ASSERT_FALSE(simulation.advance_to(static_cast<Tick>(0.3 / system.dt)).has_value());
    EXPECT_EQ(simulation.world().counters.impulses_rod_post, 1);
    const Vec3 velocity = simulation.world().rods[0].velocity;
    EXPECT_NEAR(velocity.norm(), 20, 1e-9);
    // the normal at which they touch: y is 1.5 of 2.5 off the axis, or 0
    const double across = y == 19 ? 0.0 : 0.6, along = y == 19 ? 1.0 : 0.8;
    EXPECT_NEAR(velocity.x(), 20 * (1 - 2 * along * along), 0.05);
    EXPECT_NEAR(velocity.y(), 20 * 2 * along * across, 0.05);
  }
}

// With friction the tangential velocity falls by mu times what the normal one changes by, while it slides.
TEST(Posts, FrictionOfAPostIsCoulombs) {
  System system = sphere_and_post(0.5);
  system.posts->contact.friction = 0.1;
  system.impacts = ImpactTime::kAtInstant;
  Simulation simulation = test::flying(system, {{Vec3(16, 11.5, 0.6), Vec3(-20, 0, 0)}});
  ASSERT_FALSE(simulation.advance_to(static_cast<Tick>(0.4 / system.dt)).has_value());
  const Vec3 velocity = simulation.world().rods[0].velocity;
  const Vec3 normal(0.8, 0.6, 0), tangent(-0.6, 0.8, 0);
  EXPECT_NEAR(velocity.dot(normal), 8, 1e-3);
  EXPECT_NEAR(velocity.dot(tangent), 12 - 0.1 * 24, 3e-3);
  system.posts->contact.own[Contacts::place(0, 1)].friction = 0.3;  // of a species that is not there
  Simulation same = test::flying(system, {{Vec3(16, 11.5, 0.6), Vec3(-20, 0, 0)}});
  ASSERT_FALSE(same.advance_to(static_cast<Tick>(0.4 / system.dt)).has_value());
  EXPECT_EQ(same.world().rods[0].velocity, velocity);
}

TEST(Posts, NoRodStartsInOne) {
  System system;
  system.box_side = 30;
  system.rod = {.length = 2.5, .bead_diameters{0.9, 0.8, 0.6, 0.4, 0.5, 0.7, 0.9}};
  system.posts = Posts{.diameter = 3, .columns = 3, .rows = 3};
  for (const auto& [start, n_rods] :
       {std::tuple{Start::kAligned, 150}, {Start::kRandom, 130}, {Start::kCompressed, 270}}) {
    system.start = start;
    system.n_rods = n_rods;
    const Result<World> world = test::good(is_compressed(start) ? make_compressed_world(system) : make_world(system));
    const PostGrid posts(standing_posts(system), system.box(), system.box().sides());
    for (const Flight& flight : world->rods)
      EXPECT_TRUE(is_clear_of_posts(posts, world->species[0], {flight.position, flight.director}));
    EXPECT_EQ(world->system, system);
  }
  // Long rods that lie askew reach further at one height than at another.
  system.rod = {.length = 4.5};
  system.gap = 2;
  system.posts = Posts{.diameter = 2, .columns = 4, .rows = 4};
  system.start = Start::kRandom;
  system.n_rods = 60;
  for (system.seed = 1; system.seed <= 5; ++system.seed) {
    const Result<World> world = test::good(make_world(system));
    const PostGrid posts(standing_posts(system), system.box(), system.box().sides());
    for (const Flight& flight : world->rods)
      EXPECT_TRUE(is_clear_of_posts(posts, world->species[0], {flight.position, flight.director}));
  }
}

TEST(Posts, AMessageSaysHowManyRodsFitAmongThem) {
  System system;
  system.box_side = 30;
  system.n_rods = 300;
  system.rod.length = 3;
  system.posts = Posts{.diameter = 6, .columns = 3, .rows = 3};
  EXPECT_THAT(test::refusal(make_world(system)), testing::HasSubstr("in rows at most"));
}

TEST(Posts, ARunGoesOnOnlyAmongTheSamePosts) {
  System system = sphere_and_post(0.5);
  System other = system;
  EXPECT_EQ(start_mismatch(system, other), "");
  other.posts->places = {Vec2(10, 9)};
  EXPECT_EQ(start_mismatch(system, other), "the posts");
  other = system;
  other.box_side = 21;
  EXPECT_EQ(start_mismatch(system, other), "the side of the box");
  other.posts.reset();
  EXPECT_EQ(start_mismatch(system, other), "the posts");
}

}  // namespace posts_test
}  // namespace shaken
