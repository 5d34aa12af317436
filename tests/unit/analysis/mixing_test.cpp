#include "analysis/mixing.h"

#include <gtest/gtest.h>

#include <cmath>

#include "analysis/g2.h"
#include "sim/system.h"
#include "tests/unit/analysis/analysis_samples.h"

namespace shaken::analysis {
namespace {

std::vector<std::uint8_t> drawn_species(Draw& draw, std::size_t n, std::size_t n_species) {
  std::vector<std::uint8_t> species;
  for (std::size_t i = 0; i < n; ++i)
    species.push_back(static_cast<std::uint8_t>(draw.uniform(0, static_cast<double>(n_species))));
  return species;
}

std::vector<std::int64_t> counts_of(const std::vector<std::uint8_t>& species, std::size_t n_species) {
  std::vector<std::int64_t> counts(n_species);
  for (const std::uint8_t one : species) ++counts[one];
  return counts;
}

TEST(PairKind, CountsEachPairOnce) {
  std::vector<std::size_t> found;
  for (std::size_t a = 0; a < 3; ++a) {
    for (std::size_t b = a; b < 3; ++b) {
      found.push_back(PairMixing::pair_kind(3, a, b));
      EXPECT_EQ(PairMixing::pair_kind(3, b, a), found.back());
    }
  }
  EXPECT_EQ(found, (std::vector<std::size_t>{0, 1, 2, 3, 4, 5}));
}

// The slow twin: every ordered pair, its distance to nine images, and the area of its ring.
TEST(PairMixing, IsTheSumOverAllPairsOfAPeriodicBox) {
  Draw draw(4711);
  const Box box(20, 13);
  constexpr std::size_t kRods = 150, kSpecies = 3, kBins = 13;
  constexpr double kMax = 6.5, kNear = 2;
  const std::vector<Vec3> places = random_places(draw, kRods, box);
  const std::vector<std::uint8_t> species = drawn_species(draw, kRods, kSpecies);
  const auto counts = counts_of(species, kSpecies);
  PairMixing mixing(kSpecies, kBins, kMax, kNear);
  mixing.accumulate(places, species, box);
  const MixingCurves found = mixing.reduce();
  for (std::size_t a = 0; a < kSpecies; ++a) {
    for (std::size_t b = a; b < kSpecies; ++b) {
      std::vector<double> pairs(kBins);
      double like = 0, unlike = 0;
      for (std::size_t i = 0; i < kRods; ++i) {
        for (std::size_t j = 0; j < kRods; ++j) {
          const bool of_both = (species[i] == a || species[i] == b) && (species[j] == a || species[j] == b);
          if (i == j || !of_both) continue;
          double nearest = 1e9;
          for (int x = -1; x <= 1; ++x) {
            for (int y = -1; y <= 1; ++y)
              nearest = std::min(nearest, (places[i] - places[j] + Vec3(x * box.x(), y * box.y(), 0)).norm());
          }
          const bool is_pair = a == b || species[i] != species[j];
          if (is_pair && nearest < kMax) pairs[static_cast<std::size_t>(nearest / kMax * kBins)] += 1;
          if (nearest < kNear) (species[i] == species[j] ? like : unlike) += 1;
        }
      }
      const std::size_t kind = PairMixing::pair_kind(kSpecies, a, b);
      const auto n_a = static_cast<double>(counts[a]), n_b = static_cast<double>(counts[b]);
      for (std::size_t k = 0; k < kBins; ++k) {
        const double width = kMax / kBins, outer = static_cast<double>(k + 1) * width, inner = outer - width;
        const double ordered = a == b ? n_a * (n_a - 1) : 2 * n_a * n_b;
        const double gas = ordered / box.area() * kPi * (outer * outer - inner * inner);
        EXPECT_NEAR(found.g[kind][k], pairs[k] / gas, 1e-9) << a << b << " " << k;
      }
      if (a == b) {
        EXPECT_TRUE(std::isnan(found.segregation[kind]));
      } else {
        const double n = n_a + n_b;
        EXPECT_NEAR(found.segregation[kind], 1 - unlike / (like + unlike) * n * (n - 1) / (2 * n_a * n_b), 1e-12);
      }
    }
  }
}

// One species makes no difference to the pair distribution of g2, in an annulus too, where rods hide from each other.
TEST(PairMixing, OfOneSpeciesIsThatOfG2) {
  Draw draw(4712);
  const Region annulus(Box(40), SideWalls{.arena = Arena::kAnnulus, .size = 38, .inner = 12});
  std::vector<Vec3> places;
  for (const Vec3& place : random_places(draw, 3000, 40)) {
    if (annulus.contains({place.x(), place.y()})) places.push_back(place);
  }
  ASSERT_GT(places.size(), 1100u) << "more than are taken as references";
  OrientationCorrelation g2(20, 20);
  PairMixing mixing(1, 20, 20, 3);
  const std::vector<Vec3> directors = random_axes(draw, places.size());
  for (int sample = 0; sample < 2; ++sample) {
    g2.accumulate(places, directors, annulus);
    mixing.accumulate(places, {}, annulus);
  }
  const std::vector<double> expected = g2.reduce().g, found = mixing.reduce().g[0];
  for (std::size_t k = 0; k < expected.size(); ++k) EXPECT_NEAR(found[k], expected[k], 1e-12) << k;
}

// Rods at random have no segregation; halves of a box have, but for what is near the borders; a chessboard has less
// than none.
TEST(PairMixing, Segregation) {
  Draw draw(4713);
  constexpr double kBox = 40;
  const std::vector<Vec3> places = random_places(draw, 4000, kBox);
  const auto segregation = [&](const std::vector<Vec3>& at, const std::vector<std::uint8_t>& species, double near) {
    PairMixing mixing(2, 10, 20, near);
    mixing.accumulate(at, species, kBox);
    return mixing.reduce().segregation[PairMixing::pair_kind(2, 0, 1)];
  };
  EXPECT_NEAR(segregation(places, drawn_species(draw, 4000, 2), 2), 0, 0.03);
  std::vector<std::uint8_t> by_halves, chessboard;
  std::vector<Vec3> grid;
  for (const Vec3& place : places) by_halves.push_back(place.x() < kBox / 2);
  for (int i = 0; i < 1600; ++i) {
    grid.emplace_back(i % 40 + 0.5, i / 40 + 0.5, 0);
    chessboard.push_back((i % 40 + i / 40) % 2);
  }
  // two borders of the length of the box, at each of which 2 near / (3 pi) of a rod's neighbours are beyond
  const double near = 2, beyond = 2 * 2 * near * 2 / (3 * kPi) / kBox;
  EXPECT_NEAR(segregation(places, by_halves, near), 1 - 2 * beyond, 0.03);
  EXPECT_NEAR(segregation(grid, chessboard, 1.1), -1, 0.01);
  EXPECT_THROW(PairMixing(1, 5, 10, 2).accumulate(places, by_halves, kBox), std::out_of_range);
}

}  // namespace
}  // namespace shaken::analysis
