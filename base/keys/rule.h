#pragma once

#include <array>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "base/keys/document.h"
#include "base/keys/problem.h"
#include "base/keys/units.h"

namespace shaken::keys {

/// The value of one key: nothing, on or off (blocks and switches), a number in the default unit, a text, two numbers,
/// or a list of numbers in the default unit, of texts or of two numbers each.
using Value = std::variant<std::monostate, bool, double, std::string, std::array<double, 2>, std::vector<double>,
                           std::vector<std::string>, std::vector<std::array<double, 2>>>;

/// How a key is written.
enum class Form {
  kQuantity,   ///< a number or a string with a unit; or one of `names`, where there are any
  kWhole,      ///< a whole number
  kName,       ///< one of `names`
  kText,       ///< any text, or one that fits `pattern`
  kTexts,      ///< a list of texts, each one of `names` where there are any
  kPair,       ///< [a, b], numbers or strings with a unit; on a command line a,b
  kSize,       ///< [width, height], whole numbers; on a command line WIDTHxHEIGHT
  kSwitch,     ///< true or false; on a command line --KEY and --no-KEY
  kNumbers,    ///< a list of numbers or strings with a unit
  kPairs,      ///< a list of [a, b], numbers or strings with a unit
  kBlock,      ///< an object that switches something on; null or false switches it off
  kElsewhere,  ///< whatever another reader makes of it
};

/// All that is known of one key but where its value lies. Everything that reads, checks, suggests, writes or documents
/// keys asks their rules and nothing else.
struct Rule {
  std::string path = {};  ///< dotted: "rods.length"
  Form form = Form::kQuantity;
  Dimension dimension = Dimension::kPlain;
  double low = 0;          ///< smallest value allowed, in default units
  double high = 0;         ///< largest value allowed
  bool or_zero = false;    ///< 0 is allowed too, though it is below `low`
  bool only_even = false;  ///< of sizes: odd numbers are not allowed
  std::vector<std::string> names = {};
  std::string pattern = {};           ///< that a text fits as a whole, a POSIX extended and an ECMAScript expression
  std::size_t longest = 0;            ///< bytes of a text with a pattern
  std::size_t most = 0;               ///< texts or pairs in a list; 0: any number
  bool may_look_like_number = false;  ///< of texts: the quotes of one that has only digits may be missing
  /// What else is wrong with a text, as a sentence.
  std::function<std::optional<std::string>(const std::string&)> problem = {};
  std::string expected = {};    ///< what a text is, for messages: "the name of an account"
  std::string value_name = {};  ///< of a value in the help of a command line, if value_name() does not know it
  bool required = false;
  Value fallback = {};             ///< what holds if the key is absent; nothing where that is derived from other keys
  std::string fallback_note = {};  ///< says so in words, for the reference
  std::string doc = {};            ///< one line
  std::string title = {};          ///< in figures, in few words: "area fraction"
  std::string symbol = {};         ///< in LaTeX's mathematics: "L_y/L_x"
  std::string unit = {};           ///< of a plain number that has one all the same: "degrees"
  /// Left out of a canonical text where it has its default value, so that texts from before the key keep their names.
  bool omit_if_default = false;
};

/// One value that somebody wrote.
struct Given {
  Value value;
  Place place;
  bool ok = true;  ///< false if a problem with it has been reported already
};

/// Reads and checks one value of a key that is no block.
Given read_value(const Rule& rule, const Node& node, std::vector<Problem>& problems);

/// The same of a text of the command line.
Given read_text(const Rule& rule, const std::string& text, std::vector<Problem>& problems);

/// True if the key may have this number.
bool is_allowed(const Rule& rule, double value);
/// For people: "[0.1, 100] us", "0 or [0.1, 100] m/s^2".
std::string range_of(const Rule& rule);
/// In Markdown: `"aligned"` or `"random"`, [0.1, 100] us, whole, 1 to 6.
std::string allowed(const Rule& rule);
/// For people: "4.5 mm", "\"aligned\"", "[1280, 720]".
std::string show(const Rule& rule, const Value& value);
/// On a command line's help: "light|dark|print", "WxH", "N".
std::string value_name(const Rule& rule);
/// What holds if the key is absent, in words.
std::string fallback_of(const Rule& rule);

nlohmann::ordered_json to_json(const Rule& rule, const Value& value);

}  // namespace shaken::keys
