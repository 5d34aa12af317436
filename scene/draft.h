// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "scene/document.h"
#include "scene/fields.h"
#include "scene/problem.h"

namespace shaken::scene {

/// One value that somebody wrote.
struct Given {
  Value value;
  Place place;
  bool ok = true;  ///< false if a problem with it has been reported already
};

/// What has been said about a scene so far, field by field: from its file, then from settings or a point of a sweep.
/// Each value is checked by itself here; what they say together is resolve's business.
class Draft {
 public:
  /// Nothing given: the defaults. Places of nothing in particular are at `place`.
  explicit Draft(Place place);

  /// Reads a whole scene.
  void read(const Node& scene, std::vector<Problem>& problems);

  /// Gives the field, block or group at the dotted `path` a value. An object replaces all that was said beneath `path`;
  /// a field inside a block switches the block on; null takes back what was said (and switches a block off).
  void assign(std::string_view path, const Place& key, const Node& node, std::vector<Problem>& problems);

  /// What was given; null if nothing was.
  const Given* find(std::string_view path) const;
  const Given* find(std::size_t field) const;
  /// No problem with the field has been reported so far.
  bool is_ok(std::string_view path) const;
  /// The block is on; true for "", where there is no block.
  bool is_on(std::string_view block) const;
  /// Of the scene as a whole.
  const Place& place() const { return place_; }

 private:
  void read_members(std::string_view path, const Node& object, std::vector<Problem>& problems);
  void clear_beneath(std::string_view path);

  Place place_;
  std::vector<std::optional<Given>> given_;  // (fields)
};

}  // namespace shaken::scene
