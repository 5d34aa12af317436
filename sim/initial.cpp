// SPDX-License-Identifier: MIT
#include "sim/initial.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numeric>
#include <optional>
#include <string>
#include <tuple>

#include "base/core/check.h"
#include "base/core/rng.h"
#include "sim/balance.h"
#include "sim/contact/bead_contacts.h"
#include "sim/motion/post_contacts.h"
#include "sim/motion/side_walls.h"
#include "sim/neighbors/neighbor_list.h"
#include "sim/turned_rows.h"

namespace shaken {
namespace {

constexpr double kTurnSpeed = 5.0;     ///< of each angular velocity component across the rod [rad/s]
constexpr double kClearance = 0.002;   ///< least distance between rods of the lattice [mm]
constexpr double kKick = 1e-6;         ///< of a velocity, that sets replicas from one state apart
constexpr int kMaxInsertions = 20000;  ///< tries for one rod of a random start

Lattice every_other_row_shifted(int columns, int rows, double clearance = 0) {
  return {columns, rows, rows / 2, clearance};
}

/// Radius of the thickest bead [mm].
double thickest(const Species& kind) { return *std::max_element(kind.bead_radius.begin(), kind.bead_radius.end()); }

/// The most that a rod is tilted, as n_z; this keeps it off both plates.
double most_tilt(const System& system, double gap, const Species& species) {
  if (system.is_planar() || !(species.half_length > 0)) return 0.0;
  const double room = 0.5 * gap - thickest(species);
  return std::min(0.02, 0.3 * room / species.half_length);
}

/// By how much any rod is shorter in the plane, on either side, for being tilted [mm].
double shortened_by_tilt(const System& system, double gap, std::span<const Species> species) {
  double shorter = 0;
  for (const Species& kind : species) {
    const double tilt = most_tilt(system, gap, kind);
    shorter = std::max(shorter, kind.half_length * (1.0 - std::sqrt(1.0 - tilt * tilt)));
  }
  return shorter;
}

/// The species to be placed, and how each may lie along x.
class Placement {
 public:
  Placement(const System& for_scene, std::span<const Species> of_species, std::span<const std::uint8_t> of_kinds)
      : system(for_scene), plates(plates_at_start(for_scene)), species(of_species), shape_of_rod(of_kinds) {
    if (system.posts) {
      StandingPosts standing = standing_posts(system);
      standing.diameter += 2.0 * (kClearance + shortened_by_tilt(system, plates.gap, species));
      posts.emplace(standing, system.box(), period_of(system.box(), system.walls));
    }
    for (const Species& kind : of_species) {
      Beads ahead{kind.bead_offset, kind.bead_radius};
      Beads back = ahead;
      for (double& s : back.offset) s = -s;
      poses_.push_back(std::move(ahead));
      if (is_polar(kind)) poses_.push_back(std::move(back));
    }
  }

  static bool is_polar(const Species& kind) {
    return !std::equal(kind.bead_radius.begin(), kind.bead_radius.end(), kind.bead_radius.rbegin());
  }

  /// From tip to tip of the longest, as if its longer half were on both sides.
  double rod_extent() const {
    double extent = 0;
    for (const Species& kind : species) {
      for (int b = 0; b < kind.n_beads(); ++b)
        extent = std::max(extent, 2.0 * (std::abs(kind.bead_offset[b]) + kind.bead_radius[b]));
    }
    return extent;
  }

  /// Least distance of two rows of rods of any species, with a rod every `pitch`, shifted against each other by
  /// `shift`.
  double least_row_distance(double pitch, double shift) const {
    double least2 = 0;
    for (const Beads& one : poses_) {
      for (const Beads& other : poses_) least2 = std::max(least2, least_distance2(one, other, pitch, shift));
    }
    return std::sqrt(least2);
  }

  double max_radius() const {
    double radius = 0;
    for (const Species& kind : species) radius = std::max(radius, thickest(kind));
    return radius;
  }

  int n_rods() const { return static_cast<int>(shape_of_rod.size()); }
  const Species& species_of(int i) const { return species[shape_of_rod[static_cast<std::size_t>(i)]]; }

