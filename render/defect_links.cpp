#include "render/defect_links.h"

#include <algorithm>

namespace shaken::render {

Vec2 DefectLife::at(double when) const {
  const auto next = std::lower_bound(time.begin(), time.end(), when) - time.begin();
  const auto after = std::min(static_cast<std::size_t>(next), time.size() - 1);
  const std::size_t before = after > 0 ? after - 1 : 0;
  return when - time[before] < time[after] - when ? position[before] : position[after];
}

DefectLinks::DefectLinks(const analysis::Region& region, double rod_length)
    : region_(region),
      tracks_({.period = region.period(),
               .area = region.area(),
               .interval = 1,  // of its statistics, which are not asked for; as is the life that counts as lasting
               .max_step = rod_length,
               .min_lifetime = 0}) {}

void DefectLinks::add(double time, const std::vector<analysis::Defect>& defects) {
  tracks_.accumulate(time, defects);
  const std::vector<std::int64_t> ids = tracks_.ids();
  lives_.resize(static_cast<std::size_t>(tracks_.n_tracks()));
  for (std::size_t i = 0; i < defects.size(); ++i) {
    DefectLife& life = lives_[static_cast<std::size_t>(ids[i])];
    Vec2 place = defects[i].position;
    if (!life.position.empty()) {
      const Vec2 last = life.position.back(), way = place - last;
      place = last + region_.shortest(way);
    }
    life.charge = defects[i].charge;
    life.time.push_back(time);
    life.position.push_back(place);
  }
}

std::vector<DefectTrail> DefectLinks::trails(double time, double span) const {
  constexpr double kRounding = 1e-9;
  std::vector<DefectTrail> trails;
  for (const DefectLife& life : lives_) {
    // Piece by piece: [begin, end) without a jump.
    for (std::size_t begin = 0, end = 0; begin < life.time.size(); begin = end) {
      const auto is_jump = [&](std::size_t k) {
        return (life.position[k] - life.position[k - 1]).norm() > kFastest * (life.time[k] - life.time[k - 1]);
      };
      for (end = begin + 1; end < life.time.size() && !is_jump(end);) ++end;
      if (life.time[end - 1] - life.time[begin] < kShortest * (1 - kRounding)) continue;
      DefectTrail trail{life.charge, {}};
      for (std::size_t k = begin; k < end; ++k) {
        const double age = (time - life.time[k]) / span;
        if (age >= 0 && age <= 1 + kRounding) trail.places.push_back({life.position[k], std::min(age, 1.0)});
      }
      if (trail.places.size() > 1) trails.push_back(std::move(trail));
    }
  }
  return trails;
}

std::optional<DefectLife> DefectLinks::longest(double charge, std::size_t rank) const {
  std::vector<const DefectLife*> found;
  for (const DefectLife& life : lives_) {
    if (life.charge == charge) found.push_back(&life);
  }
  if (rank >= found.size()) return std::nullopt;
  const auto lived = [](const DefectLife* life) { return life->time.back() - life->time.front(); };
  std::stable_sort(found.begin(), found.end(),
                   [&](const DefectLife* a, const DefectLife* b) { return lived(a) > lived(b); });
  return *found[rank];
}

std::size_t DefectLinks::count(double charge) const {
  return static_cast<std::size_t>(
      std::count_if(lives_.begin(), lives_.end(), [&](const DefectLife& life) { return life.charge == charge; }));
}

}  // namespace shaken::render
