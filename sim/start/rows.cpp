#include "sim/start/rows.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

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

constexpr int kFewMore = 8;        ///< sites beyond one for each rod, among which the roomiest is looked for
constexpr double kMostWork = 3e8;  ///< pairs of beads looked at before it is given up, about a second

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

TurnedRows::TurnedRows(std::span<const Species> species, const Box& box, const Vec2& along, double clearance)
    : box_(box), along_(along), least_clearance_(clearance) {
  std::vector<std::pair<double, double>> beads;  // offset and radius of every bead that may lie ahead of a site
  for (const Species& kind : species) {
    area_ = std::max(area_, kind.area);
    for (int b = 0; b < kind.n_beads(); ++b) {
      for (const double sign : {1.0, -1.0}) beads.emplace_back(sign * kind.bead_offset[b], kind.bead_radius[b]);
      thickness_ = std::max(thickness_, 2.0 * kind.bead_radius[b]);
      reach_ = std::max(reach_, 2.0 * (std::abs(kind.bead_offset[b]) + kind.bead_radius[b]));
    }
  }
  for (const auto& [s_i, r_i] : beads) {
    for (const auto& [s_j, r_j] : beads) pairs_.push_back({s_j - s_i, r_i + r_j});
  }
  // A disc within another's, as most are, decides nothing.
  std::sort(pairs_.begin(), pairs_.end(), [](const BeadPair& one, const BeadPair& other) {
    return std::pair(one.ahead, -one.touch) < std::pair(other.ahead, -other.touch);
  });
  std::vector<BeadPair> kept;
  const auto keep_what_sticks_out = [&](double sign) {
    double farthest = -INFINITY;
    kept.clear();
    for (const BeadPair& pair : pairs_) {
      const double end = pair.touch + sign * pair.ahead;
      if (end > farthest) kept.push_back(pair);
      farthest = std::max(farthest, end);
    }
    std::reverse(kept.begin(), kept.end());
    pairs_ = kept;
  };
  keep_what_sticks_out(1.0);
  keep_what_sticks_out(-1.0);
}

double TurnedRows::gap(double ahead, double aside) const {
  double least = INFINITY;
  for (const BeadPair& pair : pairs_) {
    const double x = ahead + pair.ahead;
    least = std::min(least, std::sqrt(x * x + aside * aside) - pair.touch);
  }
  return least;
}

double TurnedRows::clearance_of(const Lattice& lattice, double least) const {
  // In units of a rod's length along the rods and of its thickness across, rods are about as long as wide.
  const double long_unit = reach_ + least, wide_unit = thickness_ + least;
  const auto seen = [&](double x, double y) {
    return Vec2((along_.x() * x + along_.y() * y) / long_unit, (along_.x() * y - along_.y() * x) / wide_unit);
  };
  const auto gap_at = [&](const Vec2& site) { return gap(site.x() * long_unit, site.y() * wide_unit); };
  const double pitch = box_.x() / lattice.columns;
  Vec2 one = seen(pitch, 0);
  Vec2 other = seen(pitch * lattice.turns / lattice.rows, box_.y() / lattice.rows);
  // the two shortest vectors of the lattice (Lagrange & Gauss)
  while (true) {
    if (other.squaredNorm() < one.squaredNorm()) std::swap(one, other);
    const Vec2 shorter = other - std::nearbyint(one.dot(other) / one.squaredNorm()) * one;
    if (!(shorter.squaredNorm() < (1.0 - 1e-9) * other.squaredNorm())) break;
    other = shorter;
  }
  double clearance = gap_at(one);
  if (!(clearance > least)) return clearance;
  clearance = std::min(clearance, gap_at(other));
  if (!(clearance > least)) return clearance;
  // Rods beyond 1 in either direction are apart by more than `least`, but may be nearer than the clearance so far. The
  // shortest vectors are at least 60 degrees apart, so i of one and j of the other are sin 60 times each away or more,
  // and a little less for rounding.
  const double far = std::sqrt(2.0) * (1.0 + clearance / wide_unit) / 0.866;
  const int most_one = static_cast<int>(far / one.norm()), most_other = static_cast<int>(far / other.norm());
  for (int j = 0; j <= most_other; ++j) {
    for (int i = j == 0 ? 1 : -most_one; i <= most_one; ++i) {
      clearance = std::min(clearance, gap_at(i * one + j * other));
      if (!(clearance > least)) return clearance;
    }
  }
  return clearance;
}

double TurnedRows::search(int n_sites, std::optional<Lattice>& best) const {
  double n_lattices = 0;
  for (int columns = 1; columns <= n_sites; ++columns) {
    if (n_sites % columns != 0) continue;
    const int rows = n_sites / columns;
    n_lattices += rows;
    for (int turns = 0; turns < rows; ++turns) {
      Lattice lattice{columns, rows, turns, 0};
      const double least = best ? best->clearance : least_clearance_;
      lattice.clearance = clearance_of(lattice, least);
      if (lattice.clearance > least) best = lattice;
    }
  }
  return n_lattices * static_cast<double>(pairs_.size());
}

int TurnedRows::most_sites() const { return static_cast<int>(std::min(box_.area() / area_, 2e9)); }

std::optional<Lattice> TurnedRows::find(int n_rods) const {
  std::optional<Lattice> best;
  double work = 0;
  for (int n = n_rods; n <= most_sites() && work < kMostWork; ++n) {
    if (best && n > n_rods + kFewMore) break;
    work += search(n, best);
  }
  return best;
}

int TurnedRows::most_below(int n_rods) const {
  std::optional<Lattice> best;
  double work = 0;
  for (int n = std::min(n_rods - 1, most_sites()); n > 0 && work < kMostWork; --n) {
    work += search(n, best);
    if (best) return n;
  }
  return 0;
}

}  // namespace shaken
