#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "base/core/box.h"
#include "base/core/types.h"
#include "sim/gravity.h"

namespace shaken {

/// How the radii of a rod's beads go along it.
enum class Profile {
  kSymmetric,  ///< from the centre bead down to both ends: the same fore and aft
  kPolar,      ///< from the tail down to the head, the end that the director points to
};

/// How the mass of a rod is distributed.
enum class Inertia {
  kSolid,  ///< as in a uniform solid, the union of its beads
  kBeads,  ///< as in its beads added up: each is uniform, and where two overlap there is twice the mass
};

/// How the rods of one species differ in size (polydispersity): each quantity is distributed normally about that of the
/// mean rod (sim/rod/sizes.h), independently of the other.
struct SizeSpread {
  double length = 0;        ///< standard deviation of the length over its mean; of a sphere, of its diameter
  double end_diameter = 0;  ///< that of the diameter of the ends over its mean
  bool is_any() const { return length > 0 || end_diameter > 0; }
  friend bool operator==(const SizeSpread&, const SizeSpread&) = default;
};

/// The shape of one species: equally spaced beads on a line, whose radius falls linearly from the centre bead to
/// the two ends (Sharma & Soni 2024, section 2), from tail to head, or goes as one likes.
struct RodShape {
  double length = 4.5;        ///< tip to tip [mm]
  double mid_diameter = 0.8;  ///< of the centre bead; polar: of the tail [mm]
  double end_diameter = 0.4;  ///< of the two end beads; polar: of the head [mm]
  int n_beads = 15;           ///< odd, unless each is given; 1 is a sphere of diameter `mid_diameter`
  double density = 8.5;       ///< [mg/mm^3]; brass. Sets the unit of energy only where all rods have the same
  Profile profile = Profile::kSymmetric;
  Inertia inertia = Inertia::kSolid;
  std::vector<double> bead_diameters{};  ///< (n_beads) from tail to head, in place of a profile; or empty [mm]
  SizeSpread spread{};                   ///< about all that, which then is the mean rod
  /// A sphere has none: it has no director, no order and no defects.
  bool has_axis() const { return n_beads > 1; }
  friend bool operator==(const RodShape&, const RodShape&) = default;
};

/// Rods of another species beside the first.
struct AddedRods {
  RodShape rod;
  int count = 1;
  friend bool operator==(const AddedRods&, const AddedRods&) = default;
};

/// Restitution and Coulomb's friction of two materials; what restitution is of, the impulse law says.
struct ContactParameters {
  double friction = 0.0;           ///< mu >= 0
  double restitution = 1.0;        ///< e in [0, 1]
  double restitution_speed = 0.0;  ///< at which e is so (sim/contact/restitution.h); 0: at every speed [mm/s]
  bool has_friction() const { return friction > 0; }
  /// Rods that do not bounce at all do not at any speed.
  bool has_restitution_speed() const { return restitution_speed > 0 && restitution > 0; }
  friend bool operator==(const ContactParameters&, const ContactParameters&) = default;
};

/// What one pair of materials has in place of the values that its kind of contact has in common.
struct OwnContact {
  std::optional<double> friction, restitution, restitution_speed;

  ContactParameters over(const ContactParameters& common) const {
    return {friction.value_or(common.friction), restitution.value_or(common.restitution),
            restitution_speed.value_or(common.restitution_speed)};
  }
  friend bool operator==(const OwnContact&, const OwnContact&) = default;
};

/// The species that a scene may have: rods, rods_2, rods_3, with the numbers 0, 1, 2.
inline constexpr std::size_t kMostSpecies = 3;

/// All contacts of one kind, such as those of two rods or of rod and base: what they have in common, which the first
/// species has, and what the added species have of their own.
struct Contacts : ContactParameters {
  Contacts() = default;
  Contacts(const ContactParameters& common)  // NOLINT(google-explicit-constructor): the same for all species
      : ContactParameters(common) {}
  Contacts(double mu, double e) : ContactParameters{mu, e} {}

