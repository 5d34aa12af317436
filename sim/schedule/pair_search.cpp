// SPDX-License-Identifier: MIT
#include "sim/schedule/pair_search.h"

#include <algorithm>
#include <cmath>

#include "sim/bounds/image_safe_time.h"
#include "sim/bounds/margins.h"

namespace shaken {
namespace {

/// Where the hull's bound is shorter than this, the beads' own may be longer: rods interlock [ticks].
constexpr float kShortBound = 150;

}  // namespace

PairSearch::PairSearch(const TickRules& rules) : rules_(rules) {
  for (const SpeciesMechanics& species : rules.species) {
    hulls_.emplace_back(species);
    lanes_.emplace_back(species);
    reach_.push_back(species.reach());
  }
  const double longest = *std::max_element(reach_.begin(), reach_.end());
  // such that pairs in the neighbour list, and rods of 1.2 times the reach, are near
  const double near = 4.0 * longest + std::max(0.4 * longest, 2.0 * NeighborList::kSkin);
  const double horizon = static_cast<double>(TimingWheel::horizon()) * rules.dt;
  const double slow = std::max(0.0, rules.box.shorter() - near) / (2.0 * horizon);
  slow_ = static_cast<float>(slow);
  slow_now_ = static_cast<float>(std::max(0.0, slow - rules.gravity.along_size() * horizon));
}

bool PairSearch::find(const PairRods& pair, const Pose& pose_i, const Pose& pose_j, const Direction& direction,
                      std::vector<BeadContact>& beads, std::vector<PairContact>& contacts) const {
  const auto& [i, j] = pair;
  const std::uint8_t shape_i = rules_.shape_of_rod[i];
  const std::uint8_t shape_j = rules_.shape_of_rod[j];
  const Vec3 D = nearest_image(pose_i.position, pose_j.position, rules_.box);
  const Vec3 d(direction[0], direction[1], direction[2]);
  if (hull_gap(hulls_[shape_i], std::abs(pose_i.director.dot(d)), hulls_[shape_j], std::abs(pose_j.director.dot(d)),
               D.dot(d)) > margins::kHullsApart)
    return false;
  const BeadRange beads_i = beads_may_overlap(lanes_[shape_i], pose_i.director, lanes_[shape_j], pose_j.director, D);
  if (beads_i.empty()) return false;
  beads.clear();
  find_bead_contacts(rules_.species[shape_i], pose_i.director, rules_.species[shape_j], pose_j.director, D, beads_i,
                     beads);
  for (const BeadContact& contact : beads) contacts.push_back({i, j, contact});
  return !beads.empty();
}

void PairSearch::bound(std::span<const PairRods> pairs, const std::vector<RodAtTick>& rods,
                       const std::vector<FlightBound>& motion, PairLanes& lanes, PairBounds& bounds) const {
  const std::uint8_t shape_i = rules_.shape_of_rod[pairs.front()[0]];
  const std::uint8_t shape_j = rules_.shape_of_rod[pairs.front()[1]];
  HullSafeTimes hull;
  Vec3 D[kLanes];
  for (std::size_t lane = 0; lane < pairs.size(); ++lane) {
    const auto& [i, j] = pairs[lane];
    D[lane] = nearest_image(rods[i].pose.position, rods[j].pose.position, rules_.box);
    lanes.set(static_cast<int>(lane), D[lane], motion[i], motion[j]);
  }
  const auto horizon = static_cast<float>(static_cast<double>(TimingWheel::horizon() - 1) * rules_.dt);
  hull_safe_times(hulls_[shape_i], hulls_[shape_j], lanes, static_cast<int>(pairs.size()), horizon, hull);

  const auto per_dt = static_cast<float>((1.0 - static_cast<double>(margins::kTime)) / rules_.dt);
  const auto dt = static_cast<float>(rules_.dt);
  const double reach = reach_[shape_i] + reach_[shape_j];
  for (std::size_t lane = 0; lane < pairs.size(); ++lane) {
    const FlightBound& i = motion[pairs[lane][0]];
    const FlightBound& j = motion[pairs[lane][1]];
    float time = hull.time[lane];
    float gap = hull.gap[lane];
    float left = hull.left[lane];
    bool isotropic = false;
    bounds.may_overlap[lane] = time <= 0.0F;
    bounds.direction[lane] = {hull.direction[0][lane], hull.direction[1][lane], hull.direction[2][lane]};
    bounds.by_beads[lane] = time < kShortBound * dt;
    if (bounds.by_beads[lane]) {
      const BeadSafeTime beads = bead_safe_time(lanes_[shape_i], i, lanes_[shape_j], j, D[lane], kBeadHorizon * dt);
      if (beads.time > time) {
        time = beads.time;
        gap = beads.gap;
        left = gap > 0.0F ? 0.0F : -1.0F;
        isotropic = true;
        if (gap > 0.0F) bounds.may_overlap[lane] = false;
      }
    }
    if (!(i.slow && j.slow && images_stay_away(D[lane], rules_.box, reach, slow_, horizon))) {
      time = std::min(time, image_safe_time(D[lane], i, j, rules_.box, reach, horizon));
      left = -1;
    }
    const auto ticks = static_cast<int>(time * per_dt);
    bounds.ticks[lane] = ticks;
    bounds.gap[lane] =
        left < 0.0F ? GapBound{} : GapBound::between(gap, left, time, static_cast<float>(ticks) * dt, isotropic);
  }
}

}  // namespace shaken
