// SPDX-License-Identifier: MIT
#include "sim/neighbors/neighbor_list.h"

#include <algorithm>
#include <cmath>

#include "sim/contact/bead_contacts.h"

namespace shaken {

NeighborList::NeighborList(const Species& species, double box_side, double skin)
    : half_length_(species.half_length), reach_(2.0 * species.max_radius + skin), skin_(skin), box_side_(box_side) {}

Vec2 NeighborList::flat_half(const Pose& pose) const {
  const Vec2 n(pose.director.x(), pose.director.y());
  const double length = n.norm();
  // an upright rod's shadow fits whatever angle it is given
  return length > 0 ? Vec2(n * (half_length_ / length)) : Vec2(half_length_, 0.0);
}

double NeighborList::slack(int i, const Pose& pose) const {
  Vec2 shift(pose.position.x() - built_center_[i].x(), pose.position.y() - built_center_[i].y());
  shift.x() -= box_side_ * std::nearbyint(shift.x() / box_side_);
  shift.y() -= box_side_ * std::nearbyint(shift.y() / box_side_);
  const Vec2 turn = flat_half(pose) - built_half_[i];
  return 0.5 * skin_ - std::sqrt(std::max((shift + turn).squaredNorm(), (shift - turn).squaredNorm()));
}

bool NeighborList::is_due(std::span<const Pose> poses) const {
  if (n_builds_ == 0) return true;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    if (slack(static_cast<int>(i), poses[i]) < 0) return true;
  }
  return false;
}

void NeighborList::build(std::span<const Pose> poses) {
  const int n = static_cast<int>(poses.size());
  built_center_.resize(n);
  built_half_.resize(n);
  for (int i = 0; i < n; ++i) {
    built_center_[i] = {poses[i].position.x(), poses[i].position.y()};
    built_half_[i] = flat_half(poses[i]);
  }

  pairs_.clear();
  const auto consider = [&](int i, int j) {
    const Vec3 D = nearest_image({built_center_[i].x(), built_center_[i].y(), 0},
                                 {built_center_[j].x(), built_center_[j].y(), 0}, box_side_);
    const double centers = 2.0 * half_length_ + reach_;
    if (D.squaredNorm() > centers * centers) return;
    Vec3 u_i = Vec3::UnitX();
    Vec3 u_j = Vec3::UnitX();
    if (half_length_ > 0) {
      u_i = Vec3(built_half_[i].x(), built_half_[i].y(), 0) / half_length_;
      u_j = Vec3(built_half_[j].x(), built_half_[j].y(), 0) / half_length_;
    }
    if (segment_distance_squared(D, u_i, half_length_, u_j, half_length_) > reach_ * reach_) return;
    pairs_.emplace_back(std::min(i, j), std::max(i, j));
  };

  // cells at least as wide as two centres of a pair can be apart; below 3 x 3 cells every pair is a neighbour's
  const int cells = static_cast<int>(std::floor(box_side_ / (2.0 * half_length_ + reach_)));
  if (cells < 3) {
    for (int i = 0; i < n; ++i) {
      for (int j = i + 1; j < n; ++j) consider(i, j);
    }
  } else {
    const auto cell_of = [&](double x) {
      const double fraction = x / box_side_ - std::floor(x / box_side_);
      return std::min(cells - 1, static_cast<int>(fraction * cells));
    };
    std::vector<std::vector<int>> members(static_cast<std::size_t>(cells) * cells);
    for (int i = 0; i < n; ++i)
      members[cell_of(built_center_[i].y()) * cells + cell_of(built_center_[i].x())].push_back(i);
    for (int cy = 0; cy < cells; ++cy) {
      for (int cx = 0; cx < cells; ++cx) {
        const auto& own = members[cy * cells + cx];
        for (std::size_t a = 0; a < own.size(); ++a) {
          for (std::size_t b = a + 1; b < own.size(); ++b) consider(own[a], own[b]);
        }
        // half of the eight cells around, so that each pair of cells is met once
        constexpr int kAround[4][2] = {{1, 0}, {-1, 1}, {0, 1}, {1, 1}};
        for (const auto& [dx, dy] : kAround) {
          const auto& other = members[((cy + dy + cells) % cells) * cells + (cx + dx + cells) % cells];
          for (int i : own) {
            for (int j : other) consider(i, j);
          }
        }
      }
    }
  }
  std::sort(pairs_.begin(), pairs_.end());
  ++n_builds_;
}

}  // namespace shaken