  /// The contact of each pair with an added species: (0, 1), (1, 1), (0, 2), (1, 2), (2, 2). A surface meets species b
  /// as (0, b).
  std::array<OwnContact, 5> own{};
  /// The place of species a and b, in either order, of which one is added.
  static constexpr std::size_t place(std::size_t a, std::size_t b) {
    return a <= b ? b * (b + 1) / 2 + a - 1 : place(b, a);
  }
  /// The contact of rods of species a and b.
  ContactParameters of(std::size_t a, std::size_t b) const {
    return a + b > 0 ? own[place(a, b)].over(*this) : ContactParameters(*this);
  }
  /// The contact of a surface and rods of species b.
  ContactParameters of(std::size_t b) const { return of(0, b); }

  friend bool operator==(const Contacts&, const Contacts&) = default;
};

/// What becomes of the relative velocity at a contact (sim/contact/impulse_law.h).
enum class ImpulseLaw {
  kNewton,     ///< restitution of the normal velocity
  kPoisson,    ///< of the normal impulse
  kEnergetic,  ///< of the normal impulse's work; never makes energy
};
/// When an impact within a tick takes place.
enum class ImpactTime {
  kTickEnd,    ///< at the end of the tick, where it is found: what the paper does; first order in the tick
  kAtInstant,  ///< at the instant of touching, by going back along the free flights: second order
};
/// In which order the contacts of one tick get their impulses. No physics tells; statistics must not depend on it.
enum class ContactOrder {
  kSorted,    ///< by rods and beads
  kReversed,  ///< the other way round
  kShuffled,  ///< at random, anew in each tick
};
/// What moves the rods (the key `time.engine`); the trajectory is bitwise the same.
enum class StepperKind {
  kReference,  ///< visits every rod and pair at every tick
  kScheduled,  ///< visits them only when contact is possible
};
enum class Start {
  kAligned,     ///< rods in rows, along x or at an angle to it
  kRandom,      ///< random places and directions, one after the other (dilute systems)
  kCompressed,  ///< the same in a larger box, which then shrinks while the rods fly about (dense and disordered)
  kPolydomain,  ///< compressed, along the directors of several domains
  kDefectPair,  ///< compressed, along a director field with one defect of +1/2 and one of -1/2
};
/// Whether the rods are compressed into their box (sim/start/compression.h).
constexpr bool is_compressed(Start start) { return start != Start::kAligned && start != Start::kRandom; }

enum class Arena { kDisc, kSquare, kAnnulus, kStadium, kChannel, kEllipse, kWedge };
/// What scenes, files and messages call them.
inline constexpr std::array kArenaNames{std::pair{"disc", Arena::kDisc},       std::pair{"square", Arena::kSquare},
                                        std::pair{"annulus", Arena::kAnnulus}, std::pair{"stadium", Arena::kStadium},
                                        std::pair{"channel", Arena::kChannel}, std::pair{"ellipse", Arena::kEllipse},
                                        std::pair{"wedge", Arena::kWedge}};
constexpr const char* name_of(Arena arena) { return kArenaNames[static_cast<std::size_t>(arena)].first; }
constexpr std::optional<Arena> arena_of(std::string_view name) {
  for (const auto& [known, arena] : kArenaNames) {
    if (known == name) return arena;
  }
  return std::nullopt;
}
/// Walls that stand upright on the base and move with it, round an arena in the middle of the box. A stadium is two
/// half discs joined by straight walls along x; a channel has straight walls along x only, and is periodic along it; an
/// ellipse has its long axis along x; a wedge is a trapezoid, or a triangle, that narrows evenly towards larger x.
struct SideWalls {
  Arena arena = Arena::kDisc;
  double size = 40.0;   ///< diameter of disc, half discs or the annulus' outer wall; else along y, greatest [mm]
  double inner = 10.0;  ///< diameter of the annulus' inner wall [mm]
  Contacts contact{0.01, 0.3};
  double length = 40.0;  ///< of the stadium's straight walls; of ellipse and wedge along x [mm]
  double narrow = 0.0;   ///< extent of the wedge along y at its narrow end; 0: it is a triangle [mm]

