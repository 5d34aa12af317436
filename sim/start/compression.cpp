#include "sim/start/compression.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "sim/balance.h"
#include "sim/contact/bead_contacts.h"
#include "sim/motion/post_contacts.h"
#include "sim/motion/start_motion.h"
#include "sim/neighbors/neighbor_list.h"
#include "sim/start/director_patterns.h"
#include "sim/start/from_another_run.h"
#include "sim/start/initial.h"
#include "sim/stepping/stepper.h"

namespace shaken {
namespace {

constexpr double kLoose = 0.30;   ///< area fraction at which rods are inserted at random, where they can be
constexpr double kLooser = 0.75;  ///< times the last fraction where they could not
constexpr int kLoosenings = 12;

// in radii of the thinnest bead
constexpr double kThicker = 0.01;  ///< diameters of beads while the box shrinks
constexpr double kWay = 0.0025;    ///< of a rod in a tick, at the speed of a start
constexpr double kPushed = 0.025;  ///< deepest overlap that a step may make

constexpr double kMostChange = 0.003;     ///< of the side, and of the gap, in one step
constexpr double kLeastChange = 1e-5;     ///< else the rods first fly on
constexpr int kTicksBetween = 20;         ///< of two steps: a few times the way that a step has pushed rods together
constexpr int kTicksBetweenAligned = 60;  ///< the same of rods that follow a pattern
constexpr int kStepsToJam = 400;          ///< if side and gap come nearer to their aims by less than this meanwhile:
constexpr double kStandstill = 0.001;
constexpr int kRelaxationTicks = 5;
constexpr int kMostSettling = 2000;
constexpr int kFinerAfter = 50;  ///< attempts to relax, with half the tick

// of rods that follow a pattern
constexpr double kTurnTime = 0.0025;  ///< in which they turn by sin 2 delta, delta being the angle to it [s]
constexpr double kTipSpeed = 6.0;     ///< of the tip of a rod that turns, in speeds of a start
constexpr double kSmoothing = 1.0;    ///< of the field that turns them, in lengths of the longest rod

/// Thicker and longer by `more` all around the beads, whose centres stay where they are [mm]. So are all its sizes.
RodShape thicker(RodShape rod, double more) {
  rod.spread.length *= rod.length / (rod.length + more);
  rod.spread.end_diameter *= rod.end_diameter / (rod.end_diameter + more);
  rod.length += more;
  rod.mid_diameter += more;
  rod.end_diameter += more;
  for (double& diameter : rod.bead_diameters) diameter += more;
  return rod;
}

double area_of(const World& world) {
  double area = 0;
  for (std::size_t i = 0; i < world.shape_of_rod.size(); ++i) area += world.species_of(i).area;
  return area;
}

/// A step towards `aim` that changes `now` by at most `by` of it.
double step_towards(double aim, double now, double by) {
  if (by >= std::abs(1.0 - aim / now)) return aim;
  return aim < now ? now * (1.0 - by) : now * (1.0 + by);
}

/// Rods that fly about in a box that changes.
class Compression {
 public:
  Compression(const System& system, const GoOn& go_on)
      : system_(system),
        plates_(plates_at_start(system)),
        go_on_(go_on),
        pattern_(start_pattern(system)),
        aim_(empty_world(system)) {
    double longest = 0;
    for (const Species& species : aim_.species) {
      const auto [thin, thick] = std::minmax_element(species.bead_radius.begin(), species.bead_radius.end());
      thinnest_ = std::min(thinnest_, *thin);
      thickest_ = std::max(thickest_, *thick);
      longest = std::max({longest, 2.0 * *thick, 2.0 * species.half_length});
    }
    if (pattern_) field_.emplace(system.box(), pattern_, kSmoothing * longest);
  }

  /// From random places in a larger box.
  Result<World> from_random() {
    SHAKEN_TRY(insert());
    gap_ = world_.system.gap;
    return run();
  }

  /// From where they are in `left`.
  Result<World> from_rods_of(const World& left) {
    field_.reset();
    are_placed_ = false;
    System loose = gas();
    loose.box_side = left.system.box_side;
    const PlateState plates = left.plates.at(left.tick);
    loose.gap = left.system.has_lid_motion() ? plates.lid - plates.base : left.system.gap;
    thicken(loose, std::min(loose.gap, plates_.gap));
    gap_ = plates_.gap;
    world_ = empty_world(loose);
    poses_ = rods_left(world_, left).poses;
    motions_.resize(poses_.size());
    world_.rods.resize(poses_.size());
    const double base = system_.is_planar() ? 0.0 : plates.base;
    for (std::size_t i = 0; i < poses_.size(); ++i) {
      poses_[i].position.z() -= base;
      Flight flight;
      flight.director = poses_[i].director;
      Rng rng(system_.seed, RngStream::kVelocity, 1, static_cast<std::uint64_t>(i));
      push_at_start(flight, system_, rng);
      const Species& species = world_.species_of(i);
      motions_[i] = motion_after(flight, 0.0, Gravity(), flight.director, species.inertia_ratio);
    }
    fly_anew_in(loose.box_side, loose.gap);
    return run();
  }

