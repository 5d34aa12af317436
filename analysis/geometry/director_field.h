#pragma once

#include <span>
#include <vector>

#include "analysis/geometry/region.h"
#include "base/core/types.h"

namespace shaken::analysis {

/// More nodes in one direction no grid has: a field of them would take terabytes.
inline constexpr int kMostGridNodes = 1'000'000;
/// Numbers of nodes of a grid over a box.
struct Grid {
  /// Not explicit: n to each side.
  Grid(int n) : columns(n), rows(n) {}
  /// The coarsest whose meshes are at most `mesh` [mm] wide and high; at least 4 nodes each way.
  Grid(const Box& box, double mesh);
  std::size_t nodes() const { return static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows); }

  int columns, rows;  ///< along x and y
};

/// The smoothed in-plane order tensor on a grid over the box,
///   Q_ab(x) = sum_i K(x - x_i) (n_a n_b - delta_ab / 2) / sum_i K(x - x_i),
/// n being the unit in-plane direction of rod i and K a Gaussian of standard deviation `smoothing`, cut at four of
/// them. Q_xx = (S/2) cos 2 theta and Q_xy = (S/2) sin 2 theta give the local order S and the director's angle theta.
/// Node (i, j) lies at node(i, j); i and j may be any integer. In a periodic box the grid is periodic;
/// within walls no rod is smoothed across the border of the box, and nodes beyond it are those at it.
///
/// Where there are no rods there is no director. The density at a node is what the Gaussian finds of rods over what it
/// finds of the region, sum_i K(x - x_i) / sum_nodes K(x - x_node) over the nodes within walls; below half of the
/// mean, or beyond the walls, the director is undefined. Q there is still that of the few rods in reach.
class DirectorField {
 public:
  /// The density below which there is no director, in units of the mean.
  static constexpr double kFloor = 0.5;

  /// From centres (n_rods) [mm], anywhere (wrapped here), and directors (n_rods). Rods exactly upright are left out; a
  /// node that no rod reaches has Q = 0.
  DirectorField(std::span<const Vec3> positions, std::span<const Vec3> directors, const Region& region,
                const Grid& grid, double smoothing);

  const Grid& grid() const { return grid_; }
  const Region& region() const { return region_; }
  Vec2 mesh() const { return {region_.box().x() / grid_.columns, region_.box().y() / grid_.rows}; }  ///< each way [mm]
  Vec2 node(int i, int j) const { return mesh().cwiseProduct(Vec2(i, j)); }                          ///< [mm]
  double smoothing() const { return smoothing_; }                                                    ///< [mm]

  double q_xx(int i, int j) const { return q_xx_[index(i, j)]; }
  double q_xy(int i, int j) const { return q_xy_[index(i, j)]; }
  /// Whether there are rods enough at a node within the walls for a director.
  bool is_defined(int i, int j) const { return defined_[index(i, j)]; }
  double theta(int i, int j) const;  ///< in [-pi/2, pi/2) [rad]; 0 where Q = 0

  /// (Q_xx, Q_xy) anywhere [mm], bilinear between the nodes.
  Vec2 q_at(const Vec2& position) const;

 private:
  std::size_t index(int i, int j) const;

  Grid grid_;
  Region region_;
  double smoothing_;
  std::vector<double> q_xx_, q_xy_;  // (rows * columns), i fastest
  std::vector<bool> defined_;        // (rows * columns)
};

}  // namespace shaken::analysis
