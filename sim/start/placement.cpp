#include "sim/start/placement.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "base/core/sincos.h"
#include "sim/motion/post_contacts.h"
#include "sim/motion/side_walls.h"
#include "sim/motion/start_motion.h"

namespace shaken {
namespace {

/// Radius of the thickest bead [mm].
double thickest(const Species& kind) { return *std::max_element(kind.bead_radius.begin(), kind.bead_radius.end()); }

}  // namespace

Vec2 unit_vector(double angle) {
  const SinCos along = sincos(angle);
  return {along.cos, along.sin};
}

Placement::Placement(const System& of_system, std::span<const Species> of_species,
                     std::span<const std::uint8_t> of_kinds)
    : system(of_system), plates(plates_at_start(of_system)), species(of_species), shape_of_rod(of_kinds) {
  if (system.posts) {
    StandingPosts standing = standing_posts(system);
    standing.diameter += 2.0 * (kClearance + shortened_by_tilt());
    posts_.emplace(standing, system.box(), period_of(system.box(), system.walls));
  }
  for (const Species& kind : of_species) {
    Beads ahead{kind.bead_offset, kind.bead_radius};
    Beads back = ahead;
    for (double& s : back.offset) s = -s;
    poses_.push_back(std::move(ahead));
    if (is_polar(kind)) poses_.push_back(std::move(back));
  }
}

bool Placement::is_polar(const Species& kind) {
  return !std::equal(kind.bead_radius.begin(), kind.bead_radius.end(), kind.bead_radius.rbegin());
}

double Placement::rod_extent() const {
  double extent = 0;
  for (const Species& kind : species) {
    for (int b = 0; b < kind.n_beads(); ++b)
      extent = std::max(extent, 2.0 * (std::abs(kind.bead_offset[b]) + kind.bead_radius[b]));
  }
  return extent;
}

double Placement::max_radius() const {
  double radius = 0;
  for (const Species& kind : species) radius = std::max(radius, thickest(kind));
  return radius;
}

double Placement::least_row_distance(double pitch, double shift) const {
  double least2 = 0;
  for (const Beads& one : poses_) {
    for (const Beads& other : poses_) least2 = std::max(least2, least_distance2(one, other, pitch, shift));
  }
  return std::sqrt(least2);
}

double Placement::least_distance2(const Beads& one, const Beads& other, double pitch, double shift) {
  double least2 = 0;
  for (std::size_t a = 0; a < one.offset.size(); ++a) {
    for (std::size_t b = 0; b < other.offset.size(); ++b) {
      const double touch = one.radius[a] + other.radius[b];
      double along = other.offset[b] - one.offset[a] + shift;
      along -= pitch * std::nearbyint(along / pitch);
      least2 = std::max(least2, touch * touch - along * along);
    }
  }
  return least2;
}

/// The most that a rod is tilted, as n_z; this keeps it off both plates.
double Placement::most_tilt(const Species& kind) const {
  if (system.is_planar() || !(kind.half_length > 0)) return 0.0;
  const double room = 0.5 * plates.gap - thickest(kind);
  return std::min(0.02, 0.3 * room / kind.half_length);
}

double Placement::shortened_by_tilt() const {
  double shorter = 0;
  for (const Species& kind : species) {
    const double tilt = most_tilt(kind);
    shorter = std::max(shorter, kind.half_length * (1.0 - std::sqrt(1.0 - tilt * tilt)));
  }
  return shorter;
}

bool Placement::is_clear(const Species& kind, const Pose& pose) const {
  return !(system.walls && !is_within(*system.walls, system.box(), kind, pose)) &&
         !(posts_ && !is_clear_of_posts(*posts_, kind, pose));
}

void Placement::lift_and_push(Flight& flight, const Species& kind, const Vec2& in_plane, bool flat, Rng& rng) const {
  const bool planar = system.is_planar();
  const auto [base, gap] = plates;
  const double room = 0.5 * gap - thickest(kind);
  flight.position.z() = base + 0.5 * gap + (planar ? 0.0 : 0.3 * room * rng.uniform(-1, 1));
  const double most = flat ? 0.0 : most_tilt(kind);
  const double tilt = most > 0 ? most * rng.uniform(-1, 1) : 0.0;
  const double level = std::sqrt(1.0 - tilt * tilt);
  flight.director = {level * in_plane.x(), level * in_plane.y(), tilt};
  push_at_start(flight, system, rng);
}

std::string Placement::amount(int count) const {
  double area = 0;
  for (int i = 0; i < n_rods(); ++i) area += species_of(i).area;
  char text[64];
  std::snprintf(text, sizeof text, "%d rods (area fraction %.3f)", count, area / n_rods() * count / system.area());
  return text;
}

Error Placement::does_not_fit(const std::string& why) const {
  return {amount(n_rods()) + " do not fit into the " + (system.walls ? "arena" : "box") + ": " + why};
}

}  // namespace shaken
