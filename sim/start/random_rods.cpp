#include "sim/start/random_rods.h"

#include <algorithm>
#include <string>

#include "sim/contact/bead_contacts.h"
#include "sim/neighbors/neighbor_list.h"

namespace shaken {
namespace {

constexpr int kMaxInsertions = 20000;  ///< tries for one rod

}  // namespace

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

}  // namespace shaken
