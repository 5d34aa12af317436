#include "sim/overlaps.h"

#include <algorithm>
#include <optional>

#include "sim/close_up.h"
#include "sim/contact/bead_contacts.h"
#include "sim/motion/post_contacts.h"
#include "sim/motion/side_walls.h"
#include "sim/neighbors/neighbor_list.h"

namespace shaken {

namespace {

constexpr double kNear = 0.01;  ///< skin of the neighbour list [mm]

/// Calls found(surface, depth) for every surface that the rod overlaps.
template <class Found>
void each_surface_in(const World& world, const std::optional<PostGrid>& posts, const Species& species, const Pose& pose,
                     const Found& found) {
  const PlateState plates = world.plates.at(world.tick);
  double base = 0, lid = 0, wall = 0;
  for (int b = 0; b < species.n_beads(); ++b) {
    const Vec3 centre = pose.position + species.bead_offset[b] * pose.director;
    const double radius = species.bead_radius[b];
    if (world.system.base) base = std::max(base, radius - (centre.z() - plates.base));
    if (world.system.lid) lid = std::max(lid, radius - (plates.lid - centre.z()));
    if (world.system.walls) {
      wall = std::max(wall, radius - distance_to_walls(*world.system.walls, world.system.box(), centre));
    }
  }
  if (base > 0) found(CloseUp::kBase, base);
  if (lid > 0) found(CloseUp::kLid, lid);
  if (wall > 0) found(CloseUp::kWall, wall);
  if (!posts) return;
  if (const double post = overlap_with_posts(*posts, species, pose); post > 0) found(CloseUp::kPost, post);
}

}  // namespace

std::vector<Overlap> find_overlaps(const World& world, std::span<const std::uint8_t> shape_of_rod,
                                   std::span<const Pose> poses) {
  std::vector<Overlap> overlaps;
  if (poses.empty()) return overlaps;
  const Box box = world.system.box();
  std::optional<PostGrid> posts;
  if (world.system.posts) posts.emplace(standing_posts(world.system), box, period_of(box, world.system.walls));
  for (std::size_t i = 0; i < poses.size(); ++i) {
    each_surface_in(world, posts, world.species[shape_of_rod[i]], poses[i], [&](int surface, double depth) {
      overlaps.push_back({static_cast<int>(i), surface, depth});
    });
  }
  NeighborList neighbors(world.species, shape_of_rod, box, kNear);
  neighbors.build(poses);
  std::vector<BeadContact> contacts;
  for (const auto& [i, j] : neighbors.pairs()) {
    contacts.clear();
    find_bead_contacts(world.species[shape_of_rod[i]], poses[i].director, world.species[shape_of_rod[j]],
                       poses[j].director, nearest_image(poses[i].position, poses[j].position, box), contacts);
    double deepest = 0;
    for (const BeadContact& contact : contacts) deepest = std::max(deepest, contact.overlap);
    if (deepest > 0) overlaps.push_back({i, j, deepest});
  }
  std::stable_sort(overlaps.begin(), overlaps.end(), [](const Overlap& a, const Overlap& b) { return a.rod < b.rod; });
  return overlaps;
}

}  // namespace shaken
