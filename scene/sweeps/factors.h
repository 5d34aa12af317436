#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "scene/keys/keys.h"
#include "scene/keys/values.h"

namespace shaken::scene {

inline constexpr int kMaxReplicas = 10000;
inline constexpr std::size_t kMaxStages = 1000;  ///< of one product

/// One swept path, with the value that it takes in each choice of its factor (a single one in a list).
struct Axis {
  std::string path;
  Place key;
  std::vector<Node> values;
};

/// Paths that vary together.
struct Factor {
  enum class Kind { kGrid, kZip, kList };
  Kind kind = Kind::kGrid;
  std::size_t n_choices = 0;
  std::vector<Axis> axes;
  /// Lists only (n_choices): the axes that take part in each choice.
  std::vector<std::vector<std::size_t>> members;

  bool has(std::string_view path) const;
};

/// "grid"
std::string name_of(Factor::Kind kind);

/// What one run of a protocol says beyond the scene: one value of each path. It holds for the runs after it too, until
/// one of them says otherwise.
using Stage = std::vector<Axis>;

/// A product: its points are all combinations of its factors' choices, the first factor varying slowest, with
/// `replicas` runs of each. With stages, each of these is a chain of runs, in which every one but the first begins
/// where the one before has left the rods.
struct Variation {
  std::vector<Factor> factors;
  std::vector<Stage> stages;
  int replicas = 1;
};

/// What the "sweep" of a file says, as far as there is room for its values: one product, or several in an array. At
/// least one; where what is written is none at all, one without factors stands in.
std::vector<Variation> read_variations(const Node& sweep, Room& room, std::vector<Problem>& problems);

}  // namespace shaken::scene