  bool has_length() const { return arena == Arena::kStadium || is_as_long_as_its_length(); }
  /// Extents along x and y; a channel has no end along x, and 0 there [mm].
  Vec2 extent() const {
    if (arena == Arena::kChannel) return {0.0, size};
    if (is_as_long_as_its_length()) return {length, size};
    return {arena == Arena::kStadium ? size + length : size, size};
  }
  /// Area that the rods have to share, in the middle of such a box [mm^2].
  double area(const Box& box) const {
    if (arena == Arena::kChannel) return box.x() * size;
    if (arena == Arena::kSquare) return size * size;
    if (arena == Arena::kEllipse) return 0.25 * kPi * size * length;
    if (arena == Arena::kWedge) return 0.5 * (size + narrow) * length;
    const double between = arena == Arena::kStadium ? length * size : 0.0;
    return between + 0.25 * kPi * (size * size - (arena == Arena::kAnnulus ? inner * inner : 0.0));
  }
  friend bool operator==(const SideWalls&, const SideWalls&) = default;

 private:
  bool is_as_long_as_its_length() const { return arena == Arena::kEllipse || arena == Arena::kWedge; }
};

/// Round posts that stand upright on the base and move with it, all of one diameter: at the sites of a lattice, or at
/// given places (sim/posts.h).
struct Posts {
  double diameter = 4.0;       ///< [mm]
  int columns = 4;             ///< sites of the lattice along x
  int rows = 4;                ///< and along y
  std::vector<Vec2> places{};  ///< (n_posts) where their axes stand in the box, in place of a lattice; or empty [mm]
  Contacts contact{0.01, 0.3};
  friend bool operator==(const Posts&, const Posts&) = default;
};

/// A vibration of the plates along z beside the first: a2 cos(2 pi f2 t + phi2). It is that of the base, and of a lid
/// that moves with it.
struct SecondVibration {
  double amplitude = 0.01;   ///< a2 [mm]
  double frequency = 400.0;  ///< f2 [Hz]
  double phase = 0.0;        ///< phi2, of the second at the instant at which the first is at its highest [degrees]
  friend bool operator==(const SecondVibration&, const SecondVibration&) = default;
};

/// A lid that does not move with the base: d cos(2 pi f t + phi) about its mean height, at the plates' frequency f.
struct LidMotion {
  double amplitude = 0.0;  ///< d; 0: at rest [mm]
  double phase = 0.0;      ///< how far it is ahead of the base [degrees]
  friend bool operator==(const LidMotion&, const LidMotion&) = default;
};

/// After what the plane repeats itself along x and along y [mm]; 0 where side walls end it.
inline Vec2 period_of(const Box& box, const std::optional<SideWalls>& walls) {
  if (!walls) return box.sides();
  return {walls->arena == Arena::kChannel ? box.x() : 0.0, 0.0};
}

/// The physical system and how it is stepped: all that `make_world` needs. What to measure, record and draw is not
/// the simulation's business and lives in scene/keys/run_plan.h. The defaults are the paper's (Sharma & Soni 2024).
struct System {
  RodShape rod;
  int n_rods = 2109;                              ///< number of rods of this kind
  std::array<std::optional<AddedRods>, 2> added;  ///< other species
  double box_side = 83.73;                        ///< L, of the box along x; it is periodic in x and y [mm]
  double box_aspect = 1.0;                        ///< its side along y over that along x
  double gap = 1.2;                               ///< w, between base and lid [mm]

  double amplitude = 0.043486;        ///< a, of the plates' vibration [mm]; Gamma = a (2 pi f)^2 / g
  double frequency = 200.0;           ///< f, of the plates' vibration [Hz]
  double horizontal_amplitude = 0.0;  ///< b, of their vibration in the plane, at the same frequency [mm]
  double horizontal_phase = 0.0;      ///< how far that is ahead of the vibration along z [degrees]
  double horizontal_angle = 0.0;      ///< of its direction to the x axis [degrees]
  std::optional<SecondVibration> second;
  std::optional<LidMotion> lid_motion;
  double gravity = 9810.0;         ///< g, downwards [mm/s^2]
  double inclination = 0.0;        ///< of the plates to the horizontal [degrees]
  double inclination_angle = 0.0;  ///< of the direction down the slope to the x axis [degrees]
  bool base = true;                ///< whether there is a plate below
  bool lid = true;                 ///< whether there is one above
  std::optional<SideWalls> walls;
  std::optional<Posts> posts;

