// SPDX-License-Identifier: MIT
#include "scene/derived.h"

#include <cmath>

#include "sim/rod/species.h"

namespace shaken::scene {

namespace {

double squared(double x) { return x * x; }

}  // namespace

std::optional<double> gamma_of(const System& scene) {
  if (scene.gravity == 0) return std::nullopt;
  return scene.amplitude * squared(2 * kPi * scene.frequency) / scene.gravity;
}

double amplitude_for(double gamma, double frequency, double gravity) {
  return gamma * gravity / squared(2 * kPi * frequency);
}

double frequency_for(double gamma, double amplitude, double gravity) {
  return std::sqrt(gamma * gravity / amplitude) / (2 * kPi);
}

double peak_speed_of(const System& scene) { return 2 * kPi * scene.frequency * scene.amplitude; }

double arena_size_for(const SideWalls& walls, double area) {
  if (walls.arena == Arena::kSquare) return std::sqrt(area);
  return std::sqrt(4.0 * area / kPi + (walls.arena == Arena::kAnnulus ? squared(walls.inner) : 0.0));
}

double area_for_rods(const System& scene) { return scene.walls ? scene.walls->area() : squared(scene.box_side); }

double area_fraction_of(const System& scene) { return area_fraction_of(scene, scene.rod, scene.n_rods); }

double area_fraction_of(const System& scene, const RodShape& rod, int count) {
  return count * make_species(rod).area / area_for_rods(scene);
}

}  // namespace shaken::scene
