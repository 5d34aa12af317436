#pragma once

#include <optional>
#include <span>
#include <vector>

#include "base/core/box.h"
#include "base/core/types.h"
#include "sim/rod/species.h"
#include "sim/start/placement.h"

namespace shaken {

/// A lattice that tiles the periodic box: `columns` sites to a row along x, each row shifted against the one
/// before by `turns` / `rows` of a column, so that the rows close in themselves. Each lattice of columns * rows sites
/// that the box can have is one of these, with 0 <= turns < rows (Hermite's normal form of its basis).
struct Lattice {
  int columns = 0;
  int rows = 0;
  int turns = 0;
  double clearance = 0;  ///< smallest of the gaps between rods [mm]
  int sites() const { return columns * rows; }

  /// Place of a site, 0 <= site < sites(), row by row [mm]; x may be beyond the box by less than its side.
  Vec3 position(int site, const Box& box) const {
    const int row = site / columns;
    const int column = site % columns;
    const auto shift = static_cast<double>(static_cast<long>(row) * turns % rows) / rows;
    return {(column + 0.25 + shift) * (box.x() / columns), (row + 0.5) * (box.y() / rows), 0};
  }
};

/// The roomiest lattice of rods along x with a usable site for every rod: rows of which every other one is shifted by
/// half a column; where none has room, rows that are shifted by another part of a column, which wind around the
/// periodic box several times. None if the rods do not fit.
std::optional<Lattice> rows_along_x(const Placement& rods);

/// The most rods for which rows_along_x() finds a lattice.
int most_in_rows_along_x(const Placement& rods);

/// Sites at which any rod is clear of side walls and posts, whichever way it lies along x.
std::vector<int> usable_sites(const Lattice& lattice, const Placement& rods);

/// Parallel rods at an angle to the sides of a periodic box. The box has to be tiled by the lattice of their
/// centres alone: the rods may point anywhere, as long as those at neighbouring sites are apart. So the angle is met
/// exactly, and what has to be found is a lattice with room for rods that lie so.
class TurnedRows {
 public:
  /// Rods of any of the species, either end ahead, may be at any site; their angle to the x axis is that of `along`, a
  /// unit vector. Gaps are at least `clearance` [mm].
  TurnedRows(std::span<const Species> species, const Box& box, const Vec2& along, double clearance);

  /// The roomiest lattice, by its smallest gap, of those with n_rods sites or a few more; where none of these has room,
  /// the first with more sites that has. None if all are too narrow.
  std::optional<Lattice> find(int n_rods) const;

  /// The largest number below n_rods of which find() finds a lattice; 0 if none.
  int most_below(int n_rods) const;

 private:
  /// Two beads of two rods: how far the other is ahead if the rods lie side by side, and at which distance they touch.
  struct BeadPair {
    double ahead;
    double touch;
  };
  /// Replaces `best` by a roomier lattice of so many sites, if there is one. Returns how many pairs of beads
  /// it has looked at, or so.
  double search(int n_sites, std::optional<Lattice>& best) const;
  /// Smallest gap in a lattice, or anything that is not above `least` if it is not.
  double clearance_of(const Lattice& lattice, double least) const;
  /// The same of two rods whose centres are `ahead` and `aside` of each other.
  double gap(double ahead, double aside) const;
  int most_sites() const;

  Box box_;
  Vec2 along_;
  double least_clearance_;
  double reach_ = 0;      ///< centres this far ahead of each other belong to rods that are apart [mm]
  double thickness_ = 0;  ///< and this far aside [mm]
  double area_ = 0;       ///< of the largest rod [mm^2]
  std::vector<BeadPair> pairs_;
};

}  // namespace shaken
