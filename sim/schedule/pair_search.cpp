#include "sim/schedule/pair_search.h"

#include <algorithm>
#include <cmath>

#include "sim/bounds/margins.h"
#include "sim/bounds/safe_time.h"

namespace shaken {
namespace {

/// Where the hull's bound is shorter than this, the beads' own may be longer: rods interlock [ticks].
/// Price as in pair_schedule.cpp; 75: 0.2 % less, and 0.1 % more; 300: 0.6 and 0.2 % more.
constexpr float kShortBound = 150;

}  // namespace

PairSearch::PairSearch(const TickRules& rules)
    : rules_(rules),
      horizon_(static_cast<float>(static_cast<double>(TimingWheel::horizon() - 1) * rules.dt)),
      per_dt_(static_cast<float>((1.0 - static_cast<double>(margins::kTime)) / rules.dt)) {
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
  slow_later_ = static_cast<float>(slow);
  slow_speed_ = static_cast<float>(std::max(0.0, slow - rules.gravity.along_size() * horizon));
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
                       const std::vector<FlightBound>& motion, PairLanes& lanes, PairBound* bounds) const {
  HullSafeTimes safe;
  Vec3 D[kLanes];
  for (std::size_t lane = 0; lane < pairs.size(); ++lane) {
    const auto& [i, j] = pairs[lane];
    D[lane] = nearest_image(rods[i].pose.position, rods[j].pose.position, rules_.box);
    lanes.set(static_cast<int>(lane), D[lane], motion[i], motion[j]);
  }
  const Shapes shapes{rules_.shape_of_rod[pairs.front()[0]], rules_.shape_of_rod[pairs.front()[1]]};
  hull_safe_times(hulls_[shapes[0]], hulls_[shapes[1]], lanes, static_cast<int>(pairs.size()), horizon_, safe);
  for (std::size_t lane = 0; lane < pairs.size(); ++lane) {
    const auto& [i, j] = pairs[lane];
    bounds[lane] = bound(shapes, D[lane], motion[i], motion[j], safe, lane);
  }
}

/// The longest of the bounds by hulls and by beads, but no longer than other images stay away.
PairBound PairSearch::bound(const Shapes& shapes, const Vec3& D, const FlightBound& i, const FlightBound& j,
                            const HullSafeTimes& hulls, std::size_t lane) const {
  const auto dt = static_cast<float>(rules_.dt);
  float time = hulls.time[lane];
  float gap = hulls.gap[lane];
  float gap_at_end = hulls.gap_at_end[lane];
  bool survives_hits = !(gap_at_end < 0.0F);
  bool isotropic = false;
  PairBound bound;
  bound.may_overlap = time <= 0.0F;
  bound.direction = {hulls.direction[0][lane], hulls.direction[1][lane], hulls.direction[2][lane]};
  bound.by_beads = time < kShortBound * dt;
  if (bound.by_beads) {
    const BeadSafeTime beads = bead_safe_time(lanes_[shapes[0]], i, lanes_[shapes[1]], j, D, kBeadHorizon * dt);
    if (beads.time > time) {
      time = beads.time;
      gap = beads.gap;
      gap_at_end = 0.0F;
      isotropic = true;
      survives_hits = gap > 0.0F;
      if (gap > 0.0F) bound.may_overlap = false;
    }
  }
  const double reach = reach_[shapes[0]] + reach_[shapes[1]];
  if (!(i.slow && j.slow && images_stay_away(D, rules_.box, reach, slow_later_, horizon_))) {
    time = std::min(time, image_safe_time(D, i, j, rules_.box, reach, horizon_));
    survives_hits = false;
  }
  bound.ticks = static_cast<int>(time * per_dt_);
  if (survives_hits)
    bound.gap = GapBound::between(gap, gap_at_end, time, static_cast<float>(bound.ticks) * dt, isotropic);
  return bound;
}

}  // namespace shaken