 private:
  Result<World> run() {
    double former = INFINITY;
    for (int steps = 0; to_go() > 0; ++steps) {
      bool goes_on = true;
      if (steps % kStepsToJam == 0) {
        goes_on = to_go() < former - kStandstill;
        former = to_go();
      }
      SHAKEN_TRY(may_go_on(goes_on));
      approach();
      SHAKEN_TRY(fly(field_ ? kTicksBetweenAligned : kTicksBetween));
    }
    for (int tries = 1;; ++tries) {
      if (auto flights = relaxed()) {
        aim_.rods = *std::move(flights);
        aim_.start = content(aim_);
        return std::move(aim_);
      }
      SHAKEN_TRY(may_go_on(tries < kMostSettling));
      if (tries % kFinerAfter == 0) world_.system.dt *= 0.5;
      fly_anew_in(world_.system.box_side, world_.system.gap);
      SHAKEN_TRY(fly(kRelaxationTicks));
    }
  }

  /// How far side and gap are from their aims, in parts of these; 0 once they are there.
  double to_go() const {
    return std::abs(world_.system.box_side / system_.box_side - 1.0) + std::abs(world_.system.gap / gap_ - 1.0);
  }

  /// The system in which the rods fly about, but for its box, gap and thicker beads.
  System gas() const {
    System gas;  // of the scene's effects, it has those that follow
    gas.rod = system_.rod;
    gas.n_rods = system_.n_rods;
    gas.added = system_.added;
    gas.box_side = system_.box_side;
    gas.box_aspect = system_.box_aspect;
    gas.gap = system_.gap;
    gas.posts = system_.posts;
    gas.seed = system_.seed;
    gas.start = Start::kRandom;
    gas.amplitude = gas.gravity = 0;
    gas.base = gas.lid = !system_.is_planar();
    const ContactParameters elastic{0.0, 1.0};
    gas.rod_rod = gas.rod_base = gas.rod_lid = elastic;
    if (gas.posts) gas.posts->contact = elastic;
    gas.dt = kWay * thinnest_ / kStartSpeed;
    return gas;
  }

  /// Beads of the gas become thicker, if they still fit into `gap`.
  void thicken(System& gas, double gap) const {
    const double more = std::min(kThicker * thinnest_, 0.5 * (gap - 2.0 * thickest_));
    gas.rod = thicker(gas.rod, more);
    for (auto& added : gas.added) {
      if (added) added->rod = thicker(added->rod, more);
    }
  }

  /// Gives the box such a side. Posts, and the ways between them, are then as much larger than wanted as the box is.
  void resize(System& gas, double side) const {
    gas.box_side = side;
    if (!gas.posts) return;
    gas.posts->diameter = system_.posts->diameter * (side / system_.box_side);
    gas.posts->places = standing_posts(system_).centres;
    for (Vec2& place : gas.posts->places) place *= side / system_.box_side;
  }

  /// Rods at random places of a box that is larger than wanted, if need be.
  Result<void> insert() {
    System loose = gas();
    loose.gap = std::min(plates_.gap, 1.5 * 2.0 * thickest_);
    thicken(loose, loose.gap);
    const double fraction = area_of(aim_) / system_.area();
    double wanted = kLoose;
    for (int k = 1;; ++k, wanted *= kLooser) {
      resize(loose, system_.box_side * std::max(1.0, std::sqrt(fraction / wanted)));
      const double scale = system_.box_side / loose.box_side;
      const auto widened = [&](const Vec2& place) { return pattern_(scale * place); };
      Result<World> made = pattern_ ? make_world_along(loose, widened) : make_world(loose);
      if (!made && k < kLoosenings) continue;
      if (!made) return made.error();
      world_ = std::move(made).value();
      return {};
    }
  }

