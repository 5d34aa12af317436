// SPDX-License-Identifier: MIT
#include "sim/stepping/pair_search.h"

#include <algorithm>
#include <cmath>

#include "sim/contact/image_safe_time.h"
#include "sim/stepping/motion_drift.h"

namespace shaken {
namespace {

/// Where the hull's bound is shorter than this, the beads' own may be longer: rods interlock [ticks].
constexpr float kShortBound = 30;
/// Interlocked rods are visited again within this time: further ahead their bounds are not worth the work [ticks].
constexpr float kBeadHorizon = 200;
/// A bound for perturbed flight is good enough if it is this long [ticks]; a shorter one gives way to the bound for
/// unperturbed flight, unless that is not much longer either. The plates hit a rod about every 50 ticks.
constexpr float kLongBound = 40;
constexpr float kMuchLonger = 1.5;

}  // namespace

PairSearch::PairSearch(const TickRules& rules) : rules_(rules) {
  for (const SpeciesMechanics& species : rules.species) {
    hulls_.emplace_back(species);
    lanes_.emplace_back(species);
    reach_.push_back(species.reach());
  }
}

bool PairSearch::find(const PairRods& pair, const Pose& pose_i, const Pose& pose_j, const Direction& direction,
                      std::vector<BeadContact>& beads, std::vector<PairContact>& contacts) const {
  const auto& [i, j] = pair;
  const std::uint8_t species_i = rules_.species_of_rod[i];
  const std::uint8_t species_j = rules_.species_of_rod[j];
  const Vec3 D = nearest_image(pose_i.position, pose_j.position, rules_.box_side);
  constexpr double kMargin = 1e-5;
  const Vec3 d(direction[0], direction[1], direction[2]);
  if (hull_gap(hulls_[species_i], std::abs(pose_i.director.dot(d)), hulls_[species_j], std::abs(pose_j.director.dot(d)),
               D.dot(d)) > kMargin)
    return false;
  const BeadRange beads_i =
      beads_may_overlap(lanes_[species_i], pose_i.director, lanes_[species_j], pose_j.director, D);
  if (beads_i.empty()) return false;
  beads.clear();
  find_bead_contacts(rules_.species[species_i], pose_i.director, rules_.species[species_j], pose_j.director, D, beads_i,
                     beads);
  for (const BeadContact& contact : beads) contacts.push_back({i, j, contact});
  return !beads.empty();
}

void PairSearch::bound(std::span<const PairRods> pairs, const std::vector<RodAtTick>& rods,
                       const std::vector<MotionBound>& motion, PairLanes& lanes, PairBounds& bounds) const {
  const std::uint8_t species_i = rules_.species_of_rod[pairs.front()[0]];
  const std::uint8_t species_j = rules_.species_of_rod[pairs.front()[1]];
  HullSafeTimes hull;
  Vec3 D[kLanes];
  for (std::size_t lane = 0; lane < pairs.size(); ++lane) {
    const auto& [i, j] = pairs[lane];
    D[lane] = nearest_image(rods[i].pose.position, rods[j].pose.position, rules_.box_side);
    lanes.set(static_cast<int>(lane), D[lane], motion[i], motion[j]);
  }
  const auto horizon = static_cast<float>(static_cast<double>(TimingWheel::horizon() - 1) * rules_.dt);
  hull_safe_times(hulls_[species_i], hulls_[species_j], lanes, kMotionTolerance, horizon, hull);

  const auto per_dt = static_cast<float>((1.0 - 1e-5) / rules_.dt);
  for (std::size_t lane = 0; lane < pairs.size(); ++lane) {
    const auto& [i, j] = pairs[lane];
    float unperturbed = hull.unperturbed[lane] * per_dt;
    float perturbed = hull.perturbed[lane] * per_dt;
    if (unperturbed < kShortBound && perturbed < kShortBound) {
      const SafeTime beads = bead_safe_time(lanes_[species_i], motion[i], lanes_[species_j], motion[j], D[lane],
                                            kMotionTolerance, kBeadHorizon * static_cast<float>(rules_.dt));
      unperturbed = std::max(unperturbed, beads.unperturbed * per_dt);
      perturbed = std::max(perturbed, beads.perturbed * per_dt);
    }
    const SafeTime images = image_safe_time(D[lane], motion[i], motion[j], kMotionTolerance, rules_.box_side,
                                            reach_[species_i] + reach_[species_j], horizon);
    unperturbed = std::min(unperturbed, images.unperturbed * per_dt);
    perturbed = std::min(perturbed, images.perturbed * per_dt);
    const bool take_unperturbed = perturbed < kLongBound && perturbed * kMuchLonger < unperturbed;
    bounds.ticks[lane] = static_cast<Tick>(take_unperturbed ? unperturbed : perturbed);
    bounds.unperturbed[lane] = take_unperturbed;
    bounds.hulls_overlap[lane] = hull.unperturbed[lane] <= 0.0F;
    bounds.direction[lane] = {hull.direction[0][lane], hull.direction[1][lane], hull.direction[2][lane]};
  }
}

}  // namespace shaken
