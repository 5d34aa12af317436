#include "sim/close_up.h"

#include <algorithm>
#include <optional>

#include "sim/contact/bead_contacts.h"
#include "sim/contact/impulse.h"
#include "sim/motion/post_contacts.h"
#include "sim/motion/side_walls.h"
#include "sim/neighbors/neighbor_list.h"

namespace shaken {
namespace {

std::optional<CloseUp::Rod> rod_seen(const World& world, Tick tick, int rod, bool concerned) {
  const auto i = static_cast<std::size_t>(rod);
  if (world.rods[i].since > tick) return {};
  const auto [pose, motion] = rod_at(world, i, tick);
  return CloseUp::Rod{rod, concerned, pose, motion};
}

void add_plate_contacts(const World& world, const CloseUp::Rod& rod, CloseUp& out) {
  const Species& species = world.species_of(static_cast<std::size_t>(rod.rod));
  for (const double side : {1.0, -1.0}) {  // base, lid
    if (!(side > 0 ? world.system.base : world.system.lid)) continue;
    for (int bead = 0; bead < species.n_beads(); ++bead) {
      const Vec3 center = rod.pose.position + species.bead_offset[bead] * rod.pose.director;
      const double plate = side > 0 ? out.plates.base : out.plates.lid;
      const double overlap = species.bead_radius[bead] - side * (center.z() - plate);
      if (!(overlap > 0)) continue;
      const Vec3 arm = center - rod.pose.position - species.bead_radius[bead] * side * Vec3::UnitZ();
      const double moving = side > 0 ? out.plates.velocity : out.plates.lid_velocity;
      const double u_n = side * (point_velocity(rod.motion, arm).z() - moving);
      out.contacts.push_back({rod.rod, side > 0 ? CloseUp::kBase : CloseUp::kLid, bead, -1, overlap, -u_n});
    }
  }
}

void add_upright_contact(const CloseUp::Rod& rod, int other, const Species& species, int bead, const WallSeen& seen,
                         CloseUp& out) {
  const double overlap = species.bead_radius[bead] - seen.distance;
  if (!(overlap > 0)) return;
  const Vec3 arm = species.bead_offset[bead] * rod.pose.director - species.bead_radius[bead] * seen.normal;
  const double u_n = point_velocity(rod.motion, arm).dot(seen.normal);
  out.contacts.push_back({rod.rod, other, bead, -1, overlap, -u_n});
}

void add_wall_contacts(const World& world, const CloseUp::Rod& rod, CloseUp& out) {
  if (!world.system.walls) return;
  const Species& species = world.species_of(static_cast<std::size_t>(rod.rod));
  for (int bead = 0; bead < species.n_beads(); ++bead) {
    const Vec3 center = rod.pose.position + species.bead_offset[bead] * rod.pose.director;
    const WallsSeen seen = see_walls(*world.system.walls, world.system.box(), center);
    for (int w = 0; w < seen.n; ++w) add_upright_contact(rod, CloseUp::kWall, species, bead, seen.walls[w], out);
  }
}

void add_post_contacts(const World& world, const CloseUp::Rod& rod, CloseUp& out) {
  if (!world.system.posts) return;
  const Species& species = world.species_of(static_cast<std::size_t>(rod.rod));
  const System& system = world.system;
  const PostGrid posts(standing_posts(system), system.box(), period_of(system.box(), system.walls));
  for (int bead = 0; bead < species.n_beads(); ++bead) {
    const Vec3 center = rod.pose.position + species.bead_offset[bead] * rod.pose.director;
    posts.for_each_within(center.head<2>(), posts.radius() + species.bead_radius[bead], [&](int, const Vec2& axis) {
      add_upright_contact(rod, CloseUp::kPost, species, bead, see_post(axis, posts.radius(), center), out);
    });
  }
}

void add_rod_contacts(const World& world, const CloseUp::Rod& i, const CloseUp::Rod& j, const Vec3& D, CloseUp& out) {
  std::vector<BeadContact> found;
  const Species& species_i = world.species_of(static_cast<std::size_t>(i.rod));
  const Species& species_j = world.species_of(static_cast<std::size_t>(j.rod));
  find_bead_contacts(species_i, i.pose.director, species_j, j.pose.director, D, found);
  for (const BeadContact& beads : found) {
    const Vec3 arm_i =
        species_i.bead_offset[beads.bead_i] * i.pose.director + species_i.bead_radius[beads.bead_i] * beads.normal;
    const Vec3 arm_j =
        species_j.bead_offset[beads.bead_j] * j.pose.director - species_j.bead_radius[beads.bead_j] * beads.normal;
    const double u_n = (point_velocity(j.motion, arm_j) - point_velocity(i.motion, arm_i)).dot(beads.normal);
    out.contacts.push_back({i.rod, j.rod, beads.bead_i, beads.bead_j, beads.overlap, -u_n});
  }
}

}  // namespace

const char* surface_name(int other) {
  if (other == CloseUp::kPost) return "post";
  if (other == CloseUp::kWall) return "side wall";
  return other == CloseUp::kBase ? "base" : "lid";
}

CloseUp look_closely(const World& world, Tick tick, const std::vector<int>& concerned, double reach) {
  CloseUp out;
  out.tick = tick;
  out.plates = world.plates.at(tick);
  std::vector<int> asked = concerned;
  std::sort(asked.begin(), asked.end());
  for (const int rod : asked) {
    if (const auto state = rod_seen(world, tick, rod, true)) {
      out.rods.push_back(*state);
    } else {
      out.unknown.push_back(rod);
    }
  }
  const std::size_t n_asked = out.rods.size();
  for (std::size_t a = 0; a < n_asked; ++a) {
    const CloseUp::Rod rod = out.rods[a];
    add_plate_contacts(world, rod, out);
    add_wall_contacts(world, rod, out);
    add_post_contacts(world, rod, out);
  }

  for (int other = 0; other < static_cast<int>(world.rods.size()); ++other) {
    const auto state = rod_seen(world, tick, other, false);
    if (!state) continue;
    const bool is_asked = std::binary_search(asked.begin(), asked.end(), other);
    bool is_near = false;
    for (std::size_t a = 0; a < n_asked; ++a) {
      const CloseUp::Rod rod = out.rods[a];
      if (rod.rod == other || (is_asked && rod.rod > other)) continue;
      const Vec3 D = nearest_image(rod.pose.position, state->pose.position, world.system.box());
      const Species& mine = world.species_of(static_cast<std::size_t>(rod.rod));
      const Species& its = world.species_of(static_cast<std::size_t>(other));
      const double near = mine.max_radius + its.max_radius + reach;
      const double distance2 =
          segment_distance_squared(D, rod.pose.director, mine.half_length, state->pose.director, its.half_length);
      if (!(distance2 < near * near)) continue;
      is_near = true;
      add_rod_contacts(world, rod, *state, D, out);
    }
    if (is_near && !is_asked) out.rods.push_back(*state);
  }
  return out;
}

}  // namespace shaken
