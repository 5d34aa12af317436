#include <gtest/gtest.h>

#include <algorithm>

#include "analysis/clusters.h"
#include "analysis/defects.h"
#include "analysis/flow_correlation.h"
#include "analysis/g2.h"
#include "analysis/lattice.h"
#include "analysis/number_fluctuations.h"
#include "analysis/pair_map.h"
#include "tests/unit/analysis/analysis_samples.h"

/// What is measured in a box that is not square, against the same in the square that copies of it tile.
namespace shaken::analysis {
namespace {

struct Tiled {
  Box box;
  std::vector<Vec3> places, axes;          ///< in the box
  std::vector<Vec3> all_places, all_axes;  ///< in the square
  double side;                             ///< of the square [mm]
};

/// Three boxes beside each other along x, or along y.
Tiled three_boxes(bool wide, std::size_t n_rods, std::uint64_t seed) {
  Draw draw(seed);
  Tiled tiled{wide ? Box(24, 8) : Box(8, 24), {}, {}, {}, {}, 24};
  tiled.places = random_places(draw, n_rods, tiled.box);
  tiled.axes = random_axes(draw, n_rods);
  for (int copy = 0; copy < 3; ++copy) {
    for (const Vec3& place : tiled.places)
      tiled.all_places.push_back(place + copy * Vec3(wide ? 0 : 8, wide ? 8 : 0, 0));
    tiled.all_axes.insert(tiled.all_axes.end(), tiled.axes.begin(), tiled.axes.end());
  }
  return tiled;
}

template <class Curve>
void expect_equal(const Curve& one, const Curve& other) {
  ASSERT_EQ(one.size(), other.size());
  for (std::size_t i = 0; i < one.size(); ++i) {
    EXPECT_EQ(std::isnan(one[i]), std::isnan(other[i])) << i;
    if (std::isnan(one[i])) continue;
    EXPECT_NEAR(one[i], other[i], 1e-9) << i;
  }
}

TEST(Rectangles, PairsAreThoseOfTheSquare) {
  for (const bool wide : {true, false}) {
    const Tiled rods = three_boxes(wide, 200, 301);
    OrientationCorrelation of_box(8, 4), of_square(8, 4);
    of_box.accumulate(rods.places, rods.axes, rods.box);
    of_square.accumulate(rods.all_places, rods.all_axes, rods.side);
    expect_equal(of_box.reduce().g2, of_square.reduce().g2);
    // a rod has n - 1 others in n / A: of copies a few more
    const double share = (199.0 / 200) / (599.0 / 600);
    for (std::size_t i = 0; i < 8; ++i) EXPECT_NEAR(of_box.reduce().g[i] * share, of_square.reduce().g[i], 1e-9);
    EXPECT_THROW(OrientationCorrelation(8, 4.1).accumulate(rods.places, rods.axes, rods.box), std::logic_error);

    PairMap map({9, 3.9, 1.0, rods.box}), square_map({9, 3.9, 1.0, rods.side});
    map.accumulate(rods.places, rods.axes);
    square_map.accumulate(rods.all_places, rods.all_axes);
    const std::vector<double> g2 = map.reduce().g2, square_g2 = square_map.reduce().g2;
    for (std::size_t i = 0; i < g2.size(); ++i) {  // the map of the box ends with its shorter side
      if (std::isnan(g2[i])) continue;
      EXPECT_NEAR(g2[i], square_g2[i], 1e-9);
    }
    EXPECT_FALSE(std::isnan(g2[40]));
    EXPECT_TRUE(std::isnan(g2[0]));
  }
}

// A gas whose director wavers about the shorter side of 10 x 60 mm: the cut across it is known to nearly half the
// longer side, and 1 all the way; the cut along it ends with the shorter one. Each expected number of pairs is that of
// the samples that reach as far.
TEST(Rectangles, CutsThroughPairsReachHalfOfEachSide) {
  const Box box(10, 60);
  PairMap map({20, 5, 1, box});
  Draw draw(307);
  for (int k = 0; k < 60; ++k) {
    std::vector<Vec3> places;
    for (int i = 0; i < 300; ++i) places.emplace_back(draw.uniform(0, 10), draw.uniform(0, 60), 0);
    map.accumulate(places, std::vector<Vec3>(300, axis(k % 2 == 0 ? 0.0 : 0.3)));
  }
  const PairCurves curves = map.reduce();
  ASSERT_EQ(curves.r.size(), 59u);  // of 0.5 mm, beyond 29.5 mm a corner of the strip is out
  for (std::size_t bin = 0; bin < curves.r.size(); ++bin) {
    const double far = curves.r[bin] + 0.25;
    // askew, the strip of 1 mm leaves the box where r sin 0.3 + 0.5 cos 0.3 is 5 mm, at 15.3 mm
    const double expected = 300 * 299 * (far < 15 ? 60.0 : 30.0) * 0.5 * 2 / 600;
    EXPECT_NEAR(curves.g_across[bin], 1, 4.5 * std::sqrt(2 / expected)) << far;
    EXPECT_NEAR(curves.g2_across[bin], 1, 1e-9) << far;
    EXPECT_EQ(std::isnan(curves.g_along[bin]), far > 5.01) << far;
  }
}

TEST(Rectangles, FlowIsThatOfTheSquare) {
  for (const bool wide : {true, false}) {
    const Tiled rods = three_boxes(wide, 200, 306);
    const auto in_plane = [](const std::vector<Vec3>& all) {
      std::vector<Vec2> flat;
      for (const Vec3& one : all) flat.emplace_back(one.head<2>());
      return flat;
    };
    FlowSums of_box(8, 4, 1), of_square(8, 4, 1);
    of_box.accumulate(in_plane(rods.places), in_plane(rods.axes), 0.3, rods.box);
    of_square.accumulate(in_plane(rods.all_places), in_plane(rods.all_axes), 0.3, rods.side);
    expect_equal(of_box.reduce().c, of_square.reduce().c);
    expect_equal(of_box.reduce().along, of_square.reduce().along);
  }
}

// Balls in a strip of many squares of the mesh, against all pairs.
TEST(Rectangles, ClustersAreThoseOfAllPairs) {
  Draw draw(307);
  for (const Box& box : {Box(40, 9), Box(9, 40), Box(3, 40)}) {
    const std::vector<Vec3> places = random_places(draw, 150, box), axes = random_axes(draw, 150);
    std::vector<std::size_t> cluster(150);
    for (std::size_t i = 0; i < 150; ++i) cluster[i] = i;
    for (std::size_t i = 0; i < 150; ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        if (Region(box).shortest((places[i] - places[j]).head<2>()).norm() >= 1.2) continue;
        const std::size_t from = cluster[i], to = cluster[j];
        for (std::size_t& one : cluster) one = one == from ? to : one;
      }
    }
    std::vector<std::size_t> sizes;
    for (std::size_t k = 0; k < 150; ++k) {
      if (const auto n = static_cast<std::size_t>(std::count(cluster.begin(), cluster.end(), k)); n > 0)
        sizes.push_back(n);
    }
    std::sort(sizes.rbegin(), sizes.rend());
    EXPECT_GT(sizes.front(), 3U);
    constexpr RodAxis kPoint[]{{}};
    EXPECT_EQ(cluster_sizes(places, axes, kPoint, box, {.distance = 1.2}), sizes);
  }
}

TEST(Rectangles, NeighboursAreThoseOfTheSquare) {
  for (const bool wide : {true, false}) {
    const Tiled rods = three_boxes(wide, 150, 302);
    LatticeOrder of_box({rods.box, 1.5, 1, 4}), of_square({rods.side, 1.5, 1, 4});
    of_box.accumulate(rods.places, rods.axes);
    of_square.accumulate(rods.all_places, rods.all_axes);
    EXPECT_NEAR(of_box.reduce().psi_6, of_square.reduce().psi_6, 1e-9);
    EXPECT_NEAR(of_box.reduce().psi_6_local, of_square.reduce().psi_6_local, 1e-9);
    // waves of the square that are none of the box have no power
    EXPECT_NEAR(of_box.reduce().bragg_peak, of_square.reduce().bragg_peak, 1e-9);
  }
}

TEST(Rectangles, DefectsAreThoseOfTheSquare) {
  for (const bool wide : {true, false}) {
    const Tiled rods = three_boxes(wide, 400, 303);
    const DirectorField of_box(rods.places, rods.axes, rods.box, Grid(rods.box, 0.5), 0.8);
    const DirectorField of_square(rods.all_places, rods.all_axes, rods.side, Grid(rods.side, 0.5), 0.8);
    EXPECT_EQ(of_box.grid().columns, wide ? 48 : 16);
    EXPECT_EQ(of_box.grid().rows, wide ? 16 : 48);
    for (int j = -3; j < 51; ++j) {
      for (int i = -3; i < 51; ++i) {
        EXPECT_NEAR(of_box.q_xx(i, j), of_square.q_xx(i, j), 1e-9);
        EXPECT_NEAR(of_box.q_xy(i, j), of_square.q_xy(i, j), 1e-9);
      }
    }
    const std::vector<Defect> defects = find_defects(of_box), all = find_defects(of_square);
    EXPECT_GT(defects.size(), 4U);
    EXPECT_EQ(3 * defects.size(), all.size());
    for (const Defect& defect : defects) {
      EXPECT_TRUE(std::any_of(all.begin(), all.end(), [&](const Defect& one) {
        return one.charge == defect.charge && (one.position - defect.position).norm() < 1e-6 &&
               std::abs(one.direction - defect.direction) < 1e-6;
      }));
    }
  }
}

// Meshes that are not as wide as high: a +1/2 defect that points along x, and the angle that its direction has.
TEST(Rectangles, DefectsOnAMeshThatIsNotSquare) {
  Draw draw(304);
  const Box box(20.3, 11.1);
  const std::vector<Vec3> places = random_places(draw, 20000, box);
  std::vector<Vec3> axes;
  const Vec2 plus(6, 5.5), minus(16, 5.5);
  for (const Vec3& place : places) {
    const Vec2 a = place.head<2>() - plus, b = place.head<2>() - minus;
    axes.push_back(axis(0.5 * std::atan2(a.y(), a.x()) - 0.5 * std::atan2(b.y(), b.x())));
  }
  const DirectorField field(places, axes, box, Grid(box, 0.7), 0.6);
  EXPECT_NE(field.mesh().x(), field.mesh().y());
  int found = 0;
  for (const Defect& defect : find_defects(field)) {
    for (const auto& [place, charge] : {std::pair(plus, 0.5), {minus, -0.5}}) {
      if ((defect.position - place).norm() > 0.5) continue;
      ++found;
      EXPECT_EQ(defect.charge, charge);
    }
  }
  EXPECT_EQ(found, 2);
}

// Counts do not know how long the sides are.
TEST(Rectangles, NumbersFluctuateAsInTheSquare) {
  Draw draw(305);
  Blocked<NumberFluctuations> of_square(NumberFluctuations(40, 1600, 0)), of_box(NumberFluctuations({80, 10}, 800, 0));
  for (int t = 0; t < 20; ++t) {
    std::vector<Vec3> places = random_places(draw, 500, 40);
    of_square.accumulate(t, places);
    for (Vec3& place : places) place = {2 * place.x(), place.y() / 4, 0};
    of_box.accumulate(t, places);
  }
  const NumberFluctuationCurve square = NumberFluctuations::reduce(of_square, 0),
                               box = NumberFluctuations::reduce(of_box, 0);
  ASSERT_EQ(square.mean_n.size(), box.mean_n.size());
  for (std::size_t k = 0; k < box.mean_n.size(); ++k) {
    EXPECT_NEAR(box.area_fraction[k], square.area_fraction[k], 1e-12);
    EXPECT_EQ(box.std_n[k].value, square.std_n[k].value);
  }
  // exponents are fitted to boxes whose shorter side is long enough
  const NumberFluctuations narrow({80, 10}, 800, 3);
  Blocked<NumberFluctuations> counts(narrow);
  for (int t = 0; t < 20; ++t) counts.accumulate(t, random_places(draw, 500, Box(80, 10)));
  EXPECT_EQ(NumberFluctuations::reduce(counts, 0).fitted, 2U);  // of a half and a third of 10 mm
}

}  // namespace
}  // namespace shaken::analysis
