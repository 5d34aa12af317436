#include "run/measure/measure_defects.h"

#include <string>

#include "analysis/geometry/director_field.h"
#include "run/measure/estimates.h"
#include "run/measure/measurement_kinds.h"

namespace shaken::run {

namespace {

/// Samples over which speeds are those of numbers.
constexpr int kSpan = analysis::kTrackSpans[analysis::kTrackSpan];

analysis::DefectTracks::Settings track_settings(const MeasureContext& context) {
  const System& system = context.plan.system;
  const analysis::Region region(system.box(), system.walls);
  return {region.period(), region.area(), context.interval, system.rod.length, context.plan.defects->min_lifetime};
}

void put_tracks(const analysis::TrackSummary::Tracks& tracks, const std::string& folder, const std::string& prefix,
                Reduction& result) {
  put(result, folder + "speed_plus", "_mm_s", tracks.speed_plus);
  put(result, folder + "speed_minus", "_mm_s", tracks.speed_minus);
  put(result, folder + "speed_plus_along", "_mm_s", tracks.along);
  put(result, folder + "speed_plus_across", "_mm_s", tracks.across);
  const auto number = [&](const char* name, const analysis::Estimate& estimate) {
    result.scalars[prefix + name] = scalar(estimate);
  };
  number("density_per_mm2", tracks.density);
  number("creation_rate_per_mm2_s", tracks.creation_rate);
  number("annihilation_rate_per_mm2_s", tracks.annihilation_rate);
  number("lone_birth_rate_per_mm2_s", tracks.lone_birth_rate);
  number("lone_death_rate_per_mm2_s", tracks.lone_death_rate);
  number("lifetime_s", tracks.lifetime);
  number("speed_plus_mm_s", tracks.speed_plus[analysis::kTrackSpan]);
  number("speed_minus_mm_s", tracks.speed_minus[analysis::kTrackSpan]);
  number("speed_plus_along_mm_s", tracks.along[analysis::kTrackSpan]);
  number("speed_plus_across_mm_s", tracks.across[analysis::kTrackSpan]);
}

}  // namespace

std::vector<analysis::Defect> defects_of(const Sample& sample, const analysis::Region& region, double smoothing,
                                         double mesh) {
  return analysis::find_defects(analysis::DirectorField(sample->position, sample->director, region,
                                                        analysis::Grid(region.box(), mesh), smoothing));
}

MeasuredDefects::MeasuredDefects(const MeasureContext& context)
    : region_(context.plan.system.box(), context.plan.system.walls),
      smoothing_(context.plan.defects->smoothing_for(context.plan.system.rod.length)),
      mesh_(context.plan.defects->grid_for(context.plan.system.rod.length)),
      series_(context.plan.defects->list),
      tracks_(track_settings(context)) {}

void MeasuredDefects::sample(const Sample& sample) {
  last_ = DefectSample{sample->tick, sample->time, smoothing_, defects_of(sample, region_, smoothing_, mesh_)};
  tracks_.accumulate(sample->time, last_->defects);
  series_.accumulate(sample->time, last_->defects, tracks_.ids());
}

void MeasuredDefects::reduce(Reduction& result) const {
  result.defects = series_.reduce(result.t_steady);
  result.arrays["/defects/time_s"] = series_.times();
  result.arrays["/defects/n_plus"] = series_.n_plus();
  result.arrays["/defects/n_minus"] = series_.n_minus();
  const analysis::TrackSummary tracks = tracks_.reduce(result.t_steady);
  result.arrays["/defects/tracks/span_s"] = tracks.span;
  put_tracks(tracks.all, "/defects/tracks/", "defect_", result);
  put_tracks(tracks.lasting, "/defects/tracks/lasting/", "lasting_defect_", result);
  result.scalars["defect_charge"] = scalar(tracks.charge);
  if (!series_.keeps_list()) return;
  result.arrays["/defects/list/time_s"] = series_.list().time;
  result.arrays["/defects/list/x_mm"] = series_.list().x;
  result.arrays["/defects/list/y_mm"] = series_.list().y;
  result.arrays["/defects/list/charge"] = series_.list().charge;
  result.arrays["/defects/list/direction_rad"] = series_.list().direction;
  result.arrays["/defects/list/track"] = series_.list().track;
}

void MeasuredDefects::save(StateWriter& writer) const {
  series_.save(writer);
  tracks_.save(writer);
}

void MeasuredDefects::restore(StateReader& reader) {
  series_.restore(reader);
  tracks_.restore(reader);
}

MeasurementKind defects_kind() {
  return {
      .name = "defects",
      .sources = "defects, geometry/director_field, defect_series, defect_tracks",
      .make = [](const MeasureContext& context) -> std::unique_ptr<Measurement> {
        return std::make_unique<MeasuredDefects>(context);
      },
      .arrays =
          {
              called("time", "t", {"time_s", "times of the samples"}),
              called("number of +1/2 defects", "N_+", {"n_plus", "number of defects of charge +1/2"}),
              called("number of −1/2 defects", "N_-", {"n_minus", "number of defects of charge -1/2"}),
              {"tracks/span_s", "time over which a speed is measured"},
              {"tracks/speed_plus_mm_s", "mean speed of +1/2 defects", kWithError},
              {"tracks/speed_minus_mm_s", "mean speed of -1/2 defects", kWithError},
              {"tracks/speed_plus_along_mm_s", "velocity of +1/2 defects along their tail, see above", kWithError},
              {"tracks/speed_plus_across_mm_s", "velocity across the tail, to the left", kWithError},
              {"tracks/lasting/speed_plus_mm_s", "the same of tracks that last `measure.defects.min_lifetime`",
               kWithError},
              {"tracks/lasting/speed_minus_mm_s", "the same of lasting tracks", kWithError},
              {"tracks/lasting/speed_plus_along_mm_s", "the same of lasting tracks", kWithError},
              {"tracks/lasting/speed_plus_across_mm_s", "the same of lasting tracks", kWithError},
              {"list/time_s", "when it was found: one entry for every defect; with `measure.defects.list`"},
              {"list/x_mm", "its place"},
              {"list/y_mm", "its place"},
              {"list/charge", "+1/2 or -1/2"},
              {"list/direction_rad", "of the ray on which the director is radial"},
              {"list/track", "number of its track"},
          },
      .axes = {{"tracks/lasting/", "tracks/span_s"}, {"list/", ""}},
      .numbers =
          {
              called("defects per area", "", {"defect_density_per_mm2", "number per area, of both signs"}),
              {"defect_creation_rate_per_mm2_s", "pairs that appear, per area and time"},
              {"defect_annihilation_rate_per_mm2_s", "pairs that vanish"},
              {"defect_lone_birth_rate_per_mm2_s", "defects that appear without a partner"},
              {"defect_lone_death_rate_per_mm2_s", "defects that vanish without a partner"},
              {"defect_lifetime_s", "time lived by all defects over the number that vanished"},
              over("every", {"defect_speed_plus_mm_s", "mean speed of +1/2 defects"}, kSpan),
              over("every", {"defect_speed_minus_mm_s", "mean speed of -1/2 defects"}, kSpan),
              over("every", {"defect_speed_plus_along_mm_s", "velocity of +1/2 defects along their tail"}, kSpan),
              over("every", {"defect_speed_plus_across_mm_s", "velocity across the tail, to the left"}, kSpan),
              {"lasting_defect_density_per_mm2", "number per area, of tracks that last `measure.defects.min_lifetime`"},
              {"lasting_defect_creation_rate_per_mm2_s", "the same of lasting tracks"},
              {"lasting_defect_annihilation_rate_per_mm2_s", "the same of lasting tracks"},
              {"lasting_defect_lone_birth_rate_per_mm2_s", "the same of lasting tracks"},
              {"lasting_defect_lone_death_rate_per_mm2_s", "the same of lasting tracks"},
              {"lasting_defect_lifetime_s", "the same of lasting tracks"},
              over("every", {"lasting_defect_speed_plus_mm_s", "the same of lasting tracks"}, kSpan),
              over("every", {"lasting_defect_speed_minus_mm_s", "the same of lasting tracks"}, kSpan),
              over("every", {"lasting_defect_speed_plus_along_mm_s", "the same of lasting tracks"}, kSpan),
              over("every", {"lasting_defect_speed_plus_across_mm_s", "the same of lasting tracks"}, kSpan),
              {"defect_charge", "mean total charge; 0 in a periodic box that is full of rods"},
          },
  };
}

}  // namespace shaken::run
