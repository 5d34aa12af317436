#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "base/core/box.h"
#include "base/core/types.h"
#include "sim/lanes/prefetch.h"
#include "sim/motion/flight.h"
#include "sim/rod/species.h"

namespace shaken {

/// The vector from `from` to the nearest periodic image of `to`; periodic in x and y only. The two must not be more
/// than a few million boxes apart.
inline Vec3 nearest_image(const Vec3& from, const Vec3& to, const Box& box) {
  // adding and taking away 1.5 * 2^52 rounds to the nearest whole number, ties to even, as nearbyint does
  const auto rounded = [](double x) {
    constexpr double kRounder = 6755399441055744.0;
    return (x + kRounder) - kRounder;
  };
  Vec3 d = to - from;
  d.x() -= box.x() * rounded(d.x() / box.x());
  d.y() -= box.y() * rounded(d.y() / box.y());
  return d;
}

/// Pairs of rods that may touch before one of them has to be placed anew. It looks at the rods' shadows on the plane
/// only: shadows apart means rods apart, and shadows move slowly, while the tips rock up and down every few
/// milliseconds.
///
/// A rod's shadow lies in the stadium of radius max_radius round the segment of half-length h along its in-plane
/// angle (h as if it lay flat). The list holds every pair of which any images have stadiums closer than `skin`, each as
/// it was when its rod was placed; it is complete as long as the ends of no segment have moved by half of that since. A
/// rod that has can be placed anew by itself, so the fastest of many rods costs no more than itself.
class NeighborList {
 public:
  static constexpr double kSkin = 0.4;  ///< that the scheduled stepper's list has [mm]

  struct Pair {
    int i = -1;  ///< -1: this number is not in use
    int j = -1;  ///< > i
  };

  /// `shape_of_rod` (n_rods): of each rod, an index into `species`.
  NeighborList(std::span<const Species> species, std::span<const std::uint8_t> shape_of_rod, const Box& box,
               double skin);

  /// True if the list may be incomplete for these poses (or was never built).
  bool is_due(std::span<const Pose> poses) const;
  /// Places every rod. Pairs are then numbered in ascending order of (i, j), without gaps.
  void build(std::span<const Pose> poses);
  /// Places rod i anew. Its pairs are to be replaced, once all rods to be placed in this tick are.
  void place(int i, const Pose& pose);
  /// Appends the rods that are near enough to i, as they are placed now, to make pairs.
  void find_near(int i, std::vector<int>& rods) const;
  /// Gives rod i pairs with the rods of `near`, and no others. Appends the numbers of the pairs that it gained and
  /// lost; others keep theirs. A number lost may come back as one gained.
  void replace_pairs(int i, std::span<const int> near, std::vector<int>& gained, std::vector<int>& lost);

  /// How much further the ends of rod i's segment may move before the list may be incomplete; negative: it may be [mm].
  double slack(int i, const Pose& pose) const;

  /// (highest number in use + 1), by number.
  const std::vector<Pair>& pairs() const { return pairs_; }
  /// Numbers of the pairs of rod i.
  std::span<const int> pairs_of(int i) const {
    return {pairs_of_.data() + static_cast<std::size_t>(i) * stride_, static_cast<std::size_t>(n_pairs_of_[i])};
  }
  /// Asks for what `slack` needs of rod i.
  void prefetch_place(int i) const { shaken::prefetch(places_[i]); }
  /// Heap memory held.
  std::size_t bytes() const;

 private:
  /// The stadium of one species.
  struct Shadow {
    double half_length;
    double radius;
  };
  /// Where the shadow of a rod was when it was last placed; one line of memory holds it.
  struct alignas(32) Place {
    Vec2 center;     ///< in the box
    Vec2 direction;  ///< of the segment
  };
  const Shadow& shadow(int i) const { return shadows_[shape_of_rod_[i]]; }
  /// How near the segments of two rods must be to make a pair.
  double reach(int i, int j) const { return shadow(i).radius + shadow(j).radius + skin_; }
  void note_place(int i, const Pose& pose);
  int cell_of(const Vec2& center) const;
  void put_into_cell(int i, int cell);
  bool are_near(int i, int j) const;                 ///< in any image
  bool are_near(int i, int j, const Vec3& D) const;  ///< with D from the centre of i to that of j
  /// Calls each(j) for every other rod whose centre may be near enough to i's.
  template <class Each>
  void for_candidates(int i, const Each& each) const;
  int add_pair(int i, int j);
  void add_to(int i, int p);
  void remove_from(int i, int p);

  std::vector<Shadow> shadows_;             ///< (n_shapes)
  std::vector<std::uint8_t> shape_of_rod_;  ///< (n_rods)
  double skin_;
  Box box_;
  std::array<int, 2> n_cells_;  ///< along x and y; 1, 1: no grid
  std::array<int, 2>
      n_images_;  ///< to each side of the nearest that may be near; 0 where the box is twice as wide as pairs
                  ///< are long

  std::vector<Place> places_;              ///< (n_rods)
  std::vector<int> cell_;                  ///< (n_rods) cell of each rod
  std::vector<std::vector<int>> members_;  ///< (n_cells) rods of each cell

  std::vector<Pair> pairs_;
  std::vector<int> unused_;    ///< numbers
  std::vector<int> pairs_of_;  ///< (n_rods x stride)
  std::vector<int> n_pairs_of_;
  std::size_t stride_ = 16;
  std::vector<int> mark_;  ///< (n_rods) scratch
};

}  // namespace shaken
