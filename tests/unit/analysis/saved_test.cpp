#include "analysis/errors/saved.h"

#include <gtest/gtest.h>

#include <functional>
#include <type_traits>
#include <typeinfo>
#include <vector>

#include "analysis/angles.h"
#include "analysis/defect_maps.h"
#include "analysis/defect_series.h"
#include "analysis/defect_tracks.h"
#include "analysis/density_maps.h"
#include "analysis/director_fluctuations.h"
#include "analysis/errors/blocked.h"
#include "analysis/errors/bounded_series.h"
#include "analysis/flow_correlation.h"
#include "analysis/msd.h"
#include "analysis/pair_map.h"
#include "analysis/rod_traces.h"
#include "analysis/van_hove.h"
#include "analysis/velocity_correlation.h"
#include "tests/unit/analysis/analysis_samples.h"
#include "tests/unit/analysis/state_checks.h"

namespace shaken::analysis {
namespace {

/// Rods at one instant, and what else observables take.
struct Instant {
  double time;
  std::vector<Vec3> places, axes;
  std::vector<Defect> defects;
  double x;
};

template <class Accumulator>
using Accumulate = std::type_identity_t<std::function<void(Accumulator&, const Instant&)>>;

/// Stopped after each sample and restored into `empty`, it goes on as one that is not stopped; its state is refused
/// where it is cut off, and by `others`, of other settings. Two halves, merged, are as the whole.
template <class Accumulator>
void expect_saved(const Accumulator& empty, const std::type_identity_t<std::vector<Accumulator>>& others,
                  const Accumulate<Accumulator>& accumulate, int samples = 20, std::size_t n_rods = 6) {
  SCOPED_TRACE(typeid(Accumulator).name());
  Draw draw(17);
  Accumulator straight = empty, stopped = empty, halves[] = {empty, empty};
  constexpr bool kMerges = requires { halves[0].merge(empty); };
  if constexpr (requires { halves[1].start_at(0); }) halves[1].start_at(samples / 2);
  for (int i = 0; i < samples; ++i) {
    const Instant now{.time = static_cast<double>(i),
                      .places = random_places(draw, n_rods, 20),
                      .axes = random_axes(draw, n_rods),
                      .defects = {{{draw.uniform(0, 20), 5}, 0.5, draw.normal()}, {{9, draw.uniform(0, 20)}, -0.5, 1}},
                      .x = draw.uniform(0, 1)};
    accumulate(straight, now);
    accumulate(stopped, now);
    accumulate(halves[2 * i / samples], now);
    stop_and_go_on(stopped, empty);
  }
  const std::vector<std::byte> bytes = state(straight);
  EXPECT_EQ(state(stopped), bytes);
  EXPECT_NE(state(empty), bytes);
  expect_every_truncation_found(stopped);
  for (Accumulator other : others) {
    StateReader reader(bytes);
    EXPECT_THROW(other.restore(reader), StateError);
    if constexpr (kMerges) {
      EXPECT_THROW(other.merge(straight), std::logic_error);
    }
  }
  if constexpr (kMerges) {
    halves[0].merge(empty);
    halves[0].merge(halves[1]);
    expect_same_sums(state(halves[0]), bytes);
  }
}

// An observable for each way in which fields are listed (saved.h). What all of them save, runs that stop and go on show
// (tests/unit/run/measurements_test.cpp).
TEST(Saved, ObservablesOfEachInstantGoOnFromTheirState) {
  using A = const Instant&;
  expect_saved(
      DirectorFluctuations(20, 1), {DirectorFluctuations(1, 1)},
      [](auto& sums, A now) {
        const double theta = 2 * kPi * now.x;
        sums.accumulate(now.places,
                        std::vector{axis(theta), axis(theta), axis(theta), axis(theta), axis(theta), axis(1)});
      },
      4);
  const std::vector<std::byte> to_another_q = state(DirectorFluctuations(20, 2));
  DirectorFluctuations fluctuations(20, 1);
  StateReader reader(to_another_q);
  EXPECT_THROW(fluctuations.restore(reader), StateError);
  expect_saved(
      PairMap({9, 4, 0.8, 20}), {PairMap({9, 4.5, 0.8, 20}), PairMap({11, 4, 0.8, 20}), PairMap({9, 4, 0.8, 21})},
      [](auto& map, A now) { map.accumulate(now.places, now.axes); }, 4, 1100);
}

TEST(Saved, SeriesGoOnFromTheirState) {
  using A = const Instant&;
  const auto of_motion = [](auto& lags, A now) { lags.accumulate(now.time, now.places, now.x); };
  expect_saved(
      Blocked(AngleDistribution(3)), {}, [](auto& blocks, A now) { blocks.accumulate(now.time, now.axes); }, 150);
  expect_saved(
      BoundedSeries<1>(8), {BoundedSeries<1>(4)}, [](auto& series, A now) { series.accumulate(now.time, {now.x}); },
      31);
  expect_saved(
      DefectMaps({2, 10, 5}), {DefectMaps({3, 10, 5}), DefectMaps({2, 8, 5})},
      [](auto& maps, A now) { maps.accumulate(now.time, now.places, now.places, now.axes, now.defects, Region(20)); },
      6);
  for (const bool keeps_list : {true, false}) {
    expect_saved(DefectSeries(keeps_list), {DefectSeries(!keeps_list)}, [](auto& series, A now) {
      series.accumulate(now.time, now.defects, std::vector<std::int64_t>{0, 1});
    });
  }
  expect_saved(DefectTracks({{20, 20}, 400, 1, 3, 2}), {},
               [](auto& tracks, A now) { tracks.accumulate(now.time, now.defects); });
  const Region disc(Box(20), SideWalls{Arena::kDisc, 19});
  expect_saved(DensityMaps(disc, Grid(4), 1, 3), {DensityMaps(disc, Grid(5), 1, 3)},
               [](auto& maps, A now) { maps.accumulate(now.time, now.places); });
  expect_saved(FlowCorrelation(6, 10, 3),
               {FlowCorrelation(7, 10, 3), FlowCorrelation(6, 9, 3), FlowCorrelation(6, 10, 2)},
               [](auto& flow, A now) { flow.accumulate(now.time, now.places, now.places, now.x, Region(20)); });
  expect_saved(MeanSquareDisplacement(1, 6, 2), {MeanSquareDisplacement(2, 6, 2), MeanSquareDisplacement(1, 6, 3)},
               of_motion);
  expect_saved(RodTraces(3, 12), {RodTraces(4, 12), RodTraces(3, 11)},
               [](auto& traces, A now) { traces.accumulate(now.time, now.places, now.axes); });
  expect_saved(VanHove(1, 8, 5, 3), {VanHove(1, 16, 5, 3), VanHove(1, 8, 6, 3), VanHove(1, 8, 5, 2)}, of_motion);
  expect_saved(VelocityCorrelation(1, 2, 2), {VelocityCorrelation(1, 3, 2)}, of_motion);
}

}  // namespace
}  // namespace shaken::analysis