  /// Takes down where the rods are, and how they move.
  void look() {
    poses_.clear();
    motions_.clear();
    for (std::size_t i = 0; i < world_.rods.size(); ++i) {
      const Species& species = world_.species_of(i);
      const double tau = static_cast<double>(world_.tick - world_.rods[i].since) * world_.system.dt;
      poses_.push_back(pose_after(world_.rods[i], tau, 0.0));
      motions_.push_back(motion_after(world_.rods[i], tau, 0.0, poses_.back().director, species.inertia_ratio));
    }
  }

  /// Deepest overlap of rods of these species where the rods are now, with their centres moved together or apart: by
  /// `wide` along the plates and by `high` across.
  double deepest(const NeighborList& neighbors, const std::vector<Species>& species, double wide, double high) const {
    std::vector<BeadContact> contacts;
    double overlap = 0;
    for (const auto& [i, j] : neighbors.pairs()) {
      contacts.clear();
      Vec3 D = nearest_image(poses_[i].position, poses_[j].position, world_.system.box());
      D.x() *= wide;
      D.y() *= wide;
      D.z() *= high;
      find_bead_contacts(species[world_.shape_of_rod[i]], poses_[i].director, species[world_.shape_of_rod[j]],
                         poses_[j].director, D, contacts);
      for (const BeadContact& contact : contacts) overlap = std::max(overlap, contact.overlap);
    }
    return overlap;
  }

  /// Deepest overlap of beads and plates in such a gap, with all heights in proportion to it.
  double deepest_in_plates(double gap) const {
    double overlap = 0;
    for (std::size_t i = 0; i < poses_.size() && world_.system.lid; ++i) {
      const Species& species = world_.species_of(i);
      const double height = poses_[i].position.z() * (gap / world_.system.gap);
      for (int b = 0; b < species.n_beads(); ++b) {
        const double z = height + species.bead_offset[b] * poses_[i].director.z();
        overlap = std::max({overlap, species.bead_radius[b] - z, z + species.bead_radius[b] - gap});
      }
    }
    return overlap;
  }

  /// Deepest overlap of rods of these species and posts where the rods are now, with centres and posts moved together
  /// to a box of such a side.
  double deepest_in_posts(const std::vector<Species>& species, double side) const {
    if (!system_.posts) return 0;
    System resized = world_.system;
    resize(resized, side);
    const PostGrid posts(standing_posts(resized), resized.box(), period_of(resized.box(), resized.walls));
    double overlap = 0;
    for (std::size_t i = 0; i < poses_.size(); ++i) {
      Pose pose = poses_[i];
      pose.position *= side / world_.system.box_side;
      overlap = std::max(overlap, overlap_with_posts(posts, species[world_.shape_of_rod[i]], pose));
    }
    return overlap;
  }

  NeighborList neighbors() const {
    NeighborList list(world_.species, world_.shape_of_rod, world_.system.box(), NeighborList::kSkin);
    list.build(poses_);
    return list;
  }

  /// A step, as large as overlaps allow; none where rods overlap too much as it is.
  void approach() {
    look();
    const NeighborList near = neighbors();
    const double side = world_.system.box_side, gap = world_.system.gap;
    const double most = std::max(std::abs(1.0 - system_.box_side / side), std::abs(1.0 - gap_ / gap));
    for (double by = std::min(kMostChange, most);;) {
      const double new_side = step_towards(system_.box_side, side, by), new_gap = step_towards(gap_, gap, by);
      const bool is_apart = deepest(near, world_.species, new_side / side, new_gap / gap) <= kPushed * thinnest_ &&
                            (new_gap == gap || deepest_in_plates(new_gap) <= kPushed * thinnest_) &&
                            deepest_in_posts(world_.species, new_side) <= kPushed * thinnest_;
      if (is_apart) return fly_anew_in(new_side, new_gap);
      by *= 0.5;
      if (by < kLeastChange) return;
    }
  }

  /// Begins flights where the rods were when they were looked at last, their centres scaled with the box and the gap.
  void fly_anew_in(double side, double gap) {
    const double wide = side / world_.system.box_side, high = gap / world_.system.gap;
    if (field_) follow_field();
    resize(world_.system, side);
    if (gap != world_.system.gap) {
      world_.system.gap = gap;
      world_.plates = PlateMotion(0, world_.system.frequency, gap, world_.system.dt);
    }
    for (std::size_t i = 0; i < world_.rods.size(); ++i) {
      Pose pose = poses_[i];
      pose.position.x() *= wide;
      pose.position.y() *= wide;
      pose.position.z() *= high;
      const Species& species = world_.species_of(i);
      begin_flight(world_.rods[i], 0, pose, motions_[i], world_.system.box(), species.inertia_ratio);
    }
    world_.tick = 0;
  }

