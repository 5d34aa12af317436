#include "run/measure/measure_defects.h"

#include "analysis/geometry/director_field.h"
#include "run/measure/rows.h"

namespace shaken::run {
namespace {

using analysis::DefectList;
using analysis::DefectSeries;
using analysis::TrackSummary;
using Tracks = TrackSummary::Tracks;

/// Samples over which speeds are those of numbers.
constexpr int kSpan = analysis::kTrackSpans[analysis::kTrackSpan];

analysis::DefectTracks::Settings track_settings(const MeasureContext& context) {
  const System& system = context.plan.system;
  const analysis::Region region(system.box(), system.walls);
  return {region.period(), region.area(), context.interval, system.rod.length, context.plan.defects->min_lifetime};
}

template <auto kSpeeds>
Estimate at_span(const Tracks& tracks) {
  return (tracks.*kSpeeds)[analysis::kTrackSpan];
}

constexpr std::array kDefectCounts{
    from<&DefectSeries::times>(called("time", "t", {"time_s", "times of the samples"})),
    from<&DefectSeries::n_plus>(
        called("number of +1/2 defects", "N_+", {"n_plus", "number of defects of charge +1/2"})),
    from<&DefectSeries::n_minus>(
        called("number of −1/2 defects", "N_-", {"n_minus", "number of defects of charge -1/2"})),
};
constexpr std::array kDefectSpans{
    from<&TrackSummary::span>({"tracks/span_s", "time over which a speed is measured"}),
};
constexpr std::array kDefectAll{
    from<&Tracks::speed_plus>({"tracks/speed_plus_mm_s", "mean speed of +1/2 defects"}),
    from<&Tracks::speed_minus>({"tracks/speed_minus_mm_s", "mean speed of -1/2 defects"}),
    from<&Tracks::along>({"tracks/speed_plus_along_mm_s", "velocity of +1/2 defects along their tail, see above"}),
    from<&Tracks::across>({"tracks/speed_plus_across_mm_s", "velocity across the tail, to the left"}),
};
constexpr std::array kDefectLasting{
    from<&Tracks::speed_plus>(
        {"tracks/lasting/speed_plus_mm_s", "the same of tracks that last `measure.defects.min_lifetime`"}),
    from<&Tracks::speed_minus>({"tracks/lasting/speed_minus_mm_s", "the same of lasting tracks"}),
    from<&Tracks::along>({"tracks/lasting/speed_plus_along_mm_s", "the same of lasting tracks"}),
    from<&Tracks::across>({"tracks/lasting/speed_plus_across_mm_s", "the same of lasting tracks"}),
};
constexpr std::array kDefectList{
    from<&DefectList::time>(
        {"list/time_s", "when it was found: one entry for every defect; with `measure.defects.list`"}),
    from<&DefectList::x>({"list/x_mm", "its place"}),
    from<&DefectList::y>({"list/y_mm", "its place"}),
    from<&DefectList::charge>({"list/charge", "+1/2 or -1/2"}),
    from<&DefectList::direction>({"list/direction_rad", "of the ray on which the director is radial"}),
    from<&DefectList::track>({"list/track", "number of its track"}),
};
constexpr std::array kDefectNumbersOfAll{
    from<&Tracks::density>(
        called("defects per area", "", {"defect_density_per_mm2", "number per area, of both signs"})),
    from<&Tracks::creation_rate>({"defect_creation_rate_per_mm2_s", "pairs that appear, per area and time"}),
    from<&Tracks::annihilation_rate>({"defect_annihilation_rate_per_mm2_s", "pairs that vanish"}),
    from<&Tracks::lone_birth_rate>({"defect_lone_birth_rate_per_mm2_s", "defects that appear without a partner"}),
    from<&Tracks::lone_death_rate>({"defect_lone_death_rate_per_mm2_s", "defects that vanish without a partner"}),
    from<&Tracks::lifetime>({"defect_lifetime_s", "time lived by all defects over the number that vanished"}),
    from<at_span<&Tracks::speed_plus>>(over("every", {"defect_speed_plus_mm_s", "mean speed of +1/2 defects"}, kSpan)),
    from<at_span<&Tracks::speed_minus>>(
        over("every", {"defect_speed_minus_mm_s", "mean speed of -1/2 defects"}, kSpan)),
    from<at_span<&Tracks::along>>(
        over("every", {"defect_speed_plus_along_mm_s", "velocity of +1/2 defects along their tail"}, kSpan)),
    from<at_span<&Tracks::across>>(
        over("every", {"defect_speed_plus_across_mm_s", "velocity across the tail, to the left"}, kSpan)),
};
constexpr std::array kDefectNumbersOfLasting{
    from<&Tracks::density>(
        {"lasting_defect_density_per_mm2", "number per area, of tracks that last `measure.defects.min_lifetime`"}),
    from<&Tracks::creation_rate>({"lasting_defect_creation_rate_per_mm2_s", "the same of lasting tracks"}),
    from<&Tracks::annihilation_rate>({"lasting_defect_annihilation_rate_per_mm2_s", "the same of lasting tracks"}),
    from<&Tracks::lone_birth_rate>({"lasting_defect_lone_birth_rate_per_mm2_s", "the same of lasting tracks"}),
    from<&Tracks::lone_death_rate>({"lasting_defect_lone_death_rate_per_mm2_s", "the same of lasting tracks"}),
    from<&Tracks::lifetime>({"lasting_defect_lifetime_s", "the same of lasting tracks"}),
    from<at_span<&Tracks::speed_plus>>(
        over("every", {"lasting_defect_speed_plus_mm_s", "the same of lasting tracks"}, kSpan)),
    from<at_span<&Tracks::speed_minus>>(
        over("every", {"lasting_defect_speed_minus_mm_s", "the same of lasting tracks"}, kSpan)),
    from<at_span<&Tracks::along>>(
        over("every", {"lasting_defect_speed_plus_along_mm_s", "the same of lasting tracks"}, kSpan)),
    from<at_span<&Tracks::across>>(
        over("every", {"lasting_defect_speed_plus_across_mm_s", "the same of lasting tracks"}, kSpan)),
};
constexpr std::array kDefectCharge{
    from<&TrackSummary::charge>({"defect_charge", "mean total charge; 0 in a periodic box that is full of rods"}),
};

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
  put(result, "/defects/", kDefectCounts, series_);
  const TrackSummary tracks = tracks_.reduce(result.t_steady);
  put(result, "/defects/", kDefectSpans, tracks);
  put(result, "/defects/", kDefectAll, tracks.all);
  put(result, "/defects/", kDefectLasting, tracks.lasting);
  put(result, "", kDefectNumbersOfAll, tracks.all);
  put(result, "", kDefectNumbersOfLasting, tracks.lasting);
  put(result, "", kDefectCharge, tracks);
  if (series_.keeps_list()) put(result, "/defects/", kDefectList, series_.list());
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
      .arrays = outputs_of(kDefectCounts, kDefectSpans, kDefectAll, kDefectLasting, kDefectList),
      .axes = {{"tracks/lasting/", "tracks/span_s"}, {"list/", ""}},
      .numbers = outputs_of(kDefectNumbersOfAll, kDefectNumbersOfLasting, kDefectCharge),
  };
}

}  // namespace shaken::run
