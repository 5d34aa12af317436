// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include "sim/core/types.h"

namespace shaken::analysis {

/// Nodes of the coarsest square grid over `box_side` whose mesh is at most `mesh` (both [mm]); at least 4.
int grid_nodes(double box_side, double mesh);

/// The smoothed in-plane order tensor on a periodic grid of n x n nodes,
///   Q_ab(x) = sum_i K(x - x_i) (n_a n_b - delta_ab / 2) / sum_i K(x - x_i),
/// n being the unit in-plane direction of rod i and K a Gaussian of standard deviation `smoothing`, cut at four of
/// them. Q_xx = (S/2) cos 2 theta and Q_xy = (S/2) sin 2 theta give the local order S and the director's angle theta.
/// The grid is periodic even where walls stand round the rods: nodes within four smoothing lengths of its border also
/// see the rods across it.
/// Node (i, j) lies at x = i * mesh, y = j * mesh; i and j may be any integer.
class DirectorField {
 public:
  /// From centres (n_rods) [mm], anywhere (wrapped here), and directors (n_rods). Rods exactly upright are left out; a
  /// node that no rod reaches has Q = 0.
  DirectorField(std::span<const Vec3> positions, std::span<const Vec3> directors, double box_side, int n,
                double smoothing);

  int n() const { return n_; }
  double box_side() const { return box_side_; }    ///< [mm]
  double mesh() const { return box_side_ / n_; }   ///< [mm]
  double smoothing() const { return smoothing_; }  ///< [mm]

  double q_xx(int i, int j) const { return q_xx_[index(i, j)]; }
  double q_xy(int i, int j) const { return q_xy_[index(i, j)]; }
  double theta(int i, int j) const;  ///< in [-pi/2, pi/2) [rad]; 0 where Q = 0
  double order(int i, int j) const;  ///< local S in [0, 1]

  /// (Q_xx, Q_xy) anywhere [mm], bilinear between the nodes.
  Vec2 q_at(const Vec2& position) const;
  double theta_at(const Vec2& position) const;  ///< of the interpolated Q
  double order_at(const Vec2& position) const;  ///< of the interpolated Q

 private:
  std::size_t index(int i, int j) const;

  int n_;
  double box_side_, smoothing_;
  std::vector<double> q_xx_, q_xy_;  // (n * n), i fastest
};

}  // namespace shaken::analysis