  const System& system;
  PlatesAtStart plates;  ///< at tick 0, between which the rods are placed
  std::span<const Species> species;
  std::span<const std::uint8_t> shape_of_rod;
  std::optional<PostGrid> posts;  ///< thicker, by as much as a bead comes nearer when its rod is tilted

  /// Whether something stands in the box, so that not every place of it is free.
  bool has_uprights() const { return system.walls || posts; }
  /// A rod of this kind touches neither walls nor posts.
  bool is_clear(const Species& kind, const Pose& pose) const {
    return !(system.walls && !is_within(*system.walls, system.box(), kind, pose)) &&
           !(posts && !is_clear_of_posts(*posts, kind, pose));
  }

 private:
  struct Beads {
    std::vector<double> offset, radius;
  };
  static double least_distance2(const Beads& one, const Beads& other, double pitch, double shift) {
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
  std::vector<Beads> poses_;
};

Vec3 site_position(const Lattice& lattice, const Box& box, int site) {
  const int row = site / lattice.columns;
  const int column = site % lattice.columns;
  const auto shift = static_cast<double>(static_cast<long>(row) * lattice.turns % lattice.rows) / lattice.rows;
  return {(column + 0.25 + shift) * (box.x() / lattice.columns), (row + 0.5) * (box.y() / lattice.rows), 0};
}

/// Sites at which any rod is clear of side walls and posts, whichever way it lies along x.
std::vector<int> usable_sites(const Lattice& lattice, const Placement& rods) {
  const Box box = rods.system.box();
  const double reach = 0.5 * rods.rod_extent() + kClearance;  // beyond it no bead is near a wall, however the rod lies
  const Vec2 most = 0.5 * rectangle_round(box, rods.system.walls);
  const auto is_clear = [&](const Vec3& position) {
    const Vec2 off = (position.head<2>() - 0.5 * box.sides()).cwiseAbs();
    if (off.x() > most.x() || off.y() > most.y()) return false;  // soon known
    const bool is_near = rods.posts || distance_to_walls(*rods.system.walls, box, position, reach) < reach;
    return !is_near || std::ranges::all_of(rods.species, [&](const Species& kind) {
      return rods.is_clear(kind, {position, Vec3(1, 0, 0)}) && rods.is_clear(kind, {position, Vec3(-1, 0, 0)});
    });
  };
  std::vector<int> sites;
  for (int site = 0; site < lattice.sites(); ++site) {
    if (!rods.has_uprights() || is_clear(site_position(lattice, box, site))) sites.push_back(site);
  }
  return sites;
}

int n_usable(const Lattice& lattice, const Placement& rods) {
  return rods.has_uprights() ? static_cast<int>(usable_sites(lattice, rods).size()) : lattice.sites();
}

/// The lattices with so many rods to a row: every even number of rows up to `max_rows`.
struct Columns {
  int columns = 0;
  double pitch = 0;      ///< of the rods in a row [mm]
  double next_row = 0;   ///< least distance of a row to the next [mm]
  double row_after = 0;  ///< and to the one after it [mm]
  int max_rows = 0;
};
std::vector<Columns> possible_columns(const Placement& rods) {
  const Box box = rods.system.box();
  const int max_columns = static_cast<int>(box.x() / (rods.rod_extent() + kClearance));
  std::vector<Columns> all;
  for (int columns = 1; columns <= max_columns; ++columns) {
    const double pitch = box.x() / columns;
    const double next_row = rods.least_row_distance(pitch, 0.5 * pitch) + kClearance;
    const double row_after = rods.least_row_distance(pitch, 0.0) + kClearance;
    const int max_rows = static_cast<int>(std::min(box.y() / next_row, 2.0 * box.y() / row_after)) / 2 * 2;
    all.push_back({columns, pitch, next_row, row_after, max_rows});
  }
  return all;
}

/// The roomiest lattice with a usable site for every rod.
std::optional<Lattice> find_lattice(const Placement& rods) {
  const Box box = rods.system.box();
  const int n_rods = rods.n_rods();
  const double extent = rods.rod_extent();
  std::optional<Lattice> best;
  for (const auto& [columns, pitch, next_row, row_after, max_rows] : possible_columns(rods)) {
    int rows = (n_rods + columns - 1) / columns + ((n_rods + columns - 1) / columns) % 2;
    while (rows <= max_rows && n_usable(every_other_row_shifted(columns, rows), rods) < n_rods) rows += 2;
    if (rows > max_rows) continue;
    const double row_pitch = box.y() / rows;
    const double clearance = std::min({pitch - extent, row_pitch - next_row, 2.0 * row_pitch - row_after});
    if (!best || clearance > best->clearance) best = every_other_row_shifted(columns, rows, clearance);
  }
  return best;
}

/// The roomiest lattice with so many columns and rows whose rows are shifted evenly, by any part of a column; none if
/// rods overlap in each.
std::optional<Lattice> winding_rows(int columns, int rows, const Placement& rods) {
  const double pitch = rods.system.box().x() / columns;
  const double apart = rods.system.box().y() / rows;
  const double reach = 2.0 * rods.max_radius() + kClearance;
  std::vector<double> least_distance;  // of two rows, by their shift in parts of `rows`; it is the same to either side
  for (int part = 0; part <= rows / 2; ++part) {
    least_distance.push_back(rods.least_row_distance(pitch, part * pitch / rows) + kClearance);
  }
  std::optional<Lattice> best;
  for (int turns = 0; turns <= rows / 2; ++turns) {  // beyond, they are mirror images
    double clearance = pitch - rods.rod_extent() - kClearance;
    for (int k = 1; k * apart < reach && clearance > 0; ++k) {
      const int part = k * turns % rows;
      clearance = std::min(clearance, k * apart - least_distance[std::min(part, rows - part)]);
    }
    if (clearance > (best ? best->clearance : 0)) best = Lattice{columns, rows, turns, clearance};
  }
  return best;
}

/// The numbers of columns and rows that winding rows may have: those with which rods of the largest kind, any of which
/// may lie at any site, fill no more than the box.
template <class Visit>
void for_each_columns(const Placement& rods, const Visit& visit) {
  constexpr int kMostRods = 1000;  // beyond, whole rods leave little of a side over, and the search takes seconds
  if (rods.has_uprights() || rods.n_rods() > kMostRods) return;
  const Box box = rods.system.box();
  double area = 0;
  for (const Species& kind : rods.species) area = std::max(area, kind.area);
  const int max_columns = static_cast<int>(box.x() / (rods.rod_extent() + kClearance));
  for (int columns = 1; columns <= max_columns; ++columns) {
    visit(columns, static_cast<int>(box.area() / (area * columns)));
  }
}

/// Where no whole number of rods fills the side of a periodic box well, rows that are shifted by another part of a
/// column than half: along the rods they close after several turns around the box.
std::optional<Lattice> find_winding_lattice(const Placement& rods) {
  std::optional<Lattice> best;
  for_each_columns(rods, [&](int columns, int max_rows) {
    std::optional<Lattice> found;
    for (int rows = (rods.n_rods() + columns - 1) / columns; rows <= max_rows && !found; ++rows) {
      found = winding_rows(columns, rows, rods);
    }
    if (found && (!best || found->clearance > best->clearance)) best = found;
  });
  return best;
}

/// The most rods for which find_winding_lattice() finds one; `most` if that is more.
int most_in_winding_rows(const Placement& rods, int most) {
  for_each_columns(rods, [&](int columns, int max_rows) {
    for (int rows = max_rows; columns * rows > most; --rows) {
      if (winding_rows(columns, rows, rods)) most = columns * rows;
    }
  });
  return most;
}

/// The most rods for which find_lattice finds one. Within walls that need not be the lattice of the most rows: its rows
/// may lie worse against the walls.
int most_usable_sites(const Placement& rods) {
  int most = 0;
  for (const Columns& of : possible_columns(rods)) {
    for (int rows = of.max_rows; rows >= 2 && of.columns * rows > most; rows -= 2) {
      most = std::max(most, n_usable(every_other_row_shifted(of.columns, rows), rods));
    }
  }
  return most;
}

Vec2 unit_vector(double angle) {
  const SinCos along = sincos(angle);
  return {along.cos, along.sin};
}

/// Height and tilt that keep the rod off both plates, and a random motion.
void lift_and_push(Flight& flight, const Placement& rods, const Species& species, const Vec2& in_plane, bool flat,
                   Rng& rng) {
  const System& system = rods.system;
  const bool planar = system.is_planar();
  const auto [base, gap] = rods.plates;
  const double room = 0.5 * gap - thickest(species);
  flight.position.z() = base + 0.5 * gap + (planar ? 0.0 : 0.3 * room * rng.uniform(-1, 1));
  const double most = flat ? 0.0 : most_tilt(system, gap, species);
  const double tilt = most > 0 ? most * rng.uniform(-1, 1) : 0.0;
  const double level = std::sqrt(1.0 - tilt * tilt);
  flight.director = {level * in_plane.x(), level * in_plane.y(), tilt};
  push_at_start(flight, system, rng);
}

/// "300 rods (area fraction 0.675)"
std::string amount(const Placement& rods, int count) {
  const System& system = rods.system;
  double area = 0;
  for (int i = 0; i < rods.n_rods(); ++i) area += rods.species_of(i).area;
  char text[64];
  std::snprintf(text, sizeof text, "%d rods (area fraction %.3f)", count, area / rods.n_rods() * count / system.area());
  return text;
}

Error does_not_fit(const Placement& rods, const std::string& why) {
  return {amount(rods, rods.n_rods()) + " do not fit into the " + (rods.system.walls ? "arena" : "box") + ": " + why};
}

/// Each site of a lattice has room for the largest of all kinds, which a mixture mostly does not need.
std::string denser_mixture(const Placement& rods) {
  const bool can_be_compressed = rods.species.size() > 1 && !rods.system.walls;
  return can_be_compressed ? "; rods.start \"compressed\" packs mixtures more densely" : "";
}

/// A lattice with a site for every rod, along x.
Result<Lattice> lattice_along_x(const Placement& rods) {
  auto lattice = find_lattice(rods);
  if (!lattice) lattice = find_winding_lattice(rods);
  if (lattice) return *lattice;
  const int most = most_in_winding_rows(rods, most_usable_sites(rods));
  return does_not_fit(rods, "in rows at most " + amount(rods, most) + " can be placed" + denser_mixture(rods));
}

/// The same of rods that lie at the angle of the start.
Result<Lattice> lattice_at_angle(const Placement& rods, const SinCos& angle) {
  const System& system = rods.system;
  if (rods.has_uprights())
    return does_not_fit(rods, "rows at an angle to the box are for periodic boxes, without walls or posts");
  const double shorter = shortened_by_tilt(system, rods.plates.gap, rods.species);
  const TurnedRows turned(rods.species, system.box(), Vec2(angle.cos, angle.sin), kClearance + 2.0 * shorter);
  if (const auto lattice = turned.find(rods.n_rods())) return *lattice;
  char degrees[32];
  std::snprintf(degrees, sizeof degrees, "%.10g", system.start_angle);
  return does_not_fit(rods, std::string("in rows of rods at ") + degrees + " degrees at most " +
                                amount(rods, turned.most_below(rods.n_rods())) + " can be placed" +
                                denser_mixture(rods));
}

Result<std::vector<Flight>> place_aligned(const Placement& rods) {
  const System& system = rods.system;
  const double angle = system.start_angle * (kPi / 180.0);
  const auto lattice = angle == 0 ? lattice_along_x(rods) : lattice_at_angle(rods, sincos(angle));
  if (!lattice) return lattice.error();

  // which sites stay empty: the tail of a random permutation (Fisher & Yates)
  std::vector<int> sites = usable_sites(*lattice, rods);
  Rng shuffle(system.seed, RngStream::kLattice, 0, 0);
  for (std::size_t k = sites.size() - 1; k > 0; --k) std::swap(sites[k], sites[shuffle.below(k + 1)]);
  sites.resize(static_cast<std::size_t>(rods.n_rods()));
  std::sort(sites.begin(), sites.end());

  std::vector<Flight> flights(sites.size());
  for (int i = 0; i < rods.n_rods(); ++i) {
    Rng rng(system.seed, RngStream::kVelocity, 0, static_cast<std::uint64_t>(i));
    flights[i].position = site_position(*lattice, system.box(), sites[i]);
    if (angle != 0) {
      std::int32_t ignored = 0;
      wrap(flights[i].position.x(), ignored, system.box().x());
    }
    // polar rods point either way
    const bool turned = Placement::is_polar(rods.species_of(i)) && rng.uniform() < 0.5;
    lift_and_push(flights[i], rods, rods.species_of(i), unit_vector(turned ? angle + kPi : angle), false, rng);
  }
  return flights;
}

Result<std::vector<Flight>> place_random(const Placement& rods, const DirectorAt& directors) {
  const System& system = rods.system;
  std::vector<Flight> flights;
  std::vector<BeadContact> contacts;
  // rods are flat here, so centres further apart than one rod length cannot touch: cells of that width
  const double width = rods.rod_extent();
  const Box box = system.box();
  const auto cells_along = [width](double side) {
    const int cells = static_cast<int>(side / width);
    return cells < 3 ? 1 : cells;  // all rods are neighbours along it
  };
  const int columns = cells_along(box.x()), rows = cells_along(box.y());
  const int wide = columns > 1 ? 1 : 0, high = rows > 1 ? 1 : 0;
  std::vector<std::vector<int>> members(static_cast<std::size_t>(columns) * rows);
  const auto column_of = [&](const Flight& rod) {
    return std::min(columns - 1, static_cast<int>(rod.position.x() / box.x() * columns));
  };
  const auto row_of = [&](const Flight& rod) {
    return std::min(rows - 1, static_cast<int>(rod.position.y() / box.y() * rows));
  };
  const auto is_free = [&](const Flight& candidate, const Species& species) {
    if (!rods.is_clear(species, {candidate.position, candidate.director})) return false;
    const auto touches = [&](int other) {
      contacts.clear();
      Vec3 D = nearest_image(candidate.position, flights[other].position, box);
      D.z() = 0;  // as if at one height: then it does not matter how high they jump
      find_bead_contacts(species, candidate.director, rods.species_of(other), flights[other].director, D, contacts);
      return !contacts.empty();
    };
    for (int dy = -high; dy <= high; ++dy) {
      for (int dx = -wide; dx <= wide; ++dx) {
        const int cx = (column_of(candidate) + dx + columns) % columns;
        const int cy = (row_of(candidate) + dy + rows) % rows;
        for (int other : members[cy * columns + cx]) {
          if (touches(other)) return false;
        }
      }
    }
    return true;
  };

  for (int i = 0; i < rods.n_rods(); ++i) {
    Rng place(system.seed, RngStream::kInsertion, 0, static_cast<std::uint64_t>(i));
    Flight candidate;
    bool placed = false;
    for (int attempt = 0; attempt < kMaxInsertions && !placed; ++attempt) {
      candidate.position = {box.x() * place.uniform(), box.y() * place.uniform(), 0};
      const double angle = (Placement::is_polar(rods.species_of(i)) ? 2.0 * kPi : kPi) * place.uniform();
      Vec2 in_plane = unit_vector(angle);
      if (directors) in_plane = (angle < kPi ? 1.0 : -1.0) * directors(candidate.position.head<2>());
      candidate.director = {in_plane.x(), in_plane.y(), 0};
      if (!is_free(candidate, rods.species_of(i))) continue;
      Rng rng(system.seed, RngStream::kVelocity, 0, static_cast<std::uint64_t>(i));
      lift_and_push(candidate, rods, rods.species_of(i), in_plane, true, rng);
      placed = true;
    }
    if (!placed) {
      return does_not_fit(rods, "at random there was no room for another after " + amount(rods, i) + ", in " +
                                    std::to_string(kMaxInsertions) + " tries; rods.start \"aligned\" packs more");
    }
    members[row_of(candidate) * columns + column_of(candidate)].push_back(i);
    flights.push_back(candidate);
  }
  return flights;
}

}  // namespace

void push_at_start(Flight& flight, const System& system, Rng& rng) {
  // in braces, whose order of evaluation is the same everywhere
  flight.velocity = kStartSpeed * Vec3{rng.normal(), rng.normal(), rng.normal()};
  Vec3 turn = kTurnSpeed * Vec3{rng.normal(), rng.normal(), rng.normal()};
  if (system.is_planar()) {
    flight.velocity.z() = 0;
    turn.head<2>().setZero();
  }
  flight.spin = 0;
  flight.precession = turn - turn.dot(flight.director) * flight.director;
  flight.prepare();
}

Result<std::vector<Flight>> initial_flights(const System& system, std::span<const Species> species,
                                            std::span<const std::uint8_t> shape_of_rod, const DirectorAt& directors) {
  SHAKEN_CHECK(!is_compressed(system.start), "sim/compression.h makes that");
  SHAKEN_CHECK(!directors || system.start == Start::kRandom, "only rods at random places follow a pattern");
  const Placement rods(system, species, shape_of_rod);
  if (rods.plates.gap < 2.0 * rods.max_radius()) return Error{"the gap is smaller than the thickest bead"};
  if (const double least = least_box_side(species); system.box().shorter() < least * (1.0 - 1e-9)) {
    return Error{"the box is too small: rods might meet two images of another below " + std::to_string(least) + " mm"};
  }
  auto flights = system.start == Start::kAligned ? place_aligned(rods) : place_random(rods, directors);
  if (!flights) return flights;

  // what was promised is checked, not believed
  std::vector<Pose> poses;
  for (const Flight& flight : *flights) poses.push_back({flight.position, flight.director});
  NeighborList neighbors(species, shape_of_rod, system.box(), 0.01);
  neighbors.build(poses);
  std::vector<BeadContact> contacts;
  for (const auto& [i, j] : neighbors.pairs()) {
    find_bead_contacts(rods.species_of(i), poses[i].director, rods.species_of(j), poses[j].director,
                       nearest_image(poses[i].position, poses[j].position, system.box()), contacts);
  }
  SHAKEN_CHECK(contacts.empty(), std::to_string(contacts.size()) + " overlaps in the initial state");
  return flights;
}

Result<World> make_world(const System& system) { return make_world_along(system, {}); }

Result<World> make_world_along(const System& system, const DirectorAt& directors) {
  World world = empty_world(system);
  auto flights = initial_flights(system, world.species, world.shape_of_rod, directors);
  if (!flights) return flights.error();
  world.rods = std::move(flights).value();
  world.start = content(world);
  return world;
}

constexpr SecondVibration kNoSecond{0, 0, 0};

std::string start_mismatch(const System& system, const System& other) {
  std::string all;
  const auto compare = [&](bool is_same, const char* what) {
    if (!is_same) all += std::string(all.empty() ? "" : ", ") + what;
  };
  const auto arena_of = [](const System& one) {
    const SideWalls walls = one.walls.value_or(SideWalls{});
    return std::tuple(one.walls.has_value(), walls.arena, walls.size, walls.inner, walls.length, walls.narrow);
  };
  compare(system.rod == other.rod && system.added == other.added, "the rods");
  compare(system.n_rods == other.n_rods, "their number");
  compare(system.box_aspect == other.box_aspect, "the shape of the box");
  compare(system.base == other.base && system.lid == other.lid, "the plates that are there");
  // a lid that is elsewhere at the start might come down on rods
  const auto lid_of = [](const System& one) {
    return one.has_lid_motion() ? std::tuple(true, *one.lid_motion, one.amplitude, one.second.value_or(kNoSecond))
                                : std::tuple(false, LidMotion{}, 0.0, kNoSecond);
  };
  compare(lid_of(system) == lid_of(other), "how the lid moves");
  compare(arena_of(system) == arena_of(other), "the walls");
  compare(standing_posts(system) == standing_posts(other), "the posts");
  if ((system.walls && other.walls) || (system.posts && other.posts)) {
    compare(system.box_side == other.box_side, "the side of the box");
    compare(system.gap == other.gap, "the gap");
  }
  return all;
}

double off_the_beat(const System& system, Tick tick) {
  if (!system.has_moving_plates()) return 0;
  const double time = static_cast<double>(tick) * system.dt;
  const auto off = [&](bool moves, double frequency) {
    return moves && frequency > 0 ? time - std::round(time * frequency) / frequency : 0.0;
  };
  const bool first_moves = system.amplitude > 0 || system.horizontal_amplitude > 0 || system.has_lid_motion();
  const double first = off(first_moves, system.frequency);
  if (!system.has_second_vibration()) return first;
  const double second = off(true, system.second->frequency);
  return std::abs(second) > std::abs(first) ? second : first;
}

std::string nearest_beat(const System& system, Tick tick) {
  const auto text = [](const char* words, double first, double second) {
    char line[120];
    std::snprintf(line, sizeof line, words, first, second);
    return std::string(line);
  };
  if (system.has_second_vibration())
    return text("both vibrations, of %.10g and %.10g Hz, must be whole ones there", system.frequency,
                system.second->frequency);
  return text("the nearest whole one is at %.10g s", static_cast<double>(tick) * system.dt - off_the_beat(system, tick),
              0);
}

bool is_resized(const System& system, const System& other) {
  return system.box_side != other.box_side || system.gap != other.gap;
}

Result<void> check_left(const System& system, const World& left) {
  if (const std::string differs = start_mismatch(system, left.system); !differs.empty()) {
    return Error{"not the same as where the rods come from: " + differs};
  }
  const double off = off_the_beat(left.system, left.tick);
  if (std::abs(off) <= 0.5 * left.system.dt * (1 + 1e-6)) return {};
  const double now = static_cast<double>(left.tick) * left.system.dt;
  return Error{"its plates are in the middle of a vibration at " + std::to_string(now) + " s and would jump; " +
               nearest_beat(left.system, left.tick)};
}

RodsLeft rods_left(const World& world, const World& left) {
  RodsLeft rods;
  rods.poses.reserve(left.rods.size());
  rods.motions.reserve(left.rods.size());
  const Gravity gravity = left.system.gravity_on_plates();
  std::vector<std::size_t> next(world.species.size(), 0);  // of each shape, where to look for its next rod
  for (const std::uint8_t kind : world.shape_of_rod) {
    std::size_t& from = next[kind];
    while (left.shape_of_rod[from] != kind) ++from;
    const Flight& flight = left.rods[from++];
    const double ratio = world.species[kind].inertia_par / world.species[kind].inertia_perp;
    const double tau = static_cast<double>(left.tick - flight.since) * left.system.dt;
    rods.poses.push_back(pose_after(flight, tau, gravity));
    rods.motions.push_back(motion_after(flight, tau, gravity, rods.poses.back().director, ratio));
  }
  return rods;
}

Result<World> make_world(const System& system, const World& left) {
  if (auto fits = check_left(system, left); !fits) return fits.error();
  SHAKEN_CHECK(!is_resized(system, left.system), "sim/compression.h makes that");
  World world = empty_world(system);
  const bool has_plates = system.base || system.lid;
  const double rise = has_plates ? world.plates.at(0).base - left.plates.at(left.tick).base : 0.0;
  auto [poses, motions] = rods_left(world, left);
  world.rods.resize(poses.size());
  for (std::size_t i = 0; i < world.rods.size(); ++i) {
    const Species& species = world.species_of(i);
    poses[i].position.z() += rise;
    if (system.seed != left.system.seed) {
      Rng rng(system.seed, RngStream::kKicks, 0, static_cast<std::uint64_t>(i));
      for (double& component : motions[i].velocity) component *= 1.0 + kKick * rng.normal();
    }
    begin_flight(world.rods[i], 0, poses[i], motions[i], system.box(), species.inertia_par / species.inertia_perp);
    world.rods[i].image = {0, 0};
  }
  world.start = content(world);
  return world;
}

}  // namespace shaken
