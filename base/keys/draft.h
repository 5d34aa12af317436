#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "base/keys/rules.h"

namespace shaken::keys {

/// What has been said so far, key by key: from a file, then from settings or a point of a sweep. Each value is checked
/// by itself here; what they say together is the business of whoever asked for them.
class Draft {
 public:
  /// Nothing given: the defaults. Places of nothing in particular are at `place`.
  Draft(const Rules& table, Place place);

  /// Reads a whole text.
  void read(const Node& text, std::vector<Problem>& problems);

  /// Gives the key, block or group at the dotted `path` a value. An object replaces all that was said beneath `path`;
  /// a key inside a block switches the block on; null takes back what was said (and switches a block off).
  void assign(std::string_view path, const Place& key, const Node& node, std::vector<Problem>& problems);

  /// What was given; null if nothing was.
  const Given* find(std::string_view path) const;
  const Given* find(std::size_t index) const;
  /// No problem with the key has been reported so far.
  bool is_ok(std::string_view path) const;
  /// The block is on.
  bool is_on(std::string_view block) const;
  bool is_on(std::size_t block) const;
  /// The place of the text as a whole.
  const Place& place() const { return place_; }

 private:
  void read_members(std::string_view path, const Node& object, std::vector<Problem>& problems);
  void clear_beneath(std::string_view path);

  const Rules& table_;
  Place place_;
  std::vector<std::optional<Given>> given_;  // (keys)
};

}  // namespace shaken::keys
