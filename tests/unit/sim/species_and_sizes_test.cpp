#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

#include "sim/rod/sizes.h"
#include "sim/rod/species.h"
#include "sim/tick/tick.h"
#include "sim/world.h"
#include "tests/support/short_rods.h"

namespace shaken {
namespace {

RodShape paper_rod(double length) {
  RodShape shape;
  shape.length = length;
  shape.n_beads = beads_for_pitch(length, shape.end_diameter, 0.3);
  return shape;
}

TEST(Species, SphereHasTheClosedForms) {
  const Species sphere =
      make_species({.length = 0.8, .mid_diameter = 0.8, .end_diameter = 0.8, .n_beads = 1, .density = 8.5});
  const double r = 0.4;
  const double mass = 8.5 * 4.0 / 3.0 * kPi * r * r * r;
  EXPECT_NEAR(sphere.mass, mass, 1e-14 * mass);
  EXPECT_NEAR(sphere.area, kPi * r * r, 1e-14);
  EXPECT_NEAR(sphere.inertia_par, 0.4 * mass * r * r, 1e-14 * mass);
  EXPECT_NEAR(sphere.inertia_perp, 0.4 * mass * r * r, 1e-14 * mass);
}

TEST(Species, TwoSeparateSpheresFollowSteiner) {
  // beads further apart than their diameters: three free spheres on a massless axis
  const RodShape shape{.length = 6.0, .mid_diameter = 1.0, .end_diameter = 1.0, .n_beads = 3, .density = 1.0};
  const Species rod = make_species(shape);
  const double r = 0.5;
  const double h = 2.5;
  const double one = 4.0 / 3.0 * kPi * r * r * r;
  EXPECT_NEAR(rod.mass, 3 * one, 1e-13);
  EXPECT_NEAR(rod.inertia_par, 3 * 0.4 * one * r * r, 1e-13);
  EXPECT_NEAR(rod.inertia_perp, 3 * 0.4 * one * r * r + 2 * one * h * h, 1e-12);
  EXPECT_NEAR(rod.area, 3 * kPi * r * r, 1e-13);
}

TEST(Species, AgreesWithBruteForceQuadrature) {
  for (const double length : {2.5, 3.0, 3.5, 4.0, 4.5}) {
    const RodShape shape = paper_rod(length);
    const Species rod = make_species(shape);
    double area = 0, volume = 0, par = 0, perp = 0;
    const int n = 400000;
    const double dx = length / n;
    for (int k = 0; k < n; ++k) {
      const double x = -0.5 * length + (k + 0.5) * dx;
      double r2 = 0;
      for (int b = 0; b < rod.n_beads(); ++b) {
        const double u = x - rod.bead_offset[b];
        r2 = std::max(r2, rod.bead_radius[b] * rod.bead_radius[b] - u * u);
      }
      area += 2 * std::sqrt(r2) * dx;
      volume += kPi * r2 * dx;
      par += 0.5 * kPi * r2 * r2 * dx;
      perp += kPi * (0.25 * r2 * r2 + r2 * x * x) * dx;
    }
    EXPECT_NEAR(rod.area, area, 1e-7 * area);
    EXPECT_NEAR(rod.mass, shape.density * volume, 1e-8 * rod.mass);
    EXPECT_NEAR(rod.inertia_par, shape.density * par, 1e-8 * rod.inertia_par);
    EXPECT_NEAR(rod.inertia_perp, shape.density * perp, 1e-8 * rod.inertia_perp);
  }
}

TEST(Species, InertiaOfBeadsAddedUpFollowsSteinerWhateverOverlaps) {
  // three alike beads of radius 1/2 at -1/2, 0 and 1/2, a third of the mass each
  const RodShape alike{
      .length = 2.0, .mid_diameter = 1.0, .end_diameter = 1.0, .n_beads = 3, .inertia = Inertia::kBeads};
  const Species rod = make_species(alike);
  RodShape as_solid = alike;
  as_solid.inertia = Inertia::kSolid;
  EXPECT_EQ(rod.mass, make_species(as_solid).mass);
  EXPECT_NEAR(rod.inertia_par, 0.1 * rod.mass, 1e-14 * rod.mass);
  EXPECT_NEAR(rod.inertia_perp, (0.1 + 0.25 * 2 / 3) * rod.mass, 1e-14 * rod.mass);

  // radii 1/2 and 1, so masses of 1/9 and 8/9, at a distance of 3/2
  const RodShape unlike{.length = 3.0, .n_beads = 2, .inertia = Inertia::kBeads, .bead_diameters = {1.0, 2.0}};
  const Species polar = make_species(unlike);
  EXPECT_NEAR(polar.bead_offset[0], -1.5 * 8 / 9, 1e-14);
  EXPECT_NEAR(polar.bead_offset[1], 1.5 / 9, 1e-14);
  EXPECT_NEAR(polar.inertia_par, 0.4 * (0.25 / 9 + 8.0 / 9) * polar.mass, 1e-14 * polar.mass);
  EXPECT_NEAR(polar.inertia_perp, polar.inertia_par + 1.5 * 1.5 * 8 / 81 * polar.mass, 1e-14 * polar.mass);

  // beads that do not overlap are the same either way
  RodShape apart{.length = 6.0, .mid_diameter = 1.0, .end_diameter = 1.0, .n_beads = 3};
  const Species solid = make_species(apart);
  apart.inertia = Inertia::kBeads;
  EXPECT_NEAR(make_species(apart).inertia_perp, solid.inertia_perp, 1e-12);
  EXPECT_NEAR(make_species(apart).inertia_par, solid.inertia_par, 1e-13);
}

TEST(Species, BeadsAndAreaOfThePaper) {
  EXPECT_EQ(beads_for_pitch(2.5, 0.4, 0.3), 9);
  EXPECT_EQ(beads_for_pitch(4.5, 0.4, 0.3), 15);
  // Sharma & Soni 2024 give 2,500 to 4,400 rods at l = 2.5 mm and 1,400 to 2,400 at l = 4.5 mm for area fraction 0.50
  // to 0.85 in a box of 83.73 mm (rounded to hundreds)
  const double box = 83.73 * 83.73;
  const double short_area = make_species(paper_rod(2.5)).area;
  const double long_area = make_species(paper_rod(4.5)).area;
  EXPECT_NEAR(short_area, 1.368, 0.001);
  EXPECT_NEAR(long_area, 2.492, 0.001);
  EXPECT_NEAR(0.50 * box / short_area, 2500, 100);
  EXPECT_NEAR(0.85 * box / short_area, 4400, 60);
  EXPECT_NEAR(0.50 * box / long_area, 1400, 50);
  EXPECT_NEAR(0.85 * box / long_area, 2400, 50);
}

TEST(Species, ProfileIsSymmetricAndTapersLinearly) {
  const Species rod = make_species(paper_rod(4.5));
  ASSERT_EQ(rod.n_beads(), 15);
  EXPECT_DOUBLE_EQ(rod.bead_offset.back() + rod.end_radius, 2.25);
  for (int b = 0; b < 15; ++b) {
    EXPECT_EQ(rod.bead_offset[b], -rod.bead_offset[14 - b]);
    EXPECT_EQ(rod.bead_radius[b], rod.bead_radius[14 - b]);
    EXPECT_NEAR(rod.bead_radius[b], 0.4 - rod.taper() * std::abs(rod.bead_offset[b]), 1e-15);
  }
}

// Rods of one species that differ in size: their sizes, how many there are of each, and which rod has which.

const RodShape kMean{.length = 4, .end_diameter = 0.5, .spread = {.length = 0.1, .end_diameter = 0.2}};

double mean_of(const std::vector<double>& x) {
  double sum = 0;
  for (const double one : x) sum += one;
  return sum / static_cast<double>(x.size());
}

TEST(Species, OfANumberBeyondAllIsNotThere) {
  System full;
  full.added.fill(AddedRods{full.rod, 1});
  for (std::size_t number = 0; number < 300; ++number) EXPECT_EQ(full.has_species(number), number < kMostSpecies);
}

TEST(Sizes, AreOneWithoutSpread) {
  RodShape rod;
  EXPECT_EQ(sizes_of(rod), std::vector{rod});
}

TEST(Sizes, HaveExactlyTheMeansAndDeviationsAskedForAndAreNotCorrelated) {
  const std::vector<RodShape> sizes = sizes_of(kMean);
  ASSERT_EQ(sizes.size(), kSizes);
  std::vector<double> length, end, length2, end2, both;
  for (const RodShape& size : sizes) {
    EXPECT_EQ(size.spread, SizeSpread{});
    EXPECT_EQ(size.n_beads, kMean.n_beads);
    EXPECT_EQ(size.mid_diameter, kMean.mid_diameter);
    length.push_back(size.length / 4 - 1);
    end.push_back(size.end_diameter / 0.5 - 1);
    length2.push_back(length.back() * length.back());
    end2.push_back(end.back() * end.back());
    both.push_back(length.back() * end.back());
  }
  EXPECT_NEAR(mean_of(length), 0, 1e-15);
  EXPECT_NEAR(mean_of(end), 0, 1e-15);
  EXPECT_NEAR(mean_of(length2), 0.01, 1e-15);
  EXPECT_NEAR(mean_of(end2), 0.04, 1e-15);
  EXPECT_NEAR(mean_of(both), 0, 1e-17);
  EXPECT_EQ(length.front(), 0) << "the mean rod in front";
  EXPECT_EQ(end.front(), 0);
  std::ranges::sort(length);
  std::ranges::sort(end);
  for (std::size_t k = 0; k < kSizes; ++k) EXPECT_NEAR(end[k], 2 * length[k], 1e-14) << "the same distribution";
}

// The slow twin integrates the normal distribution.
TEST(Sizes, AreMeansOfNinthsOfTheNormalDistribution) {
  constexpr int kSteps = 4'000'000;
  constexpr double kEnd = 8, kStep = 2 * kEnd / kSteps;
  std::vector<double> weight(kSizes), sum(kSizes);
  double below = 0;
  for (int i = 0; i < kSteps; ++i) {
    const double x = -kEnd + (i + 0.5) * kStep, part = std::exp(-x * x / 2) / std::sqrt(2 * kPi) * kStep;
    const auto k = static_cast<std::size_t>(std::min(9 * (below + part / 2), 8.999));
    weight[k] += part;
    sum[k] += part * x;
    below += part;
  }
  double square = 0;
  for (std::size_t k = 0; k < kSizes; ++k) square += sum[k] / weight[k] * (sum[k] / weight[k]) / kSizes;
  std::vector<double> found;
  for (const RodShape& size : sizes_of({.length = 1, .spread = {.length = 0.1}}))
    found.push_back(10 * (size.length - 1));
  std::ranges::sort(found);
  for (std::size_t k = 0; k < kSizes; ++k) EXPECT_NEAR(found[k], sum[k] / weight[k] / std::sqrt(square), 2e-5) << k;
}

TEST(Sizes, OfSpheresAreTheirDiameters) {
  for (const RodShape& size :
       sizes_of({.length = 0.8, .mid_diameter = 0.8, .end_diameter = 0.8, .n_beads = 1, .spread = {.length = 0.1}})) {
    EXPECT_EQ(size.length, size.mid_diameter);
    EXPECT_NEAR(make_species(size).max_radius, size.length / 2, 1e-15);
  }
}

TEST(Sizes, HaveEquallyManyRodsInRandomOrder) {
  System system = test::short_rods(60, 30);
  system.rod.spread.length = 0.1;
  system.added[1] = AddedRods{{.length = 0.8, .n_beads = 1}, 10};
  const World world = empty_world(system);
  ASSERT_EQ(world.species.size(), kSizes + 1);
  EXPECT_EQ(world.species_of_shape, (std::vector<std::uint8_t>{0, 0, 0, 0, 0, 0, 0, 0, 0, 1}));
  std::map<int, int> count;
  for (const std::uint8_t shape : world.shape_of_rod) ++count[shape];
  for (int k = 0; k < static_cast<int>(kSizes); ++k) EXPECT_NEAR(count[k], 60 / 9.0, 1) << k;
  EXPECT_EQ(count[9], 10);
  EXPECT_EQ(world.shape_of_rod.size(), 70u);
  EXPECT_FALSE(std::ranges::is_sorted(world.shape_of_rod));
  system.seed += 1;
  EXPECT_NE(empty_world(system).shape_of_rod, world.shape_of_rod);
  const Cell cell = world.cell();
  EXPECT_EQ(cell.n_species(), 2u);
  EXPECT_EQ(cell.first_shape_of(1), kSizes);
  const std::vector<std::uint8_t> species = cell.species_of_rods();
  EXPECT_EQ(std::ranges::count(species, 1), 10);
  EXPECT_EQ(cell.of_species(0, species).size(), 60u);
}

// Species are counted as the scene has them, sizes do not change that: rods and rods_3, without rods_2.
TEST(Sizes, HaveTheContactsOfTheirSpecies) {
  System system = test::short_rods(20, 30);
  system.rod.spread.length = 0.1;
  system.added[1] = AddedRods{{.length = 0.8, .n_beads = 1, .spread = {.length = 0.1}}, 10};
  system.rod_rod.friction = 0.05;
  system.rod_rod.own[Contacts::place(0, 2)].friction = 0.2;
  system.rod_rod.own[Contacts::place(2, 2)].friction = 0.4;
  system.rod_base.own[Contacts::place(0, 2)].friction = 0.7;
  system.walls = SideWalls{Arena::kSquare, 18.0, 1.0, {0.1, 0.3}};
  system.walls->contact.own[Contacts::place(0, 2)].friction = 0.6;
  system.posts = Posts{.diameter = 1.2, .columns = 2, .rows = 2, .contact = {0.3, 0.3}};
  system.posts->contact.own[Contacts::place(0, 2)].friction = 0.5;
  system.rod_rod.own[Contacts::place(0, 1)].friction = system.rod_base.own[Contacts::place(0, 1)].friction =
      9;  // of none
  const World world = empty_world(system);
  const TickRules rules(world);
  const Cell cell = world.cell();
  for (int i = 0; i < 30; ++i) {
    const bool is_third = cell.species_of(static_cast<std::size_t>(i)) == 1;
    EXPECT_EQ(rules.species_of(i).base.friction, is_third ? 0.7 : 0.01);
    EXPECT_EQ(rules.species_of(i).wall.friction, is_third ? 0.6 : 0.1);
    EXPECT_EQ(rules.species_of(i).post.friction, is_third ? 0.5 : 0.3);
    for (int j = 0; j < 30; ++j) {
      const bool is_other_third = cell.species_of(static_cast<std::size_t>(j)) == 1;
      const double friction = is_third && is_other_third ? 0.4 : is_third || is_other_third ? 0.2 : 0.05;
      EXPECT_EQ(rules.rod_rod(i, j).friction, friction) << i << " " << j;
    }
  }
}

TEST(Sizes, OfFewerRodsThanSizesAreNotAllThere) {
  const std::vector<RodShape> sizes = sizes_of(kMean);
  for (const int count : {1, 3, 5, 9, 14, 99}) {
    int sum = 0;
    double longer = 0, wider = 0;
    for (std::size_t k = 0; k < kSizes; ++k) {
      const int rods = count_of_size(count, k, kSizes);
      sum += rods;
      longer += rods * (sizes[k].length - kMean.length);
      wider += rods * (sizes[k].end_diameter - kMean.end_diameter);
    }
    EXPECT_EQ(sum, count);
    if (count % 9 % 2 == 0 && count % 9 > 0) continue;  // one rod has no counterpart
    EXPECT_NEAR(longer, 0, 1e-13) << count;
    EXPECT_NEAR(wider, 0, 1e-13) << count;
  }
  System system = test::short_rods(1, 30);
  system.rod.spread.length = 0.1;
  EXPECT_EQ(empty_world(system).shape_of_rod, std::vector<std::uint8_t>{0}) << "the mean rod";
}

}  // namespace
}  // namespace shaken
