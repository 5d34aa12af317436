#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "scene/keys/fields.h"

namespace shaken::scene {

/// Dotted paths of fields.
using Paths = std::vector<std::string>;

/// A scene that is being resolved: what was said, what has been made of it so far, and what is wrong with it.
struct Resolution {
  const Draft& draft;
  std::vector<Problem>& problems;
  RunPlan plan = {};

  bool given(std::string_view path) const { return draft.find(path) != nullptr; }
  /// The number given at `path`, or its default.
  double number(std::string_view path) const;
  /// No problem was reported with any of these when they were read.
  bool ok(const Paths& paths) const;

  /// Reports a problem of several fields where the first of them that was given stands.
  void report(const Paths& paths, std::string message);
  /// The same, and false: for a function that returns whether all is well.
  bool refuse(const Paths& paths, std::string message) {
    report(paths, std::move(message));
    return false;
  }
  /// Reports a problem if what followed from `causes` lies outside of the field's range.
  void check_derived(std::string_view path, const Paths& causes);
};

/// One species that is there, with the name of its group of keys: "rods", "rods_2", ...
struct RodGroup {
  std::string name;
  RodShape& rod;
  int& count;
  std::string path(const char* key) const { return name + "." + key; }
};
std::vector<RodGroup> rod_groups(System& system);

/// Whether a quantity that is given twice is the same, to 1e-6.
bool agree(double a, double b);

/// For messages: "4.5 mm".
std::string length_text(double value);
/// For messages: "10 us".
std::string time_text(double value);

}  // namespace shaken::scene
