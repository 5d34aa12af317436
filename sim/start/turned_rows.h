#pragma once

#include <optional>
#include <span>

#include "base/core/box.h"
#include "sim/rod/species.h"
#include "sim/start/lattice.h"

namespace shaken {

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
