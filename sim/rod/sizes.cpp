#include "sim/rod/sizes.h"

#include <array>

namespace shaken {
namespace {

/// By how many standard deviations the sizes differ from the mean one: means of ninths of the normal distribution, over
/// their own standard deviation 0.97620.
constexpr double kA = 0.29011790592969483, kB = 0.60662730843292710, kC = 0.99944677635858750, kD = 1.7461217169913497;

struct Deviation {
  double length, end_diameter;
};

/// Points of a Latin square, which a quarter turn brings onto each other: neither quantity says anything of the mean of
/// the other.
constexpr std::array<Deviation, kSizes> kDeviations{
    {{0, 0}, {kA, -kC}, {-kA, kC}, {kB, kD}, {-kB, -kD}, {kC, kA}, {-kC, -kA}, {kD, -kB}, {-kD, kB}}};

}  // namespace

std::vector<RodShape> sizes_of(const RodShape& mean) {
  RodShape alike = mean;
  alike.spread = {};
  if (!mean.spread.is_any()) return {alike};
  std::vector<RodShape> sizes(kSizes, alike);
  for (std::size_t k = 0; k < kSizes; ++k) {
    const double longer = 1.0 + mean.spread.length * kDeviations[k].length;
    sizes[k].length *= longer;
    if (mean.has_axis()) {
      sizes[k].end_diameter *= 1.0 + mean.spread.end_diameter * kDeviations[k].end_diameter;
    } else {
      sizes[k].mid_diameter *= longer;
      for (double& diameter : sizes[k].bead_diameters) diameter *= longer;
    }
  }
  return sizes;
}

int count_of_size(int count, std::size_t k, std::size_t n_sizes) {
  const auto rods = static_cast<std::size_t>(count);
  return static_cast<int>(rods / n_sizes + (k < rods % n_sizes ? 1 : 0));
}

std::vector<Component> components_of(const System& system) {
  std::vector<Component> components;
  std::uint8_t species = 0;
  const auto add = [&](const RodShape& mean, int count) {
    const std::vector<RodShape> sizes = sizes_of(mean);
    for (std::size_t k = 0; k < sizes.size(); ++k)
      components.push_back({sizes[k], count_of_size(count, k, sizes.size()), species});
    ++species;
  };
  add(system.rod, system.n_rods);
  for (const auto& more : system.added) {
    if (more) add(more->rod, more->count);
  }
  return components;
}

}  // namespace shaken
