#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "analysis/defects.h"
#include "analysis/errors/blocked.h"
#include "analysis/errors/jackknife.h"
#include "analysis/errors/summed.h"
#include "base/core/types.h"

namespace shaken::analysis {

/// Displacements of tracks are taken over so many samples.
inline constexpr std::array<int, 5> kTrackSpans{1, 2, 4, 8, 16};
/// The span whose speeds are a run's: index in kTrackSpans. Four samples.
inline constexpr std::size_t kTrackSpan = 2;

/// Sums over the tracks in a stretch of time; nothing but doubles.
struct TrackSums : Summed<TrackSums> {
  struct Speeds {
    double n = 0;                             // displacements
    double speed = 0, along = 0, across = 0;  // sums [mm/s]
    static auto fields(auto& self) { return listed(self.n, self.speed, self.along, self.across); }
  };
  struct Tracks : Summed<Tracks> {
    double creations = 0, annihilations = 0;        // pairs
    double births_alone = 0, deaths_alone = 0;      // defects without a partner
    double deaths = 0;                              // defects, with or without
    double lived = 0;                               // by all defects together [s]
    std::array<Speeds, kTrackSpans.size()> plus{};  // by span
    std::array<Speeds, kTrackSpans.size()> minus{};
    static auto fields(auto& self) {
      return listed(self.creations, self.annihilations, self.births_alone, self.deaths_alone, self.deaths, self.lived,
                    self.plus, self.minus);
    }
  };
  double samples = 0;
  double duration = 0;  // [s]
  double charge = 0;    // sum over all defects of all samples
  Tracks all, lasting;

  void accumulate(const TrackSums& other) { merge(other); }
  static auto fields(auto& self) {
    return listed(Setting{"number of sums", sizeof(TrackSums) / sizeof(double)}, self.samples, self.duration,
                  self.charge, self.all, self.lasting);
  }
};

/// What the tracks come down to.
struct TrackSummary {
  struct Tracks {
    Estimate density;                           ///< defects of both signs [1/mm^2]
    Estimate creation_rate, annihilation_rate;  ///< pairs [1/(mm^2 s)]
    Estimate lone_birth_rate, lone_death_rate;  ///< defects that came or went without a partner [1/(mm^2 s)]
    Estimate lifetime;                          ///< [s]
    /// By span [mm/s]. `along`: mean of v . p, p being the ray along which the director of a +1/2 is radial
    /// (Defect::direction), that is, towards the tail of its comet; a comet that runs head first has a negative one.
    /// `across`: along p turned by +90 degrees; zero but for chirality.
    std::vector<Estimate> speed_plus, speed_minus, along, across;
  };
  std::vector<double> span;  ///< [s]
  Estimate charge;           ///< mean total charge; zero in a periodic box that is full of rods
  Tracks all;                ///< every defect found
  Tracks lasting;            ///< of tracks at least the minimal lifetime long
};

/// Tracks of the defects in successive samples, of a periodic square box or of an arena within walls.
///
/// Linking: a defect goes on as the nearest one of the same charge in the next sample, the closest pairs of all first,
/// none further apart than the cut-off: half the mean spacing of that charge, sqrt(area / n) / 2, and at most
/// `max_step`. Where steps are small against the spacing that is the best assignment of all. What is left over are
/// births and deaths; of these, those of opposite charge closest together are one creation or annihilation, up to the
/// sum of the two cut-offs apart (either may have gone one cut-off since or before they met). The rest came or went
/// alone, which topology forbids in a periodic box that is full of rods: they are jumps beyond the cut-off, and
/// counted. Walls and voids let defects come and go alone.
///
/// Noise makes pairs a mesh apart that vanish again within a sample or two. So everything is told twice: of all
/// tracks, and of the lasting ones, seen for at least `min_lifetime`. These are counted with all of their life, from
/// the moment that they reach that age on. A lasting defect that goes together with one that was not has died alone.
///
/// Speeds are displacements over 1, 2, 4, 8, 16 samples of one track, divided by the time. Positions jitter, by sigma
/// per axis, so that the mean square speed over k samples is v^2 + 4 sigma^2 / (k interval)^2: where the speed falls
/// with the span it is jitter. The mean of v . p is free of it, p being the mean direction over the span, if jitter of
/// place and of direction go together alike forwards and backwards in time. Over long spans a path that bends makes
/// speeds fall for good reason.
///
/// Lifetime: the time lived by all defects over the number of deaths (Little's law), which holds in a steady state
/// and counts tracks that are cut off by the ends of the run for what they tell. A defect seen in one sample lived one
/// interval.
///
/// Memory: the defects alive, with their last 17 places each, and sums in 64 blocks.
class DefectTracks : public Saved<DefectTracks> {
 public:
  struct Settings {
    Vec2 period;          ///< distances are those to the nearest image; 0: plain ones, where walls stand [mm]
    double area;          ///< of the arena [mm^2]
    double interval;      ///< between samples [s]
    double max_step;      ///< [mm]
    double min_lifetime;  ///< [s]
  };
  explicit DefectTracks(const Settings& settings);

