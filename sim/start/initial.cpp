#include "sim/start/initial.h"

#include <algorithm>
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

#include "base/core/check.h"
#include "base/core/result.h"
#include "base/core/sincos.h"
#include "sim/balance.h"
#include "sim/contact/bead_contacts.h"
#include "sim/neighbors/neighbor_list.h"
#include "sim/overlaps.h"
#include "sim/start/director_patterns.h"
#include "sim/start/placement.h"
#include "sim/start/rows.h"

namespace shaken {
namespace {

/// Each site of a lattice has room for the largest of all kinds, which a mixture mostly does not need.
std::string denser_mixture(const Placement& rods) {
  const bool can_be_compressed = rods.species.size() > 1 && !rods.system.walls;
  return can_be_compressed ? "; rods.start \"compressed\" packs mixtures more densely" : "";
}

/// A lattice with a site for every rod, along x.
Result<Lattice> lattice_along_x(const Placement& rods) {
  if (const auto lattice = rows_along_x(rods)) return *lattice;
  return rods.does_not_fit("in rows at most " + rods.amount(most_in_rows_along_x(rods)) + " can be placed" +
                           denser_mixture(rods));
}

/// The same of rods that lie at the angle of the start.
Result<Lattice> lattice_at_angle(const Placement& rods, const SinCos& angle) {
  const System& system = rods.system;
  if (rods.has_uprights())
    return rods.does_not_fit("rows at an angle to the box are for periodic boxes, without walls or posts");
  const double shorter = rods.shortened_by_tilt();
  const TurnedRows turned(rods.species, system.box(), Vec2(angle.cos, angle.sin),
                          Placement::kClearance + 2.0 * shorter);
  if (const auto lattice = turned.find(rods.n_rods())) return *lattice;
  char degrees[32];
  std::snprintf(degrees, sizeof degrees, "%.10g", system.start_angle);
  return rods.does_not_fit(std::string("in rows of rods at ") + degrees + " degrees at most " +
                           rods.amount(turned.most_below(rods.n_rods())) + " can be placed" + denser_mixture(rods));
}

/// Flights at tick 0 of rods in rows, along x or at System::start_angle to it. Sites left over are vacancies at random
/// places; polar rods point either way. Errors: the rods do not fit; the message names the most that can be placed.
Result<std::vector<Flight>> aligned_rods(const Placement& rods) {
  const System& system = rods.system;
  const double angle = system.start_angle * (kPi / 180.0);
  const auto lattice = SHAKEN_TRY(angle == 0 ? lattice_along_x(rods) : lattice_at_angle(rods, sincos(angle)));

  // which sites stay empty: the tail of a random permutation (Fisher & Yates)
  std::vector<int> sites = usable_sites(lattice, rods);
  Rng shuffle(system.seed, RngStream::kLattice, 0, 0);
  for (std::size_t k = sites.size() - 1; k > 0; --k) std::swap(sites[k], sites[shuffle.below(k + 1)]);
  sites.resize(static_cast<std::size_t>(rods.n_rods()));
  std::sort(sites.begin(), sites.end());

  std::vector<Flight> flights(sites.size());
  for (int i = 0; i < rods.n_rods(); ++i) {
    Rng rng(system.seed, RngStream::kVelocity, 0, static_cast<std::uint64_t>(i));
    flights[i].position = lattice.position(sites[i], system.box());
    if (angle != 0) {
      std::int32_t ignored = 0;
      wrap(flights[i].position.x(), ignored, system.box().x());
    }
    // polar rods point either way
    const bool turned = Placement::is_polar(rods.species_of(i)) && rng.uniform() < 0.5;
    rods.lift_and_push(flights[i], rods.species_of(i), unit_vector(turned ? angle + kPi : angle), false, rng);
  }
  return flights;
}

constexpr int kMaxInsertions = 20000;  ///< tries for one rod

/// Flights at tick 0 of flat rods at random places and in random directions, one after the other where there is room
/// (random sequential insertion); along `directors` if they are given, with the head at either end. Errors: the rods
/// do not fit; the message names how many had been placed when there was no room for another.
Result<std::vector<Flight>> random_rods(const Placement& rods, const DirectorAt& directors) {
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
      rods.lift_and_push(candidate, rods.species_of(i), in_plane, true, rng);
      placed = true;
    }
    if (!placed) {
      return rods.does_not_fit("at random there was no room for another after " + rods.amount(i) + ", in " +
                               std::to_string(kMaxInsertions) + " tries; rods.start \"aligned\" packs more");
    }
    members[row_of(candidate) * columns + column_of(candidate)].push_back(i);
    flights.push_back(candidate);
  }
  return flights;
}

}  // namespace

Result<std::vector<Flight>> initial_flights(const System& system, std::span<const Species> species,
                                            std::span<const std::uint8_t> shape_of_rod, const DirectorAt& directors) {
  SHAKEN_CHECK(!is_compressed(system.start), "sim/start/compression.h makes that");
  SHAKEN_CHECK(!directors || system.start == Start::kRandom, "only rods at random places follow a pattern");
  const Placement rods(system, species, shape_of_rod);
  if (rods.plates.gap < 2.0 * rods.max_radius()) return Error{"the gap is smaller than the thickest bead"};
  if (const double least = least_box_side(species); system.box().shorter() < least * (1.0 - 1e-9)) {
    return Error{"the box is too small: rods might meet two images of another below " + std::to_string(least) + " mm"};
  }
  return system.start == Start::kAligned ? aligned_rods(rods) : random_rods(rods, directors);
}

Result<World> make_world(const System& system) { return make_world_along(system, {}); }

Result<World> make_world_along(const System& system, const DirectorAt& directors) {
  World world = empty_world(system);
  world.rods = SHAKEN_TRY(initial_flights(system, world.species, world.shape_of_rod, directors));
  // what was promised is checked, not believed
  std::vector<Pose> poses;
  for (const Flight& flight : world.rods) poses.push_back({flight.position, flight.director});
  const std::size_t n_overlaps = find_overlaps(world, world.shape_of_rod, poses).size();
  SHAKEN_CHECK(n_overlaps == 0, std::to_string(n_overlaps) + " overlaps in the initial state");
  world.start = content(world);
  return world;
}

}  // namespace shaken
