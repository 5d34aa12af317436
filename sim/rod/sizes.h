#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "sim/system.h"

namespace shaken {

/// Rods of one species that differ in size come in so many sizes, of equally many rods.
inline constexpr std::size_t kSizes = 9;

/// Shapes of the rods of a species, first that of the mean rod: kSizes where they differ, else that one. A size has the
/// mean of one of kSizes equally likely parts of a normal distribution, scaled such that the standard deviation over
/// all sizes is exact. Length and end diameter are paired such that they are not correlated. All sizes have as many
/// beads.
std::vector<RodShape> sizes_of(const RodShape& mean);

/// Rods that are all alike.
struct Component {
  RodShape shape;            ///< without spread
  int count = 0;             ///< may be none, where a species has fewer rods than sizes
  std::uint8_t species = 0;  ///< 0 for the scene's rods, 1 and 2 for the others that it has
};

/// The sizes of all rods of a system: species by species, each with the mean size in front.
std::vector<Component> components_of(const System& system);

/// The number of rods among `count` that are of size `k` of `n_sizes`: those that are left over go to the mean size and
/// to pairs about it.
int count_of_size(int count, std::size_t k, std::size_t n_sizes);

}  // namespace shaken
