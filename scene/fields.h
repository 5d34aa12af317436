// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "scene/run_plan.h"
#include "scene/units.h"

namespace shaken::scene {

/// The value of one field: nothing, on or off (blocks and switches), a number in the default unit, one of the field's
/// names, a pair of whole numbers (sizes), or a list of numbers in the default unit.
using Value = std::variant<std::monostate, bool, double, std::string, std::array<double, 2>, std::vector<double>>;

/// How a field is written.
enum class Form {
  kQuantity,  ///< a number or a string with a unit; or one of `names`, where there are any
  kWhole,     ///< a whole number
  kName,      ///< one of `names`
  kRunId,     ///< the id of a run: 16 hex digits
  kSize,      ///< [width, height], even numbers
  kSwitch,    ///< true or false
  kNumbers,   ///< a list of numbers or strings with a unit
  kBlock,     ///< an object that switches something on; null or false switches it off
};

/// All that is known of one key of a scene. Everything that reads, checks, suggests, writes or documents keys asks this
/// table and nothing else.
struct Field {
  std::string path = {};  ///< dotted: "rods.length"
  Form form = Form::kQuantity;
  Dimension dimension = Dimension::kPlain;
  double low = 0;        ///< smallest value allowed, in default units
  double high = 0;       ///< largest value allowed
  bool or_zero = false;  ///< 0 is allowed too, though it is below `low`
  std::vector<std::string> names = {};
  Value fallback = {};             ///< what holds if the key is absent; nothing where that is derived from other keys
  std::string fallback_note = {};  ///< says so in words, for the reference
  std::string doc = {};            ///< one line
  /// Left out of the canonical scene where it has its default value, so that scenes from before the key keep their
  /// names.
  bool omit_if_default = false;

  /// The value in a plan; asked only if the block that the field is in is on. Empty for keys that only help to write a
  /// scene (bead_pitch).
  std::function<Value(const RunPlan&)> fetch = {};
  /// Puts a value into a plan; empty for fields whose value other fields carry (gamma, area_fraction, ...).
  std::function<void(RunPlan&, const Value&)> store = {};
};

/// Every field, in canonical order; a block stands before the fields in it.
const std::vector<Field>& fields();

/// The index of the field at `path`; -1 if there is none.
int field_index(std::string_view path);
/// The field at `path`, which must exist.
const Field& field_at(std::string_view path);
/// True if `path` is an object that only groups other keys ("rods", "contacts.rod_rod", "measure").
bool is_group(std::string_view path);
/// Names that may stand in the object at `path`; "" is the scene itself.
std::vector<std::string> names_in(std::string_view path);
/// True if `path` lies inside of the object at `outer`.
bool is_beneath(std::string_view path, std::string_view outer);
/// The block around a field; empty if there is none.
std::string_view block_around(std::string_view path);
/// The same of one of fields(), at once; null if there is none.
const Field* block_of(const Field& field);

/// "; did you mean rods.length?" for a dotted path that does not exist, by its siblings first, then by all paths.
std::string suggest_path(std::string_view path);

/// True if the field may have this value.
bool is_allowed(const Field& field, double value);
/// For people: "[0.1, 100] us", "0 or [0.1, 100] m/s^2".
std::string range_of(const Field& field);

/// For people: "4.5 mm", "\"aligned\"", "1280 x 720".
std::string show(const Field& field, const Value& value);

/// The reference of all keys as a Markdown table (docs/scene.md).
std::string fields_as_markdown();

}  // namespace shaken::scene
