#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/keys/problem.h"

namespace shaken::keys {

struct Member;

/// One JSON value and where it was written. Numbers keep their digits as text.
struct Node {
  enum class Kind { kNull, kBoolean, kNumber, kString, kArray, kObject };

  Kind kind = Kind::kNull;
  Place place;
  bool boolean = false;
  std::string text;             ///< the string, or the number as written
  std::vector<Node> items;      ///< of an array
  std::vector<Member> members;  ///< of an object, in the order written

  /// The value of `key`; null if it is not there.
  const Member* find(std::string_view key) const;
};

struct Member {
  std::string key;
  Place place;  ///< of the key
  Node value;
};

/// Reads strict JSON with // and /* */ comments. Syntax errors (which include NaN, Infinity and anything after the
/// value) give one problem and no value; duplicate keys give a problem each, and the first one counts.
std::optional<Node> parse_document(std::string_view text, const std::string& file, std::vector<Problem>& problems);

/// True of "$schema", in which a file may name its schema to an editor; it means nothing here, but must be a text.
bool is_link_to_schema(const Member& member, std::vector<Problem>& problems);

/// "an object", "the number 3", for messages.
std::string describe(const Node& node);

}  // namespace shaken::keys
