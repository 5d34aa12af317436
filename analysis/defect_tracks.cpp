#include "analysis/defect_tracks.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <tuple>
#include <utility>

#include "analysis/bins.h"
#include "base/core/check.h"

namespace shaken::analysis {
namespace {

/// Pairs (i, j), i < n_first, j < n_second, the closest first; every index at most once.
/// @param distance  of a pair, or infinity if it must not be
std::vector<std::pair<std::size_t, std::size_t>> closest_first(
    std::size_t n_first, std::size_t n_second, const std::function<double(std::size_t, std::size_t)>& distance) {
  std::vector<std::tuple<double, std::size_t, std::size_t>> candidates;
  for (std::size_t i = 0; i < n_first; ++i) {
    for (std::size_t j = 0; j < n_second; ++j) {
      const double d = distance(i, j);
      if (std::isfinite(d)) candidates.emplace_back(d, i, j);
    }
  }
  std::sort(candidates.begin(), candidates.end());
  std::vector<bool> first_taken(n_first), second_taken(n_second);
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  for (const auto& [d, i, j] : candidates) {
    if (first_taken[i] || second_taken[j]) continue;
    first_taken[i] = second_taken[j] = true;
    pairs.emplace_back(i, j);
  }
  return pairs;
}

constexpr double kFar = std::numeric_limits<double>::infinity();

}  // namespace

DefectTracks::DefectTracks(const Settings& settings) : settings_(settings) {
  SHAKEN_CHECK(settings.area > 0 && settings.interval > 0 && settings.max_step > 0,
               "tracks need room, samples and a cut-off");
}

Vec2 DefectTracks::shortest(const Vec2& difference) const {
  const auto folded = [](double way, double side) { return side > 0 ? std::remainder(way, side) : way; };
  return {folded(difference.x(), settings_.period.x()), folded(difference.y(), settings_.period.y())};
}

double DefectTracks::cut_off(double charge, std::span<const Defect> defects) const {
  const auto now = std::count_if(defects.begin(), defects.end(), [&](const Defect& d) { return d.charge == charge; });
  const auto before = std::count_if(tracks_.begin(), tracks_.end(), [&](const Track& t) { return t.charge == charge; });
  const auto n = static_cast<double>(std::max<std::ptrdiff_t>({now, before, 1}));
  return std::min(settings_.max_step, 0.5 * std::sqrt(settings_.area / n));
}

DefectTracks::Track DefectTracks::begin(double time, const Defect& defect) {
  const Vec2 ray(std::cos(defect.direction), std::sin(defect.direction));
  return {next_id_++, defect.charge, time, true, -1, false, {{time, defect.position, ray}}, {}};
}

void DefectTracks::extend(Track& track, double time, const Defect& defect, TrackSums& sums) const {
  const Vec2 last = track.trail.back().position;
  const Vec2 ray(std::cos(defect.direction), std::sin(defect.direction));
  track.trail.push_back({time, last + shortest(defect.position - last), ray});
  if (track.trail.size() > kTrackSpans.back() + 1) track.trail.erase(track.trail.begin());
  if (std::abs(track.charge) != 0.5) return;
  TrackSums::Tracks& own = track.lasting ? sums.lasting : track.pending;
  for (std::size_t k = 0; k < kTrackSpans.size(); ++k) {
    const auto span = static_cast<std::size_t>(kTrackSpans[k]);
    if (track.trail.size() <= span) break;
    const Place* from = &track.trail[track.trail.size() - 1 - span];
    const Place* to = &track.trail.back();
    const Vec2 velocity = (to->position - from->position) / (to->time - from->time);
    Vec2 ray_sum = Vec2::Zero();
    for (const Place* place = from; place <= to; ++place) ray_sum += place->ray;
    const Vec2 p = ray_sum.norm() > 0 ? Vec2(ray_sum.normalized()) : Vec2(Vec2::Zero());
    for (TrackSums::Tracks* tracks : {&sums.all, &own}) {
      TrackSums::Speeds& speeds = (track.charge > 0 ? tracks->plus : tracks->minus)[k];
      speeds.n += 1;
      speeds.speed += velocity.norm();
      speeds.along += velocity.dot(p);
      speeds.across += velocity.y() * p.x() - velocity.x() * p.y();
    }
  }
}

void DefectTracks::end(const std::vector<Track>& dead, double pair_cut_off, TrackSums& sums) const {
  std::vector<const Track*> plus, minus;
  double lasting = 0;
  for (const Track& track : dead) {
    (track.charge > 0 ? plus : minus).push_back(&track);
    lasting += track.lasting ? 1 : 0;
  }
  const auto pairs = closest_first(plus.size(), minus.size(), [&](std::size_t i, std::size_t j) {
    if (plus[i]->charge != -minus[j]->charge) return kFar;
    const double d = shortest(plus[i]->trail.back().position - minus[j]->trail.back().position).norm();
    return d <= pair_cut_off ? d : kFar;
  });
  const auto n_pairs = static_cast<double>(pairs.size());
  const auto n_dead = static_cast<double>(dead.size());
  const auto n_lasting_pairs = static_cast<double>(std::count_if(pairs.begin(), pairs.end(), [&](const auto& pair) {
    return plus[pair.first]->lasting && minus[pair.second]->lasting;
  }));
  sums.all.annihilations += n_pairs;
  sums.all.deaths += n_dead;
  sums.all.deaths_alone += n_dead - 2 * n_pairs;
  sums.lasting.annihilations += n_lasting_pairs;
  sums.lasting.deaths += lasting;
  sums.lasting.deaths_alone += lasting - 2 * n_lasting_pairs;
}

void DefectTracks::pair_births(std::vector<std::size_t> born, double pair_cut_off, TrackSums& sums) {
  const auto middle =
      std::stable_partition(born.begin(), born.end(), [&](std::size_t i) { return tracks_[i].charge > 0; });
  const std::vector<std::size_t> plus(born.begin(), middle), minus(middle, born.end());
  const auto pairs = closest_first(plus.size(), minus.size(), [&](std::size_t i, std::size_t j) {
    const Track& a = tracks_[plus[i]];
    const Track& b = tracks_[minus[j]];
    if (a.charge != -b.charge) return kFar;
    const double d = shortest(a.trail.back().position - b.trail.back().position).norm();
    return d <= pair_cut_off ? d : kFar;
  });
  for (const auto& [i, j] : pairs) {
    tracks_[plus[i]].partner = tracks_[minus[j]].id;
    tracks_[minus[j]].partner = tracks_[plus[i]].id;
  }
  const auto n_pairs = static_cast<double>(pairs.size());
  sums.all.creations += n_pairs;
  sums.all.births_alone += static_cast<double>(born.size()) - 2 * n_pairs;
}

/// Tracks that have reached the age count as lasting, with what they did before. Partners were born together and so
/// reach it together, if both do.
void DefectTracks::let_last(double time, TrackSums& sums) {
  std::vector<const Track*> now;
  for (Track& track : tracks_) {
    if (track.lasting || time - track.born < settings_.min_lifetime - 1e-6 * settings_.interval) continue;
    track.lasting = true;
    sums.lasting.merge(track.pending);
    track.pending = {};
    if (track.birth_seen) now.push_back(&track);
  }
  for (const Track* track : now) {
    const bool together = track->partner >= 0 && std::any_of(now.begin(), now.end(), [&](const Track* other) {
                            return other->id == track->partner;
                          });
    if (!together) sums.lasting.births_alone += 1;
    if (together && track->charge > 0) sums.lasting.creations += 1;
  }
}

void DefectTracks::accumulate(double time, std::span<const Defect> defects) {
  SHAKEN_CHECK(time > last_time_, "samples must come in order of time");
  const bool first = !std::isfinite(last_time_);
  const double interval = first ? 0 : time - last_time_;
  TrackSums sums;
  sums.samples = 1;
  sums.duration = interval;

  const double plus_cut_off = cut_off(0.5, defects), minus_cut_off = cut_off(-0.5, defects);
  const auto links = closest_first(tracks_.size(), defects.size(), [&](std::size_t i, std::size_t j) {
    if (tracks_[i].charge != defects[j].charge) return kFar;
    const double d = shortest(tracks_[i].trail.back().position - defects[j].position).norm();
    return d <= (defects[j].charge > 0 ? plus_cut_off : minus_cut_off) ? d : kFar;
  });
  constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();
  std::vector<std::size_t> from(defects.size(), kNone);
  std::vector<bool> goes_on(tracks_.size());
  for (const auto& [i, j] : links) {
    from[j] = i;
    goes_on[i] = true;
  }

  std::vector<Track> dead;
  for (std::size_t i = 0; i < tracks_.size(); ++i) {
    if (!goes_on[i]) dead.push_back(std::move(tracks_[i]));
  }
  end(dead, plus_cut_off + minus_cut_off, sums);
  std::vector<Track> alive;
  std::vector<std::size_t> born;
  for (std::size_t j = 0; j < defects.size(); ++j) {
    if (from[j] != kNone) {
      alive.push_back(std::move(tracks_[from[j]]));
      extend(alive.back(), time, defects[j], sums);
    } else {
      alive.push_back(begin(time, defects[j]));
      alive.back().birth_seen = !first;
      if (!first) born.push_back(j);
    }
    Track& track = alive.back();
    sums.charge += track.charge;
    sums.all.lived += interval;
    (track.lasting ? sums.lasting : track.pending).lived += interval;
  }
  tracks_ = std::move(alive);
  pair_births(std::move(born), plus_cut_off + minus_cut_off, sums);
  let_last(time, sums);
  blocks_.accumulate(time, sums);
  last_time_ = time;
}

std::vector<std::int64_t> DefectTracks::ids() const {
  std::vector<std::int64_t> ids;
  for (const Track& track : tracks_) ids.push_back(track.id);
  return ids;
}

std::vector<double> DefectTracks::numbers(const TrackSums& sums) const {
  std::vector<double> result{sums.charge / sums.samples};
  const double room = sums.duration * settings_.area;
  for (const TrackSums::Tracks* tracks : {&sums.all, &sums.lasting}) {
    result.insert(result.end(),
                  {tracks->lived / room, tracks->creations / room, tracks->annihilations / room,
                   tracks->births_alone / room, tracks->deaths_alone / room, mean_of(tracks->lived, tracks->deaths)});
    for (std::size_t k = 0; k < kTrackSpans.size(); ++k) {
      const TrackSums::Speeds& plus = tracks->plus[k];
      const TrackSums::Speeds& minus = tracks->minus[k];
      result.insert(result.end(),
                    {plus.speed / plus.n, minus.speed / minus.n, plus.along / plus.n, plus.across / plus.n});
    }
  }
  return result;
}

TrackSummary DefectTracks::reduce(double t_steady) const {
  const std::vector<Estimate> estimates = jackknife(blocks_.empty(), blocks_.parts_after(t_steady, kMostParts),
                                                    [this](const TrackSums& sums) { return numbers(sums); });
  auto next = estimates.begin();
  TrackSummary summary;
  for (const int span : kTrackSpans) summary.span.push_back(span * settings_.interval);
  summary.charge = *next++;
  for (TrackSummary::Tracks* tracks : {&summary.all, &summary.lasting}) {
    for (Estimate* estimate : {&tracks->density, &tracks->creation_rate, &tracks->annihilation_rate,
                               &tracks->lone_birth_rate, &tracks->lone_death_rate, &tracks->lifetime}) {
      *estimate = *next++;
    }
    for (std::size_t k = 0; k < kTrackSpans.size(); ++k) {
      for (std::vector<Estimate>* column :
           {&tracks->speed_plus, &tracks->speed_minus, &tracks->along, &tracks->across}) {
        column->push_back(*next++);
      }
    }
  }
  return summary;
}

}  // namespace shaken::analysis
