#include "sim/rod/species.h"

#include <gtest/gtest.h>

#include <cmath>

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

}  // namespace
}  // namespace shaken
