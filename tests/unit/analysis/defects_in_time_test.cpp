#include <gtest/gtest.h>

#include <algorithm>

#include "analysis/defect_series.h"
#include "analysis/defect_tracks.h"
#include "tests/unit/analysis/analysis_samples.h"

namespace shaken::analysis {
namespace defects_in_time_test {

constexpr double kBox = 40, kArea = kBox * kBox, kInterval = 0.1;

DefectTracks tracking(double min_lifetime = 0.45) {
  return DefectTracks({{kBox, kBox}, kArea, kInterval, 3.0, min_lifetime});
}

Defect at(double x, double y, double charge, double direction = 0) {
  return {{x - kBox * std::floor(x / kBox), y - kBox * std::floor(y / kBox)}, charge, direction};
}

/// A rate of `tracks` as the number of events in `samples` samples.
double events(const Estimate& rate, int samples) { return rate.value * kArea * kInterval * (samples - 1); }

// A comet running head first at 5 mm/s, 100 mm far through the borders, and turning meanwhile not at all; a -1/2 that
// runs the other way.
TEST(DefectTracks, FollowsThroughTheBorders) {
  constexpr int kSamples = 201;
  DefectTracks tracks = tracking();
  const double direction = std::atan2(-3.0, -4.0);  // the tail: against the velocity (4, 3)
  for (int i = 0; i < kSamples; ++i) {
    const double t = kInterval * i;
    tracks.accumulate(t, std::vector{at(4 * t + 1, 3 * t + 2, 0.5, direction), at(-2 * t + 30, 30, -0.5, 0.3)});
    EXPECT_EQ(tracks.ids(), (std::vector<std::int64_t>{0, 1}));
  }
  const TrackSummary summary = tracks.reduce(0);
  for (const TrackSummary::Tracks* of : {&summary.all, &summary.lasting}) {
    for (std::size_t k = 0; k < kTrackSpans.size(); ++k) {
      EXPECT_NEAR(of->speed_plus[k].value, 5, 1e-9);
      EXPECT_NEAR(of->speed_minus[k].value, 2, 1e-9);
      EXPECT_NEAR(of->along[k].value, -5, 1e-9);
      EXPECT_NEAR(of->across[k].value, 0, 1e-9);
      EXPECT_FALSE(of->along[k].sem > 1e-9) << "unknown, or that of rounding";
    }
    EXPECT_NEAR(of->density.value, 2 / kArea, 1e-12);
    EXPECT_EQ(of->creation_rate.value + of->annihilation_rate.value, 0);
    EXPECT_EQ(of->lone_birth_rate.value + of->lone_death_rate.value, 0);
    EXPECT_TRUE(std::isnan(of->lifetime.value));
  }
  EXPECT_EQ(summary.charge.value, 0);
  EXPECT_NEAR(summary.span[kTrackSpan], 0.4, 1e-12);
}

// Within walls nothing is near through the border: what was there goes alone, what comes on the other side does too,
// and those at opposite borders that vanish together are no pair.
TEST(DefectTracks, NothingGoesThroughWalls) {
  DefectTracks through = tracking();
  DefectTracks within({{0, 0}, kArea, kInterval, 3.0, 0.45});
  for (DefectTracks* tracks : {&through, &within}) {
    tracks->accumulate(0, std::vector{at(0.3, 20, 0.5), at(39.7, 5, 0.5), at(0.3, 5, -0.5)});
    tracks->accumulate(kInterval, std::vector{at(39.8, 20, 0.5)});
  }
  EXPECT_EQ(through.ids(), (std::vector<std::int64_t>{0}));
  EXPECT_NEAR(events(through.reduce(0).all.annihilation_rate, 2), 1, 1e-9);
  EXPECT_EQ(within.ids(), (std::vector<std::int64_t>{3}));
  EXPECT_EQ(within.reduce(0).all.annihilation_rate.value, 0);
  EXPECT_NEAR(events(within.reduce(0).all.lone_death_rate, 2), 3, 1e-9);
  EXPECT_NEAR(events(within.reduce(0).all.lone_birth_rate, 2), 1, 1e-9);
}

// Across: to the left of the tail's ray is positive.
TEST(DefectTracks, AcrossHasASign) {
  DefectTracks tracks = tracking();
  for (int i = 0; i < 40; ++i) tracks.accumulate(kInterval * i, std::vector{at(5, 5 + 0.2 * i, 0.5, 0.0)});
  EXPECT_NEAR(tracks.reduce(0).all.across[0].value, 2, 1e-9);
  EXPECT_NEAR(tracks.reduce(0).all.along[0].value, 0, 1e-9);
}

// A pair is made at the border of the box, seen for 20 samples while it moves apart and together again, and vanishes;
// another two stay. Each event once, charges in balance.
TEST(DefectTracks, CreationAndAnnihilation) {
  constexpr int kSamples = 60;
  DefectTracks tracks = tracking();
  for (int i = 0; i < kSamples; ++i) {
    std::vector<Defect> defects{at(10, 10, 0.5), at(25, 12, -0.5)};
    if (i >= 10 && i < 30) {
      const double half = 0.3 + 0.2 * std::min(i - 10, 29 - i);
      defects.insert(defects.begin(), at(-half, 20, -0.5));
      defects.push_back(at(half, 20, 0.5));
    }
    tracks.accumulate(kInterval * i, defects);
    if (i == 15) {
      EXPECT_EQ(tracks.ids(), (std::vector<std::int64_t>{2, 0, 1, 3}));
    }
  }
  EXPECT_EQ(tracks.n_tracks(), 4);
  const TrackSummary summary = tracks.reduce(0);
  for (const TrackSummary::Tracks* of : {&summary.all, &summary.lasting}) {
    EXPECT_NEAR(events(of->creation_rate, kSamples), 1, 1e-9);
    EXPECT_NEAR(events(of->annihilation_rate, kSamples), 1, 1e-9);
    EXPECT_NEAR(events(of->lone_birth_rate, kSamples) + events(of->lone_death_rate, kSamples), 0, 1e-9);
    // Two that live on and two deaths: 2 * 59 + 2 * 20 intervals of defects.
    EXPECT_NEAR(of->lifetime.value, 15.8 / 2, 1e-9);
    EXPECT_NEAR(of->density.value, 15.8 / 5.9 / kArea, 1e-12);
  }
  EXPECT_EQ(summary.charge.value, 0);
}

// Noise pairs of one or two samples are in the raw numbers and not in the lasting ones.
TEST(DefectTracks, FlickerDoesNotLast) {
  constexpr int kSamples = 300;
  DefectTracks tracks = tracking();
  Draw draw(111);
  for (int i = 0; i < kSamples; ++i) {
    std::vector<Defect> defects{at(10, 10 + 0.05 * i, 0.5), at(30, 10, -0.5)};
    if (i % 3 == 1) {
      const double x = draw.uniform(15, 25), y = draw.uniform(0, kBox);
      defects.push_back(at(x, y, 0.5));
      defects.push_back(at(x + 0.3, y, -0.5));
    }
    tracks.accumulate(kInterval * i, defects);
  }
  const TrackSummary summary = tracks.reduce(0);
  EXPECT_NEAR(events(summary.all.creation_rate, kSamples), 100, 1e-9);
  EXPECT_NEAR(events(summary.all.annihilation_rate, kSamples), 100, 1e-9);
  EXPECT_NEAR(summary.all.lifetime.value, (200 + 2 * 299) * kInterval / 200, 1e-9);
  EXPECT_EQ(summary.lasting.creation_rate.value, 0);
  EXPECT_EQ(summary.lasting.annihilation_rate.value, 0);
  EXPECT_EQ(summary.lasting.lone_birth_rate.value, 0);
  EXPECT_NEAR(summary.lasting.density.value, 2 / kArea, 1e-9);
  EXPECT_NEAR(summary.lasting.speed_plus[0].value, 0.5, 1e-9);
}

// A lasting +1/2 meets the -1/2 of a pair just made, whose +1/2 goes on: an exchange. Raw: one creation and one
// annihilation; of the lasting, one ended and one began without a lasting partner.
TEST(DefectTracks, AnExchangeIsNotHidden) {
  constexpr int kSamples = 40;
  DefectTracks tracks = tracking();
  for (int i = 0; i < kSamples; ++i) {
    std::vector<Defect> defects{at(30, 30, -0.5)};
    if (i < 20) defects.push_back(at(10, 10, 0.5));
    if (i == 18 || i == 19) defects.push_back(at(10.5, 10, -0.5));
    if (i >= 18) defects.push_back(at(14, 10, 0.5));
    tracks.accumulate(kInterval * i, defects);
  }
  const TrackSummary summary = tracks.reduce(0);
  EXPECT_NEAR(events(summary.all.creation_rate, kSamples), 1, 1e-9);
  EXPECT_NEAR(events(summary.all.annihilation_rate, kSamples), 1, 1e-9);
  EXPECT_NEAR(events(summary.all.lone_birth_rate, kSamples) + events(summary.all.lone_death_rate, kSamples), 0, 1e-9);
  EXPECT_NEAR(events(summary.lasting.lone_birth_rate, kSamples), 1, 1e-9);
  EXPECT_NEAR(events(summary.lasting.lone_death_rate, kSamples), 1, 1e-9);
  EXPECT_NEAR(events(summary.lasting.creation_rate, kSamples), 0, 1e-9);
}

// A jump beyond the cut-off is no motion: one ends, one begins, both alone.
TEST(DefectTracks, AJumpIsALoneDeathAndBirth) {
  constexpr int kSamples = 20;
  DefectTracks tracks = tracking();
  for (int i = 0; i < kSamples; ++i) {
    tracks.accumulate(kInterval * i, std::vector{at(i < 10 ? 5 : 8.1, 5, 0.5), at(20, 20, -0.5)});
  }
  const TrackSummary summary = tracks.reduce(0);
  EXPECT_NEAR(events(summary.all.lone_birth_rate, kSamples), 1, 1e-9);
  EXPECT_NEAR(events(summary.all.lone_death_rate, kSamples), 1, 1e-9);
  EXPECT_EQ(summary.all.creation_rate.value + summary.all.annihilation_rate.value, 0);
  EXPECT_EQ(summary.all.speed_plus[0].value, 0);
}

// Two +1/2 pass each other at 1 mm, in steps of 0.4 mm, in an order of the list that changes all the time. They keep
// who they are; -1/2 on the same line are no candidates.
TEST(DefectTracks, CrossingPathsKeepTheirTracks) {
  DefectTracks tracks = tracking();
  for (int i = 0; i < 60; ++i) {
    const double x = 0.4 * i;
    std::vector<Defect> defects{at(8 + x, 20, 0.5), at(32 - x, 21, 0.5), at(20, 20.5, -0.5)};
    std::vector<std::int64_t> ids{0, 1, 2};
    if (i % 2 == 1) {
      std::reverse(defects.begin(), defects.end());
      std::reverse(ids.begin(), ids.end());
    }
    tracks.accumulate(kInterval * i, defects);
    EXPECT_EQ(tracks.ids(), ids) << i;
  }
  EXPECT_NEAR(tracks.reduce(0).all.speed_plus[4].value, 4, 1e-9);
}

// The closest pair of all is linked first: a defect does not take its neighbour's successor for being looked at first.
TEST(DefectTracks, TheClosestPairFirst) {
  DefectTracks tracks = tracking();
  tracks.accumulate(0, std::vector{at(10, 10, 0.5), at(11, 10, 0.5)});
  tracks.accumulate(kInterval, std::vector{at(10.9, 10, 0.5), at(8.5, 10, 0.5)});
  EXPECT_EQ(tracks.ids(), (std::vector<std::int64_t>{1, 0}));
}

// Cores at rest that jitter by sigma per axis, below the cut-off: no track ends; the mean speed over k samples is that
// of a plane Gaussian, sqrt(pi) sigma / (k interval), and the mean along p is zero within its error.
TEST(DefectTracks, JitterIsSeenInTheSpans) {
  constexpr int kSamples = 4000;
  constexpr double kSigma = 0.2;
  DefectTracks tracks = tracking();
  Draw draw(112);
  for (int i = 0; i < kSamples; ++i) {
    const auto jitter = [&] { return kSigma * draw.normal(); };
    tracks.accumulate(kInterval * i, std::vector{at(jitter(), 20 + jitter(), 0.5, draw.uniform(-1, 1)),
                                                 at(20 + jitter(), 20 + jitter(), -0.5)});
  }
  EXPECT_EQ(tracks.n_tracks(), 2);
  const TrackSummary summary = tracks.reduce(0);
  for (std::size_t k = 0; k < kTrackSpans.size(); ++k) {
    const double want = std::sqrt(kPi) * kSigma / summary.span[k];
    EXPECT_NEAR(summary.all.speed_plus[k].value / want, 1, 0.04);
    EXPECT_NEAR(summary.lasting.speed_minus[k].value / want, 1, 0.04);
    EXPECT_LT(std::abs(summary.all.along[k].value), 5 * summary.all.along[k].sem + 1e-4);
    EXPECT_LT(summary.all.along[k].sem, 0.05 * want);
  }
}

// Any series of neutral samples: whatever the linking does, what began and what ended balance.
TEST(DefectTracks, BeginningsAndEndsBalance) {
  constexpr int kSamples = 200;
  Draw draw(113);
  DefectTracks tracks = tracking(0);  // all last
  std::vector<Defect> defects;
  std::int64_t first = 0;
  for (int i = 0; i < kSamples; ++i) {
    for (Defect& d : defects) d = at(d.position.x() + draw.normal(), d.position.y() + draw.normal(), d.charge);
    const auto pairs = static_cast<std::size_t>(draw.uniform(3, 9));
    while (defects.size() > 2 * pairs) defects.erase(defects.begin(), defects.begin() + 2);
    while (defects.size() < 2 * pairs) {
      for (const double charge : {0.5, -0.5})
        defects.push_back(at(draw.uniform(0, kBox), draw.uniform(0, kBox), charge));
    }
    tracks.accumulate(kInterval * i, defects);
    if (i == 0) first = tracks.n_tracks();
  }
  const TrackSummary summary = tracks.reduce(0);
  EXPECT_EQ(summary.charge.value, 0);
  const TrackSummary::Tracks& all = summary.all;
  const double births = 2 * events(all.creation_rate, kSamples) + events(all.lone_birth_rate, kSamples);
  const double deaths = 2 * events(all.annihilation_rate, kSamples) + events(all.lone_death_rate, kSamples);
  EXPECT_NEAR(births, static_cast<double>(tracks.n_tracks() - first), 1e-6);
  EXPECT_NEAR(births - deaths, static_cast<double>(defects.size()) - static_cast<double>(first), 1e-6);
  EXPECT_GT(deaths, 100);
  EXPECT_NEAR(all.creation_rate.value, summary.lasting.creation_rate.value, 1e-12);
  EXPECT_NEAR(all.lifetime.value, summary.lasting.lifetime.value, 1e-12);
}

// Only what happens in the steady state counts.
TEST(DefectTracks, FromTheSteadyStateOn) {
  DefectTracks tracks = tracking();
  for (int i = 0; i < 64; ++i) {
    std::vector<Defect> defects{at(5, 5 + (i < 32 ? 0.1 : 0.3) * i, 0.5), at(30, 30, -0.5)};
    if (i < 20) defects.insert(defects.end(), {at(20, 20, 0.5), at(21, 20, -0.5)});
    tracks.accumulate(kInterval * i, defects);
  }
  const TrackSummary summary = tracks.reduce(5.0);
  EXPECT_EQ(summary.all.annihilation_rate.value, 0);
  EXPECT_NEAR(summary.all.speed_plus[kTrackSpan].value, 3, 1e-9);
  EXPECT_NEAR(summary.all.density.value, 2 / kArea, 1e-12);
}

TEST(DefectTracks, NothingAndOddCharges) {
  DefectTracks tracks = tracking();
  EXPECT_TRUE(std::isnan(tracks.reduce(0).all.density.value));
  tracks.accumulate(0, {});
  tracks.accumulate(kInterval, {});
  EXPECT_EQ(tracks.reduce(0).all.density.value, 0);
  EXPECT_TRUE(std::isnan(tracks.reduce(0).all.speed_plus[0].value));
  // A +1 between two -1/2: born alone all three, of no speed of either kind; it does not go on as a +1/2.
  tracks.accumulate(2 * kInterval, std::vector{at(5, 5, 1.0), at(4, 5, -0.5), at(6, 5, -0.5)});
  tracks.accumulate(3 * kInterval, std::vector{at(5, 5, 1.0), at(4, 5, -0.5), at(6, 5, -0.5)});
  EXPECT_TRUE(std::isnan(tracks.reduce(0).all.speed_plus[0].value));
  EXPECT_NEAR(events(tracks.reduce(0).all.lone_birth_rate, 4), 3, 1e-9);
  tracks.accumulate(4 * kInterval, std::vector{at(5, 5, 0.5)});
  EXPECT_EQ(tracks.ids(), std::vector<std::int64_t>{3});
  EXPECT_THROW(tracks.accumulate(4 * kInterval, {}), std::logic_error);
}

const std::vector<Defect> kPair{{{1, 2}, 0.5, 0.3}, {{3, 4}, -0.5, -0.1}};
const std::vector<std::int64_t> kIds{0, 1};

TEST(DefectSeries, CountsAndLists) {
  DefectSeries series(true);
  series.accumulate(0.0, kPair, kIds);
  series.accumulate(0.1, {}, {});
  series.accumulate(0.2, std::vector<Defect>{kPair[0], kPair[1], kPair[1]}, std::vector<std::int64_t>{3, 2, 4});
  EXPECT_EQ(series.n_plus(), (std::vector<double>{1, 0, 1}));
  EXPECT_EQ(series.n_minus(), (std::vector<double>{1, 0, 2}));
  EXPECT_EQ(series.list().time, (std::vector<double>{0, 0, 0.2, 0.2, 0.2}));
  EXPECT_EQ(series.list().x, (std::vector<double>{1, 3, 1, 3, 3}));
  EXPECT_EQ(series.list().y, (std::vector<double>{2, 4, 2, 4, 4}));
  EXPECT_EQ(series.list().charge, (std::vector<double>{0.5, -0.5, 0.5, -0.5, -0.5}));
  EXPECT_EQ(series.list().direction, (std::vector<double>{0.3, -0.1, 0.3, -0.1, -0.1}));
  EXPECT_EQ(series.list().track, (std::vector<double>{0, 1, 3, 2, 4}));
  EXPECT_DOUBLE_EQ(series.reduce(0.1).n_plus, 0.5);
  EXPECT_DOUBLE_EQ(series.reduce(0.1).n_minus, 1.0);
  EXPECT_EQ(series.reduce(5.0).n_minus, 0.0);
  EXPECT_THROW(series.accumulate(0.2, {}, {}), std::logic_error);
}

TEST(DefectSeries, MemoryIsBoundedWithoutTheList) {
  DefectSeries series;
  for (int i = 0; i < 70000; ++i) series.accumulate(0.1 * i, kPair, kIds);
  EXPECT_LT(series.times().size(), 65536U);
  EXPECT_EQ(series.n_minus().back(), 1);
  EXPECT_TRUE(series.list().x.empty());
}

}  // namespace defects_in_time_test
}  // namespace shaken::analysis
