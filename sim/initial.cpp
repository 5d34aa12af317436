// SPDX-License-Identifier: MIT
#include "sim/initial.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numeric>
#include <optional>

#include "sim/contact/bead_contacts.h"
#include "sim/core/check.h"
#include "sim/core/rng.h"
#include "sim/effects/side_walls.h"
#include "sim/neighbors/neighbor_list.h"

namespace shaken {
namespace {

constexpr double kTurnSpeed = 5.0;     ///< of each angular velocity component across the rod [rad/s]
constexpr double kClearance = 0.002;   ///< least distance between rods of the lattice [mm]
constexpr int kMaxInsertions = 20000;  ///< tries for one rod of a random start

/// Rows of rods along x: `columns` to a row, every other row shifted by half a column.
struct Lattice {
  int columns = 0;
  int rows = 0;
  double clearance = 0;  ///< smaller of the gaps along and across [mm]
  int sites() const { return columns * rows; }
};

/// The species to be placed, and how each may lie along x.
class Placement {
 public:
  Placement(const Scene& for_scene, std::span<const Species> of_species, std::span<const std::uint8_t> of_kinds)
      : scene(for_scene), species(of_species), kinds(of_kinds) {
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

  /// Least distance of two rows of rods of any kinds, with a rod every `pitch`, shifted against each other by `shift`.
  double least_row_distance(double pitch, double shift) const {
    double least2 = 0;
    for (const Beads& one : poses_) {
      for (const Beads& other : poses_) least2 = std::max(least2, least_distance2(one, other, pitch, shift));
    }
    return std::sqrt(least2);
  }

  /// Of the thickest bead.
  static double thickest(const Species& kind) {
    return *std::max_element(kind.bead_radius.begin(), kind.bead_radius.end());
  }
  double max_radius() const {
    double radius = 0;
    for (const Species& kind : species) radius = std::max(radius, thickest(kind));
    return radius;
  }

  int n_rods() const { return static_cast<int>(kinds.size()); }
  const Species& species_of(int i) const { return species[kinds[static_cast<std::size_t>(i)]]; }

  const Scene& scene;
  std::span<const Species> species;
  std::span<const std::uint8_t> kinds;

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

Vec3 site_position(const Lattice& lattice, double side, int site) {
  const int row = site / lattice.columns;
  const int column = site % lattice.columns;
  return {(column + 0.25 + 0.5 * (row % 2)) * (side / lattice.columns), (row + 0.5) * (side / lattice.rows), 0};
}

/// Sites at which any rod is clear of the side walls, whichever way it lies along x.
std::vector<int> usable_sites(const Lattice& lattice, const Placement& rods) {
  const double side = rods.scene.box_side;
  std::vector<int> sites;
  for (int site = 0; site < lattice.sites(); ++site) {
    bool clear = true;
    for (std::size_t k = 0; rods.scene.walls && k < rods.species.size() && clear; ++k) {
      for (const double sign : {1.0, -1.0}) {
        Pose pose{site_position(lattice, side, site), Vec3(sign, 0, 0)};
        clear = clear && is_within(*rods.scene.walls, side, rods.species[k], pose);
      }
    }
    if (clear) sites.push_back(site);
  }
  return sites;
}

/// The roomiest lattice with at least `n_rods` sites; also tells the most sites that any lattice offers.
std::optional<Lattice> find_lattice(const Placement& rods, int& most_sites) {
  const double side = rods.scene.box_side;
  const int n_rods = rods.n_rods();
  const double extent = rods.rod_extent();
  most_sites = 0;
  std::optional<Lattice> best;
  const int max_columns = static_cast<int>(side / (extent + kClearance));
  for (int columns = 1; columns <= max_columns; ++columns) {
    const double pitch = side / columns;
    const double next_row = rods.least_row_distance(pitch, 0.5 * pitch) + kClearance;
    const double row_after = rods.least_row_distance(pitch, 0.0) + kClearance;
    const int max_rows = static_cast<int>(std::min(side / next_row, 2.0 * side / row_after)) / 2 * 2;
    const auto n_usable = [&](int rows) {
      const Lattice lattice{columns, rows, 0};
      return rods.scene.walls ? static_cast<int>(usable_sites(lattice, rods).size()) : lattice.sites();
    };
    most_sites = std::max(most_sites, n_usable(max_rows));
    int rows = (n_rods + columns - 1) / columns + ((n_rods + columns - 1) / columns) % 2;
    while (rows <= max_rows && n_usable(rows) < n_rods) rows += 2;
    if (rows > max_rows) continue;
    const double row_pitch = side / rows;
    const double clearance = std::min({pitch - extent, row_pitch - next_row, 2.0 * row_pitch - row_after});
    if (!best || clearance > best->clearance) best = Lattice{columns, rows, clearance};
  }
  return best;
}

/// Height and tilt that keep the rod off both plates, and a random motion.
void lift_and_push(Flight& flight, const Placement& rods, const Species& species, double in_plane_angle, bool flat,
                   Rng& rng) {
  const Scene& scene = rods.scene;
  const bool planar = scene.is_planar();
  const double base = 2.0 * scene.amplitude;  // cos(0) = 1: the plates start at the top of their stroke
  const double room = 0.5 * scene.gap - Placement::thickest(species);
  flight.position.z() = base + 0.5 * scene.gap + (planar ? 0.0 : 0.3 * room * rng.uniform(-1, 1));
  const double tilt = !flat && !planar && species.half_length > 0
                          ? std::min(0.02, 0.3 * room / species.half_length) * rng.uniform(-1, 1)
                          : 0.0;
  const SinCos plane = sincos(in_plane_angle);
  const double level = std::sqrt(1.0 - tilt * tilt);
  flight.director = {level * plane.cos, level * plane.sin, tilt};
  flight.velocity = kStartSpeed * Vec3(rng.normal(), rng.normal(), rng.normal());
  Vec3 turn = kTurnSpeed * Vec3(rng.normal(), rng.normal(), rng.normal());
  if (planar) {
    flight.velocity.z() = 0;
    turn.head<2>().setZero();
  }
  flight.spin = 0;
  flight.precession = turn - turn.dot(flight.director) * flight.director;
  flight.prepare();
}

Error does_not_fit(const Placement& rods, int n_fit, const char* way_out) {
  const Scene& scene = rods.scene;
  double area = 0;
  for (int i = 0; i < rods.n_rods(); ++i) area += rods.species_of(i).area;
  const double room = scene.walls ? scene.walls->area() : scene.box_side * scene.box_side;
  const double per_rod = area / rods.n_rods() / room;
  char text[256];
  std::snprintf(text, sizeof text,
                "%d rods (area fraction %.3f) do not fit into the %s: at most %d (%.3f) can be placed%s", rods.n_rods(),
                rods.n_rods() * per_rod, scene.walls ? "arena" : "box", n_fit, n_fit * per_rod, way_out);
  return {text};
}

Result<std::vector<Flight>> place_aligned(const Placement& rods) {
  const Scene& scene = rods.scene;
  int most_sites = 0;
  const auto lattice = find_lattice(rods, most_sites);
  if (!lattice) return does_not_fit(rods, most_sites, "");

  // which sites stay empty: the tail of a random permutation (Fisher & Yates)
  std::vector<int> sites = usable_sites(*lattice, rods);
  Rng shuffle(scene.seed, RngStream::kLattice, 0);
  for (std::size_t k = sites.size() - 1; k > 0; --k) std::swap(sites[k], sites[shuffle.below(k + 1)]);
  sites.resize(static_cast<std::size_t>(rods.n_rods()));
  std::sort(sites.begin(), sites.end());

  std::vector<Flight> flights(sites.size());
  for (int i = 0; i < rods.n_rods(); ++i) {
    Rng rng(scene.seed, RngStream::kVelocity, static_cast<std::uint64_t>(i));
    flights[i].position = site_position(*lattice, scene.box_side, sites[i]);
    // polar rods point either way
    const bool turned = Placement::is_polar(rods.species_of(i)) && rng.uniform() < 0.5;
    lift_and_push(flights[i], rods, rods.species_of(i), turned ? kPi : 0.0, false, rng);
  }
  return flights;
}

Result<std::vector<Flight>> place_random(const Placement& rods) {
  const Scene& scene = rods.scene;
  std::vector<Flight> flights;
  std::vector<BeadContact> contacts;
  // rods are flat here, so centres further apart than one rod length cannot touch: cells of that width
  const double width = rods.rod_extent();
  const int cells = std::max(1, static_cast<int>(scene.box_side / width));
  std::vector<std::vector<int>> members(static_cast<std::size_t>(cells) * cells);
  const auto cell_of = [&](double x) { return std::min(cells - 1, static_cast<int>(x / scene.box_side * cells)); };
  const auto is_free = [&](const Flight& candidate, const Species& species) {
    if (scene.walls && !is_within(*scene.walls, scene.box_side, species, Pose{candidate.position, candidate.director}))
      return false;
    const auto touches = [&](int other) {
      contacts.clear();
      Vec3 D = nearest_image(candidate.position, flights[other].position, scene.box_side);
      D.z() = 0;  // as if at one height: then it does not matter how high they jump
      find_bead_contacts(species, candidate.director, rods.species_of(other), flights[other].director, D, contacts);
      return !contacts.empty();
    };
    if (cells < 3) {
      for (std::size_t other = 0; other < flights.size(); ++other) {
        if (touches(static_cast<int>(other))) return false;
      }
      return true;
    }
    for (int dy = -1; dy <= 1; ++dy) {
      for (int dx = -1; dx <= 1; ++dx) {
        const int cx = (cell_of(candidate.position.x()) + dx + cells) % cells;
        const int cy = (cell_of(candidate.position.y()) + dy + cells) % cells;
        for (int other : members[cy * cells + cx]) {
          if (touches(other)) return false;
        }
      }
    }
    return true;
  };

  for (int i = 0; i < rods.n_rods(); ++i) {
    Rng place(scene.seed, RngStream::kInsertion, static_cast<std::uint64_t>(i));
    Flight candidate;
    bool placed = false;
    for (int attempt = 0; attempt < kMaxInsertions && !placed; ++attempt) {
      candidate.position = {scene.box_side * place.uniform(), scene.box_side * place.uniform(), 0};
      const double angle = (Placement::is_polar(rods.species_of(i)) ? 2.0 * kPi : kPi) * place.uniform();
      const SinCos plane = sincos(angle);
      candidate.director = {plane.cos, plane.sin, 0};
      if (!is_free(candidate, rods.species_of(i))) continue;
      Rng rng(scene.seed, RngStream::kVelocity, static_cast<std::uint64_t>(i));
      lift_and_push(candidate, rods, rods.species_of(i), angle, true, rng);
      placed = true;
    }
    if (!placed) return does_not_fit(rods, i, " at random; start \"aligned\" packs more");
    members[cell_of(candidate.position.y()) * cells + cell_of(candidate.position.x())].push_back(i);
    flights.push_back(candidate);
  }
  return flights;
}

}  // namespace

Result<std::vector<Flight>> initial_flights(const Scene& scene, std::span<const Species> species,
                                            std::span<const std::uint8_t> kinds) {
  const Placement rods(scene, species, kinds);
  if (scene.gap < 2.0 * rods.max_radius()) return Error{"the gap is smaller than the thickest bead"};
  auto flights = scene.start == Start::kAligned ? place_aligned(rods) : place_random(rods);
  if (!flights) return flights;

  // what was promised is checked, not believed
  std::vector<Pose> poses;
  for (const Flight& flight : *flights) poses.push_back({flight.position, flight.director});
  NeighborList neighbors(species, kinds, scene.box_side, 0.01);
  neighbors.build(poses);
  std::vector<BeadContact> contacts;
  for (const auto& [i, j] : neighbors.pairs()) {
    find_bead_contacts(rods.species_of(i), poses[i].director, rods.species_of(j), poses[j].director,
                       nearest_image(poses[i].position, poses[j].position, scene.box_side), contacts);
  }
  SHAKEN_CHECK(contacts.empty(), std::to_string(contacts.size()) + " overlaps in the initial state");
  return flights;
}

}  // namespace shaken
