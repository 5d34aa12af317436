#include "sim/start/rows_along_x.h"

#include <algorithm>

#include "sim/motion/side_walls.h"

namespace shaken {
namespace {

Lattice every_other_row_shifted(int columns, int rows, double clearance = 0) {
  return {columns, rows, rows / 2, clearance};
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
  const int max_columns = static_cast<int>(box.x() / (rods.rod_extent() + Placement::kClearance));
  std::vector<Columns> all;
  for (int columns = 1; columns <= max_columns; ++columns) {
    const double pitch = box.x() / columns;
    const double next_row = rods.least_row_distance(pitch, 0.5 * pitch) + Placement::kClearance;
    const double row_after = rods.least_row_distance(pitch, 0.0) + Placement::kClearance;
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
  const double reach = 2.0 * rods.max_radius() + Placement::kClearance;
  std::vector<double> least_distance;  // of two rows, by their shift in parts of `rows`; it is the same to either side
  for (int part = 0; part <= rows / 2; ++part) {
    least_distance.push_back(rods.least_row_distance(pitch, part * pitch / rows) + Placement::kClearance);
  }
  std::optional<Lattice> best;
  for (int turns = 0; turns <= rows / 2; ++turns) {  // beyond, they are mirror images
    double clearance = pitch - rods.rod_extent() - Placement::kClearance;
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
  const int max_columns = static_cast<int>(box.x() / (rods.rod_extent() + Placement::kClearance));
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

}  // namespace

std::vector<int> usable_sites(const Lattice& lattice, const Placement& rods) {
  const Box box = rods.system.box();
  const double reach =
      0.5 * rods.rod_extent() + Placement::kClearance;  // beyond it no bead is near a wall, however the rod lies
  const Vec2 most = 0.5 * rectangle_round(box, rods.system.walls);
  const auto is_clear = [&](const Vec3& position) {
    const Vec2 off = (position.head<2>() - 0.5 * box.sides()).cwiseAbs();
    if (off.x() > most.x() || off.y() > most.y()) return false;  // soon known
    const bool is_near = rods.has_posts() || distance_to_walls(*rods.system.walls, box, position, reach) < reach;
    return !is_near || std::ranges::all_of(rods.species, [&](const Species& kind) {
      return rods.is_clear(kind, {position, Vec3(1, 0, 0)}) && rods.is_clear(kind, {position, Vec3(-1, 0, 0)});
    });
  };
  std::vector<int> sites;
  for (int site = 0; site < lattice.sites(); ++site) {
    if (!rods.has_uprights() || is_clear(lattice.position(site, box))) sites.push_back(site);
  }
  return sites;
}

std::optional<Lattice> rows_along_x(const Placement& rods) {
  const auto lattice = find_lattice(rods);
  return lattice ? lattice : find_winding_lattice(rods);
}

int most_in_rows_along_x(const Placement& rods) { return most_in_winding_rows(rods, most_usable_sites(rods)); }

}  // namespace shaken
