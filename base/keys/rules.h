#pragma once

#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "base/keys/rule.h"

namespace shaken::keys {

/// The keys of one kind of text, in canonical order; a block stands before the keys in it. Table<T> knows besides where
/// their values lie in a T.
class Rules {
 public:
  Rules(const Rules&) = delete;
  Rules& operator=(const Rules&) = delete;

  const std::vector<const Rule*>& rules() const { return rules_; }

  /// The index of the key at `path`; -1 if there is none.
  int index(std::string_view path) const;
  /// True if `path` is an object that only groups other keys ("rods", "contacts.rod_rod", "measure").
  bool is_group(std::string_view path) const;
  /// Names that may stand in the object at `path`; "" is the text itself.
  std::vector<std::string> names_in(std::string_view path) const;
  /// The index of the block around a key; -1 if there is none.
  int block_around(std::string_view path) const;
  /// The same of key number `index`, at once.
  int block_of(std::size_t index) const { return blocks_[index]; }
  /// "; did you mean rods.length?" for a dotted path that does not exist, by its siblings first, then by all paths.
  std::string suggest_path(std::string_view path) const;

  /// The reference of the keys beneath `path` as a Markdown table.
  std::string as_markdown(std::string_view path = {}) const;

 protected:
  Rules() = default;
  ~Rules() = default;
  /// Called once, when all rules are there.
  void set(std::vector<const Rule*> rules);

 private:
  std::vector<const Rule*> rules_;
  std::unordered_map<std::string_view, int> by_path_;
  std::vector<int> blocks_;
};

/// True if `path` lies inside of the object at `outer`.
bool is_beneath(std::string_view path, std::string_view outer);

}  // namespace shaken::keys
