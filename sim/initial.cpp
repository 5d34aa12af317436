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
#include "sim/neighbors/neighbor_list.h"

namespace shaken {
namespace {

constexpr double kSpeed = 20.0;        ///< standard deviation of each velocity component [mm/s]
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

/// Least distance of two rows of parallel rods, each with a rod every `pitch`, shifted against each other by `shift`.
double least_row_distance(const Species& species, double pitch, double shift) {
  double least2 = 0;
  for (int a = 0; a < species.n_beads(); ++a) {
    for (int b = 0; b < species.n_beads(); ++b) {
      const double touch = species.bead_radius[a] + species.bead_radius[b];
      double along = species.bead_offset[b] - species.bead_offset[a] + shift;
      along -= pitch * std::nearbyint(along / pitch);
      least2 = std::max(least2, touch * touch - along * along);
    }
  }
  return std::sqrt(least2);
}

double rod_extent(const Species& species) {
  return 2.0 * std::max(species.half_length + species.end_radius, species.mid_radius);
}

/// The roomiest lattice with at least `n_rods` sites; also tells the most sites that any lattice offers.
std::optional<Lattice> find_lattice(const Species& species, double side, int n_rods, int& most_sites) {
  most_sites = 0;
  std::optional<Lattice> best;
  const int max_columns = static_cast<int>(side / (rod_extent(species) + kClearance));
  for (int columns = 1; columns <= max_columns; ++columns) {
    const double pitch = side / columns;
    const double next_row = least_row_distance(species, pitch, 0.5 * pitch) + kClearance;
    const double row_after = least_row_distance(species, pitch, 0.0) + kClearance;
    const int max_rows = static_cast<int>(std::min(side / next_row, 2.0 * side / row_after)) / 2 * 2;
    most_sites = std::max(most_sites, columns * max_rows);
    const int rows = (n_rods + columns - 1) / columns + ((n_rods + columns - 1) / columns) % 2;
    if (rows > max_rows) continue;
    const double row_pitch = side / rows;
    const double clearance = std::min({pitch - rod_extent(species), row_pitch - next_row, 2.0 * row_pitch - row_after});
    if (!best || clearance > best->clearance) best = Lattice{columns, rows, clearance};
  }
  return best;
}

/// Height and tilt that keep the rod off both plates, and a random motion.
void lift_and_push(Flight& flight, const Scene& scene, const Species& species, double in_plane_angle, bool flat,
                   Rng& rng) {
  const double base = 2.0 * scene.amplitude;  // cos(0) = 1: the plates start at the top of their stroke
  const double room = 0.5 * scene.gap - species.max_radius;
  flight.position.z() = base + 0.5 * scene.gap + 0.3 * room * rng.uniform(-1, 1);
  const double tilt =
      !flat && species.half_length > 0 ? std::min(0.02, 0.3 * room / species.half_length) * rng.uniform(-1, 1) : 0.0;
  const SinCos plane = sincos(in_plane_angle);
  const double level = std::sqrt(1.0 - tilt * tilt);
  flight.director = {level * plane.cos, level * plane.sin, tilt};
  flight.velocity = kSpeed * Vec3(rng.normal(), rng.normal(), rng.normal());
  const Vec3 turn = kTurnSpeed * Vec3(rng.normal(), rng.normal(), rng.normal());
  flight.spin = 0;
  flight.precession = turn - turn.dot(flight.director) * flight.director;
  flight.prepare();
}

Error does_not_fit(const Scene& scene, const Species& species, int n_fit, const char* way_out) {
  char text[256];
  const double per_rod = species.area / (scene.box_side * scene.box_side);
  std::snprintf(text, sizeof text,
                "%d rods (area fraction %.3f) do not fit into the box: at most %d (%.3f) can be placed%s", scene.n_rods,
                scene.n_rods * per_rod, n_fit, n_fit * per_rod, way_out);
  return {text};
}

Result<std::vector<Flight>> place_aligned(const Scene& scene, const Species& species) {
  int most_sites = 0;
  const auto lattice = find_lattice(species, scene.box_side, scene.n_rods, most_sites);
  if (!lattice) return does_not_fit(scene, species, most_sites, "");

  // which sites stay empty: the tail of a random permutation (Fisher & Yates)
  std::vector<int> sites(lattice->sites());
  std::iota(sites.begin(), sites.end(), 0);
  Rng shuffle(scene.seed, RngStream::kLattice, 0);
  for (std::size_t k = sites.size() - 1; k > 0; --k) std::swap(sites[k], sites[shuffle.below(k + 1)]);
  sites.resize(scene.n_rods);
  std::sort(sites.begin(), sites.end());

  std::vector<Flight> flights(scene.n_rods);
  const double column_pitch = scene.box_side / lattice->columns;
  const double row_pitch = scene.box_side / lattice->rows;
  for (int i = 0; i < scene.n_rods; ++i) {
    const int row = sites[i] / lattice->columns;
    const int column = sites[i] % lattice->columns;
    Rng rng(scene.seed, RngStream::kVelocity, static_cast<std::uint64_t>(i));
    flights[i].position.x() = (column + 0.25 + 0.5 * (row % 2)) * column_pitch;
    flights[i].position.y() = (row + 0.5) * row_pitch;
    lift_and_push(flights[i], scene, species, 0.0, false, rng);
  }
  return flights;
}

Result<std::vector<Flight>> place_random(const Scene& scene, const Species& species) {
  std::vector<Flight> flights;
  std::vector<BeadContact> contacts;
  // rods are flat here, so centres further apart than one rod length cannot touch: cells of that width
  const double width = rod_extent(species);
  const int cells = std::max(1, static_cast<int>(scene.box_side / width));
  std::vector<std::vector<int>> members(static_cast<std::size_t>(cells) * cells);
  const auto cell_of = [&](double x) { return std::min(cells - 1, static_cast<int>(x / scene.box_side * cells)); };
  const auto is_free = [&](const Flight& candidate) {
    const auto touches = [&](int other) {
      contacts.clear();
      Vec3 D = nearest_image(candidate.position, flights[other].position, scene.box_side);
      D.z() = 0;  // as if at one height: then it does not matter how high they jump
      find_bead_contacts(species, candidate.director, species, flights[other].director, D, contacts);
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

  for (int i = 0; i < scene.n_rods; ++i) {
    Rng place(scene.seed, RngStream::kInsertion, static_cast<std::uint64_t>(i));
    Flight candidate;
    bool placed = false;
    for (int attempt = 0; attempt < kMaxInsertions && !placed; ++attempt) {
      candidate.position = {scene.box_side * place.uniform(), scene.box_side * place.uniform(), 0};
      const double angle = kPi * place.uniform();
      const SinCos plane = sincos(angle);
      candidate.director = {plane.cos, plane.sin, 0};
      if (!is_free(candidate)) continue;
      Rng rng(scene.seed, RngStream::kVelocity, static_cast<std::uint64_t>(i));
      lift_and_push(candidate, scene, species, angle, true, rng);
      placed = true;
    }
    if (!placed) return does_not_fit(scene, species, i, " at random; start \"aligned\" packs more");
    members[cell_of(candidate.position.y()) * cells + cell_of(candidate.position.x())].push_back(i);
    flights.push_back(candidate);
  }
  return flights;
}

}  // namespace

Result<std::vector<Flight>> initial_flights(const Scene& scene, const Species& species) {
  if (scene.gap < 2.0 * species.max_radius) return Error{"the gap is smaller than the thickest bead"};
  auto flights = scene.start == Start::kAligned ? place_aligned(scene, species) : place_random(scene, species);
  if (!flights) return flights;

  // what was promised is checked, not believed
  std::vector<Pose> poses;
  for (const Flight& flight : *flights) poses.push_back({flight.position, flight.director});
  NeighborList neighbors(species, scene.box_side, 0.01);
  neighbors.build(poses);
  std::vector<BeadContact> contacts;
  for (const auto& [i, j] : neighbors.pairs()) {
    find_bead_contacts(species, poses[i].director, species, poses[j].director,
                       nearest_image(poses[i].position, poses[j].position, scene.box_side), contacts);
  }
  SHAKEN_CHECK(contacts.empty(), std::to_string(contacts.size()) + " overlaps in the initial state");
  return flights;
}

}  // namespace shaken
