#include "analysis/lattice.h"

#include <gtest/gtest.h>

#include "tests/unit/analysis/analysis_samples.h"
#include "tests/unit/analysis/lattices.h"

namespace shaken::analysis {
namespace {

LatticeMeans of(const LatticeOrder::Shape& shape, const std::vector<Vec3>& places, double director = 0.0) {
  LatticeOrder lattice(shape);
  lattice.accumulate(places, std::vector<Vec3>(places.size(), axis(director)));
  return lattice.reduce();
}

// Rows along y stretched along the director, x: 20 columns of spacing 1, 10 rows 2 apart. Undone by dividing lengths
// along x by 2 / (sqrt(3) / 2). As they are, the nearest six are two at 1 and two at 2 in the row, exp(6 i a) = -1, and
// four at sqrt(4.25), atan(1 / 4) off the x axis, which share two places.
TEST(LatticeOrder, OfAHexagonalLatticeIsOne) {
  constexpr double kBox = 20;
  const LatticeMeans means = of({kBox, 4 / std::sqrt(3.0), 0.5, 8}, hexagonal_lattice(20, 10, kBox));
  EXPECT_NEAR(means.psi_6, 1.0, 1e-6);
  EXPECT_NEAR(means.psi_6_local, 1.0, 1e-6);
  EXPECT_NEAR(means.bragg_peak, 1.0, 1e-9);
  EXPECT_NEAR(means.psi_6_raw, (4 - 2 * std::cos(6 * std::atan(0.25))) / 6, 1e-9);
  // 26 rows of 30: sqrt(3) / 2 but for 0.0006
  const LatticeMeans plain = of({30, 1.0, 0.5, 2}, hexagonal_lattice(26, 30, 30));
  EXPECT_NEAR(plain.psi_6_raw, 1.0, 1e-3);
  EXPECT_NEAR(plain.psi_6, 1.0, 1e-3);
}

// Of the four rods at sqrt(2), two share the sixth place: the bonds along the axes, 4, and those across, 2 x -1 in
// exp(6 i a) ... all cancel.
TEST(LatticeOrder, OfASquareLatticeIsZero) {
  const LatticeMeans means = of({20, 1.0, 0.5, 4}, square_lattice(20, 1.0), 0.3);
  EXPECT_NEAR(means.psi_6, 0.0, 1e-9);
  EXPECT_NEAR(means.psi_6_local, 0.0, 1e-9);
  EXPECT_NEAR(means.bragg_peak, 1.0, 1e-9);
  // in coordinates compressed along one axis it is as far from a hexagon
  EXPECT_NEAR(of({20, 0.5, 0.5, 4}, square_lattice(20, 1.0)).psi_6_raw, 0.0, 1e-9);
}

// The peak of a lattice that shakes: exp(-q^2 s^2) for a spread s each way (Debye and Waller), with q the shortest
// lattice vector; |q'| = sqrt(2) q is lower by as much again. Of 2304 rods in rows of 48, 768 are looked at: every
// third would be a lattice of columns 3 apart, whose peak, exp(-q^2 s^2 / 9), is higher.
TEST(LatticeOrder, RodsTakenMakeNoLatticeOfTheirOwn) {
  constexpr double kSpread = 0.12;
  Draw draw(174);
  LatticeOrder lattice({48, 1.0, 0.45, 4});
  for (int t = 0; t < 6; ++t) {
    std::vector<Vec3> places = square_lattice(48, 1.0);
    for (Vec3& place : places) place += kSpread * Vec3{draw.normal(), draw.normal(), 0};
    lattice.accumulate(places, std::vector<Vec3>(places.size(), axis(0)));
  }
  EXPECT_NEAR(lattice.reduce().bragg_peak, std::exp(-4 * kPi * kPi * kSpread * kSpread), 0.04);
}

// A gas: sums over random phases are exponential, the largest of K of them near (ln K + 0.577) / N; psi_6 a walk of N
// steps of 1 / sqrt(6) (neighbours of neighbours make it a little longer).
TEST(LatticeOrder, OfAGasIsTheFloor) {
  constexpr double kBox = 30, kRods = 900;
  Draw draw(172);
  LatticeOrder lattice({kBox, 1.0, 1.0, 6});
  for (int t = 0; t < 20; ++t) {
    const std::vector<Vec3> places = random_places(draw, static_cast<std::size_t>(kRods), kBox);
    lattice.accumulate(places, random_axes(draw, places.size()));
  }
  const LatticeMeans means = lattice.reduce();
  const double waves = kPi / 2 * 30 * 30;
  EXPECT_NEAR(means.bragg_peak * kRods, std::log(waves) + 0.577, 1.5);
  EXPECT_GT(means.psi_6, 0.2 / std::sqrt(6 * kRods));
  EXPECT_LT(means.psi_6, 4 / std::sqrt(6 * kRods));
  EXPECT_NEAR(means.psi_6_local, 0.37, 0.02);
}

TEST(LatticeOrder, OddInput) {
  const LatticeOrder::Shape shape{10, 2.0, 1.0, 6};
  EXPECT_THROW(LatticeOrder({10, 1.0, 6.0, 6}), std::logic_error);

  LatticeOrder odd(shape);
  odd.accumulate({}, {});
  EXPECT_TRUE(std::isnan(odd.reduce().psi_6));
  odd.accumulate(std::vector<Vec3>{{1, 1, 0}}, std::vector<Vec3>{{0, 0, 1}});
  EXPECT_TRUE(std::isnan(odd.reduce().psi_6)) << "without six neighbours";
  EXPECT_NEAR(odd.reduce().bragg_peak, 1.0, 1e-12);
  odd = LatticeOrder(shape);
  odd.accumulate(std::vector<Vec3>(8, Vec3(1, 1, 0)), std::vector<Vec3>(8, axis(0)));  // all in one place
  EXPECT_EQ(odd.reduce().psi_6_raw, 0.0);
}

}  // namespace
}  // namespace shaken::analysis