  Contacts rod_rod{0.05, 0.3};
  Contacts rod_base{0.01, 0.3};
  Contacts rod_lid{0.01, 0.3};
  ImpulseLaw law = ImpulseLaw::kNewton;
  int solver_sweeps = 1;  ///< passes over the contacts of one tick
  ContactOrder order = ContactOrder::kSorted;
  ImpactTime impacts = ImpactTime::kTickEnd;
  /// Roughness of the plates: each hit turns the rod about the vertical by this much per speed of the hit, to either
  /// side at random [rad/mm].
  double rotational_noise = 0.0;
  /// That of rods_2 and rods_3, where it is not that of the first species [rad/mm].
  std::array<std::optional<double>, 2> added_noise{};

  double dt = 4e-6;  ///< the tick [s]: the accuracy knob
  StepperKind stepper = StepperKind::kScheduled;
  Start start = Start::kAligned;
  double start_angle = 0.0;  ///< to the x axis: of aligned rods; of the director beyond a pair of defects [degrees]
  int start_domains = 4;     ///< of a polydomain start
  double start_separation = 41.865;  ///< of the two defects of a pair [mm]
  std::uint64_t seed = 1;

  int n_all_rods() const {
    int n = n_rods;
    for (const auto& more : added) n += more ? more->count : 0;
    return n;
  }
  /// Species `number` is there: the first always, others where they are added.
  bool has_species(std::size_t number) const {
    return number == 0 || (number <= added.size() && added[number - 1].has_value());
  }
  bool has_horizontal_vibration() const { return horizontal_amplitude > 0 && frequency > 0 && (base || lid); }
  bool has_second_vibration() const {
    return second && second->amplitude > 0 && second->frequency > 0 && (base || lid);
  }
  /// The lid does not move as the base does.
  bool has_lid_motion() const {
    return lid && lid_motion && (has_second_vibration() || *lid_motion != LidMotion{amplitude, 0.0});
  }
  /// There are plates, and they move.
  bool has_moving_plates() const {
    const bool moves = amplitude > 0 || horizontal_amplitude > 0 || (has_lid_motion() && lid_motion->amplitude > 0);
    return (moves && frequency > 0 && (base || lid)) || has_second_vibration();
  }
  /// The least height between base and lid [mm], and the largest speed of either [mm/s].
  double least_gap() const;
  double peak_plate_speed() const;
  /// The largest acceleration of the base along z; of two vibrations that of both at once [mm/s^2].
  double peak_acceleration() const {
    const auto peak = [](double a, double f) { return a * (2.0 * kPi * f) * (2.0 * kPi * f); };
    return peak(amplitude, frequency) + (second ? peak(second->amplitude, second->frequency) : 0.0);
  }
  bool has_inclination() const { return inclination > 0 && gravity > 0; }
  /// In the frame of the plates.
  Gravity gravity_on_plates() const;
  /// The base is too weak to throw rods, which come to rest on it.
  bool lets_rods_rest() const { return base && peak_acceleration() < gravity_on_plates().down; }
  /// The noise of rods of a species [rad/mm].
  double noise_of(std::size_t number) const {
    return number == 0 ? rotational_noise : added_noise[number - 1].value_or(rotational_noise);
  }
  bool has_rotational_noise() const {
    for (std::size_t number = 0; number < kMostSpecies; ++number) {
      if (has_species(number) && noise_of(number) > 0) return true;
    }
    return false;
  }
  bool has_impacts_at_instant() const { return impacts == ImpactTime::kAtInstant; }
  Box box() const { return Box::of_aspect(box_side, box_aspect); }
  /// Area that the rods have to share: that of the box or the arena, less that of the posts [mm^2].
  double area() const;
  /// Nothing pushes or pulls across the plane, and rods that start in it stay there to the last bit.
  bool is_planar() const { return !base && !lid && gravity == 0; }

  friend bool operator==(const System&, const System&) = default;
};

}  // namespace shaken