  /// Takes the defects found at `time` [s], later than all before. Defects not at a finite place must not be there.
  void accumulate(double time, std::span<const Defect> defects);
  /// The track of each defect of the last sample (n_defects), numbered from 0 in the order of their beginning.
  std::vector<std::int64_t> ids() const;
  /// Tracks so far.
  std::int64_t n_tracks() const { return next_id_; }

  /// From `t_steady` [s] on, errors from the stretches of time.
  TrackSummary reduce(double t_steady) const;

  static constexpr const char* kName = "DefectTracks";
  static auto fields(auto& self) {
    return listed(self.next_id_, self.last_time_, Length{self.tracks_}, self.tracks_, self.blocks_);
  }
  bool is_sound() const {
    return std::ranges::all_of(tracks_, [&](const Track& track) {
      return track.id < next_id_ && track.partner < next_id_ && !track.trail.empty();
    });
  }

 private:
  struct Place {
    double time = 0;
    Vec2 position = Vec2::Zero();  // without the jumps at the border of a periodic box
    Vec2 ray = Vec2::Zero();       // unit vector of the direction
    static auto fields(auto& self) { return listed(self.time, self.position, self.ray); }
  };
  struct Track {
    std::int64_t id;
    double charge;
    double born;           // time of the first sample
    bool birth_seen;       // not there from the first sample of all on
    std::int64_t partner;  // of its creation, or -1
    bool lasting;
    std::vector<Place> trail;   // the last samples, latest at the end
    TrackSums::Tracks pending;  // its own sums until it is lasting
    static auto fields(auto& self) {
      return listed(
          self.id, self.charge, self.born, self.birth_seen, IndexOrNone{self.partner}, self.lasting,
          Length{self.trail, Place(), 5}, self.trail,
          Unless{self.lasting, listed(Setting{"number of sums", sizeof(self.pending) / sizeof(double)}, self.pending)});
    }
  };
  Track begin(double time, const Defect& defect);
  void extend(Track& track, double time, const Defect& defect, TrackSums& sums) const;
  void end(const std::vector<Track>& dead, double pair_cut_off, TrackSums& sums) const;
  void pair_births(std::vector<std::size_t> born, double pair_cut_off, TrackSums& sums);
  void let_last(double time, TrackSums& sums);
  double cut_off(double charge, std::span<const Defect> defects) const;
  Vec2 shortest(const Vec2& difference) const;
  std::vector<double> numbers(const TrackSums& sums) const;

  Settings settings_;
  std::vector<Track> tracks_;  // alive, in the order of the last sample's defects
  std::int64_t next_id_ = 0;
  double last_time_ = -std::numeric_limits<double>::infinity();
  Blocked<TrackSums> blocks_{TrackSums{}};
};

}  // namespace shaken::analysis