  /// Turns rods towards the directors of their places, as an aligning field would in a viscous medium, and keeps their
  /// velocities at those of a start, to which turns and hits would add.
  void follow_field() {
    double sum = 0;
    for (const Motion& motion : motions_) sum += motion.velocity.head<2>().squaredNorm();
    const double pace = kStartSpeed * std::sqrt(2.0 * static_cast<double>(motions_.size()) / sum);
    const double scale = system_.box_side / world_.system.box_side;
    for (std::size_t i = 0; i < poses_.size(); ++i) {
      const double fastest = kTipSpeed * kStartSpeed / std::max(thickest_, world_.species_of(i).half_length);
      const double turn =
          field_->torque(scale * poses_[i].position.head<2>(), poses_[i].director.head<2>()) / kTurnTime;
      motions_[i].velocity *= pace;
      motions_[i].angular_velocity *= pace;
      motions_[i].angular_velocity.z() = std::clamp(turn, -fastest, fastest);
    }
  }

  Result<void> may_go_on(bool there_is_hope) const {
    if (go_on_ && !go_on_()) return Error{"stopped"};
    if (there_is_hope) return {};
    return Error{jammed()};
  }

  std::string jammed() const {
    char text[160];
    const bool could_be_aligned = are_placed_ && aim_.species.size() == 1;
    std::snprintf(text, sizeof text, "the rods jammed at area fraction %.3f, before they were compressed to %.3f%s",
                  area_of(aim_) / world_.system.area(), area_of(aim_) / system_.area(),
                  could_be_aligned ? "; rods.start \"aligned\" packs more" : "");
    return text;
  }

  Result<void> fly(int ticks) {
    const auto stepper = make_stepper(world_, 1, 1);
    if (const auto trouble = stepper->advance_to(world_, world_.tick + ticks)) {
      return Error{jammed() + " (" + trouble->what + ")"};
    }
    return {};
  }

  bool is_between_plates(const Species& species, const Pose& pose) const {
    if (!world_.system.lid) return true;
    for (int b = 0; b < species.n_beads(); ++b) {
      const double z = pose.position.z() + species.bead_offset[b] * pose.director.z();
      if (z < species.bead_radius[b] || z > world_.system.gap - species.bead_radius[b]) return false;
    }
    return true;
  }

  /// The flights of the start, if no true rods overlap where they are now. Looks.
  std::optional<std::vector<Flight>> relaxed() {
    look();
    if (deepest(neighbors(), aim_.species, 1.0, 1.0) > 0) return std::nullopt;
    if (deepest_in_posts(aim_.species, world_.system.box_side) > 0) return std::nullopt;
    const double raised = plates_.base + 0.5 * (plates_.gap - world_.system.gap);
    std::vector<Flight> flights(poses_.size());
    for (std::size_t i = 0; i < poses_.size(); ++i) {
      if (!is_between_plates(aim_.species_of(i), poses_[i])) return std::nullopt;
      Flight& flight = flights[i];
      std::int32_t ignored = 0;
      flight.position = poses_[i].position;
      wrap(flight.position.x(), ignored, aim_.system.box().x());
      wrap(flight.position.y(), ignored, aim_.system.box().y());
      flight.position.z() += raised;
      flight.director = poses_[i].director;
      Rng rng(system_.seed, RngStream::kVelocity, 0, static_cast<std::uint64_t>(i));
      push_at_start(flight, system_, rng);
    }
    return flights;
  }

  const System& system_;
  PlatesAtStart plates_;  ///< between which the rods are in the end
  const GoOn& go_on_;
  DirectorAt pattern_;                  ///< of the box that is wanted; or none
  std::optional<AligningField> field_;  ///< that turns rods towards it
  World aim_;                           ///< without its rods
  World world_;                         ///< in which they fly about
  double thinnest_ = INFINITY;
  double thickest_ = 0;
  double gap_ = 0;          ///< aim of the gap while they do [mm]
  bool are_placed_ = true;  ///< as the scene says, not as another run has left them
  std::vector<Pose> poses_;
  std::vector<Motion> motions_;
};

}  // namespace

Result<World> make_compressed_world(const System& system, const GoOn& go_on) {
  if (system.walls) return Error{"rods can be compressed in a periodic box only, without walls"};
  return Compression(system, go_on).from_random();
}

Result<World> make_resized_world(const System& system, const World& left, const GoOn& go_on) {
  SHAKEN_TRY(check_left(system, left));
  if (system.walls) return Error{"rods can be compressed in a periodic box only, without walls"};
  return Compression(system, go_on).from_rods_of(left);
}

}  // namespace shaken
