#include "sim/posts.h"

#include "sim/motion/side_walls.h"

namespace shaken {

double StandingPosts::area() const { return static_cast<double>(centres.size()) * 0.25 * kPi * diameter * diameter; }

Vec2 rectangle_round(const Box& box, const std::optional<SideWalls>& walls) {
  if (!walls) return box.sides();
  return walls->arena == Arena::kChannel ? Vec2(box.x(), walls->size) : walls->extent();
}

bool stands_within(const Vec2& centre, double diameter, const Box& box, const std::optional<SideWalls>& walls) {
  constexpr double kRounding = 1e-9;  // of the box: a post may touch a wall
  if (!walls) return true;
  return distance_to_walls(*walls, box, Vec3(centre.x(), centre.y(), 0)) >= 0.5 * diameter - kRounding * box.longer();
}

StandingPosts standing_posts(const Posts& posts, const Box& box, const std::optional<SideWalls>& walls) {
  if (!posts.places.empty()) return {posts.diameter, posts.places};
  StandingPosts standing{posts.diameter, {}};
  const Vec2 around = rectangle_round(box, walls);
  for (int row = 0; row < posts.rows; ++row) {
    for (int column = 0; column < posts.columns; ++column) {
      const Vec2 part((column + 0.5) * around.x() / posts.columns, (row + 0.5) * around.y() / posts.rows);
      const Vec2 centre = 0.5 * (box.sides() - around) + part;
      if (stands_within(centre, posts.diameter, box, walls)) standing.centres.push_back(centre);
    }
  }
  return standing;
}

StandingPosts standing_posts(const System& system) {
  return system.posts ? standing_posts(*system.posts, system.box(), system.walls) : StandingPosts{};
}

double System::area() const { return (walls ? walls->area(box()) : box().area()) - standing_posts(*this).area(); }

}  // namespace shaken
