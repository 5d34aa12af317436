#include "scene/keys/derived.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "sim/rod/sizes.h"

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

Species species_of(const RodShape& rod) {
  struct Kept {
    RodShape rod;
    Species species;
  };
  constexpr std::size_t kMost = 4 * kSizes;
  thread_local std::vector<Kept> kept;  // the last one made stands last
  const auto found = std::find_if(kept.begin(), kept.end(), [&](const Kept& one) { return one.rod == rod; });
  if (found != kept.end()) return found->species;
  if (kept.size() == kMost) kept.erase(kept.begin());
  return kept.emplace_back(Kept{rod, make_species(rod)}).species;
}

std::vector<Species> sizes_of_species(const RodShape& rod) {
  std::vector<Species> sizes;
  for (const RodShape& size : sizes_of(rod)) sizes.push_back(species_of(size));
  return sizes;
}

double thickest_bead(const RodShape& rod) {
  if (!rod.has_axis()) return rod.mid_diameter;
  if (rod.bead_diameters.empty()) return std::max(rod.mid_diameter, rod.end_diameter);
  return *std::max_element(rod.bead_diameters.begin(), rod.bead_diameters.end());
}

double mean_area_of(const RodShape& rod) {
  const std::vector<Species> sizes = sizes_of_species(rod);
  return std::accumulate(sizes.begin(), sizes.end(), 0.0,
                         [](double sum, const Species& one) { return sum + one.area; }) /
         static_cast<double>(sizes.size());
}

double area_fraction_of(const System& scene) { return area_fraction_of(scene, scene.rod, scene.n_rods); }

double total_area_fraction_of(const System& scene) {
  double sum = area_fraction_of(scene);
  for (const auto& added : scene.added) sum += added ? area_fraction_of(scene, added->rod, added->count) : 0;
  return sum;
}

double area_fraction_of(const System& scene, const RodShape& rod, int count) {
  const std::vector<Species> sizes = sizes_of_species(rod);
  double covered = 0;
  for (std::size_t k = 0; k < sizes.size(); ++k) covered += count_of_size(count, k, sizes.size()) * sizes[k].area;
  return covered / scene.area();
}

}  // namespace shaken::scene
