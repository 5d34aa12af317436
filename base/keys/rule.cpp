#include "base/keys/rule.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <regex.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>

#include "base/core/check.h"
#include "base/keys/nearest.h"

namespace shaken::keys {

namespace {

/// Whether `text` as a whole fits a POSIX extended regular expression, none of which allows a NUL or the end of a line.
/// (Not std::regex: cpp-httplib has a compiled copy of that, whose locks a thread sanitizer cannot see.)
bool fits_pattern(const std::string& text, const std::string& pattern) {
  if (text.find_first_of(std::string_view("\0\n", 2)) != std::string::npos) return false;
  regex_t compiled;
  if (regcomp(&compiled, ("^(" + pattern + ")$").c_str(), REG_EXTENDED | REG_NOSUB) != 0) return false;
  const bool fits = regexec(&compiled, text.c_str(), 0, nullptr, 0) == 0;
  regfree(&compiled);
  return fits;
}

std::string quoted(const std::vector<std::string>& names) { return fmt::format("\"{}\"", fmt::join(names, "\", \"")); }

/// A value like the one written that would be allowed: the same digits with another unit or with the point moved.
/// Of several such values it is the one nearest to the default.
std::string slip_of_the_pen(const Rule& rule, const Written& written) {
  const double* usual = std::get_if<double>(&rule.fallback);
  if (!usual || *usual <= 0 || written.number.digits <= 0) return {};
  const auto written_value = in_default_unit(written, rule.dimension);
  if (!written_value) return {};
  std::string best;
  double least = std::abs(std::log(written_value->value() / *usual));
  const auto consider = [&](const Written& candidate) {
    const Result<Decimal> number = in_default_unit(candidate, rule.dimension);
    if (!number || !is_allowed(rule, number->value())) return;
    const double distance = std::abs(std::log(number->value() / *usual));
    if (distance >= least) return;
    const std::string_view unit = candidate.unit.empty() ? default_unit(rule.dimension) : candidate.unit;
    best = fmt::format("{}{}{}", candidate.number.text(), unit.empty() ? "" : " ", unit);
    least = distance;
  };
  for (const Unit& unit : units_of(rule.dimension)) {
    if (static_cast<unsigned char>(unit.name.front()) < 0x80) consider({written.number, std::string(unit.name)});
  }
  for (int power = -3; power <= 3; ++power) consider({*scaled(written.number, 1, power), written.unit});
  return best;
}

std::string example_for(const Rule& rule) {
  const std::string_view unit = default_unit(rule.dimension);
  switch (rule.form) {
    case Form::kQuantity:
      return unit.empty() ? "a number" : fmt::format("a number in {} or a text with a unit", unit);
    case Form::kWhole:
      return "a whole number";
    case Form::kName:
      return "one of " + quoted(rule.names);
    case Form::kText:
      return rule.expected.empty() ? "a text" : rule.expected;
    case Form::kTexts:
      return rule.most > 0 ? fmt::format("a list of at most {} texts", rule.most) : "a list of texts";
    case Form::kPair:
      return "two numbers, [a, b]";
    case Form::kSize:
      return "[width, height]";
    case Form::kSwitch:
      return "true or false";
    case Form::kNumbers:
      return fmt::format("a list of numbers in {} or of texts with a unit", unit);
    case Form::kPairs:
      return fmt::format("a list of {}pairs of numbers, [[a, b], [c, d], ...]",
                         rule.most > 0 ? fmt::format("at most {} ", rule.most) : "");
    case Form::kBlock:
      return "an object, null or false";
    case Form::kElsewhere:
      break;
  }
  return "";
}

/// Reads one value for one key; a value with a problem is not ok.
class ValueReader {
 public:
  ValueReader(const Rule& rule, std::vector<Problem>& problems) : rule_(rule), problems_(problems) {}

  Given read(const Node& node) {
    Given given{{}, node.place, true};
    switch (rule_.form) {
      case Form::kQuantity:
        read_quantity(node, given);
        break;
      case Form::kWhole:
        read_whole(node, given);
        break;
      case Form::kName:
        read_name(node, given);
        break;
      case Form::kText:
        read_text(node, given);
        break;
      case Form::kTexts:
        read_list<std::string>(node, given, rule_.names.empty() ? &ValueReader::read_text : &ValueReader::read_name);
        break;
      case Form::kPair:
        read_two(node, given, &ValueReader::read_quantity);
        break;
      case Form::kSize:
        read_two(node, given, &ValueReader::read_side);
        break;
      case Form::kSwitch:
        given.value = node.boolean;
        if (node.kind != Node::Kind::kBoolean) expected(node, given);
        break;
      case Form::kNumbers:
        if (node.items.empty()) return expected(node, given), given;
        read_list<double>(node, given, &ValueReader::read_quantity);
        break;
      case Form::kPairs:
        if (node.items.empty()) return expected(node, given), given;
        read_list<std::array<double, 2>>(node, given, &ValueReader::read_pair);
        break;
      case Form::kBlock:
      case Form::kElsewhere:
        SHAKEN_CHECK(false, "objects are the business of drafts and of other readers");
    }
    return given;
  }

 private:
  using Part = void (ValueReader::*)(const Node&, Given&);

  void report(const Node& node, Given& given, std::string message) {
    problems_.push_back(problem_at(node.place, rule_.path, std::move(message)));
    given.ok = false;
  }

  void expected(const Node& node, Given& given) {
    report(node, given, fmt::format("expected {}, not {}", example_for(rule_), describe(node)));
  }

  void read_quantity(const Node& node, Given& given) {
    if (node.kind == Node::Kind::kString && !rule_.names.empty() &&
        (node.text.empty() || node.text.find_first_of("0123456789") == std::string::npos)) {
      return read_name(node, given);
    }
    if (node.kind != Node::Kind::kNumber && node.kind != Node::Kind::kString) return expected(node, given);
    const Result<Written> written = split_quantity(node.text);
    if (!written) return report(node, given, written.error().message);
    const Result<Decimal> number = in_default_unit(*written, rule_.dimension);
    if (!number) return report(node, given, number.error().message);
    const double value = number->value();
    given.value = value;
    if (is_allowed(rule_, value)) return;

    std::string_view unit = written->unit.empty() ? default_unit(rule_.dimension) : written->unit;
    report(node, given,
           fmt::format("{}{}{} is outside {}{}", written->number.text(), unit.empty() ? "" : " ", unit, range_of(rule_),
                       suggestion(problems_, [&] { return did_you_mean(slip_of_the_pen(rule_, *written)); })));
  }

  void read_whole(const Node& node, Given& given) {
    if (node.kind != Node::Kind::kNumber && node.kind != Node::Kind::kString) return expected(node, given);
    const Result<Decimal> number = parse_decimal(node.text);
    if (!number) return report(node, given, number.error().message);
    if (!number->is_whole()) return report(node, given, fmt::format("{} is not a whole number", node.text));
    given.value = number->value();
    const std::optional<std::int64_t> exact = digits_at(*number, 0);
    constexpr std::int64_t kMostExact = std::int64_t{1} << 53;  // beyond, doubles are not the numbers themselves
    const bool is_rounded = !exact || *exact > kMostExact || *exact < -kMostExact;
    if (is_rounded || number->value() < rule_.low || number->value() > rule_.high) {
      report(node, given, fmt::format("{} is outside [{:.16g}, {:.16g}]", node.text, rule_.low, rule_.high));
    }
  }

  void read_side(const Node& node, Given& given) {
    read_whole(node, given);
    if (!given.ok || !rule_.only_even || std::fmod(std::get<double>(given.value), 2) == 0) return;
    report(node, given,
           fmt::format("{} is odd; video needs even numbers of pixels; did you mean {}?", node.text,
                       std::get<double>(given.value) + 1));
  }

  void read_name(const Node& node, Given& given) {
    if (node.kind != Node::Kind::kString) return expected(node, given);
    given.value = node.text;
    if (std::find(rule_.names.begin(), rule_.names.end(), node.text) != rule_.names.end()) return;
    const std::string allowed = rule_.form == Form::kQuantity
                                    ? fmt::format("neither {} nor {}", quoted(rule_.names), example_for(rule_))
                                    : fmt::format("not one of {}", quoted(rule_.names));
    report(node, given, fmt::format("\"{}\" is {}{}", node.text, allowed, suggestion(problems_, [&] {
                                      return did_you_mean(nearest(node.text, rule_.names));
                                    })));
  }

  void read_text(const Node& node, Given& given) {
    const bool is_number = rule_.may_look_like_number && node.kind == Node::Kind::kNumber;
    if (node.kind != Node::Kind::kString && !is_number) {
      const std::string text = rule_.expected.empty() ? "a text" : rule_.expected;
      return report(node, given, fmt::format("expected {}, not {}", text, describe(node)));
    }
    given.value = node.text;
    const bool fits =
        rule_.pattern.empty() || (node.text.size() <= rule_.longest && fits_pattern(node.text, rule_.pattern));
    if (!fits) return expected(node, given);
    if (const auto problem = rule_.problem ? rule_.problem(node.text) : std::nullopt) report(node, given, *problem);
  }

  template <class T>
  void read_list(const Node& node, Given& given, Part read_item) {
    if (node.kind != Node::Kind::kArray || (rule_.most > 0 && node.items.size() > rule_.most)) {
      return expected(node, given);
    }
    std::vector<T> list;
    for (const Node& item : node.items) {
      Given one{{}, item.place, true};
      (this->*read_item)(item, one);
      given.ok = given.ok && one.ok;
      if (one.ok) list.push_back(std::get<T>(std::move(one.value)));
    }
    given.value = std::move(list);
  }

  void read_pair(const Node& node, Given& given) { read_two(node, given, &ValueReader::read_quantity); }

  void read_two(const Node& node, Given& given, Part read_item) {
    if (node.kind != Node::Kind::kArray || node.items.size() != 2) return expected(node, given);
    std::array<double, 2> two{};
    for (std::size_t i = 0; i < 2; ++i) {
      Given one{{}, node.items[i].place, true};
      (this->*read_item)(node.items[i], one);
      given.ok = given.ok && one.ok;
      if (one.ok) two[i] = std::get<double>(one.value);
    }
    given.value = two;
  }

  const Rule& rule_;
  std::vector<Problem>& problems_;
};

}  // namespace

Given read_value(const Rule& rule, const Node& node, std::vector<Problem>& problems) {
  return ValueReader(rule, problems).read(node);
}

Given read_text(const Rule& rule, const std::string& text, std::vector<Problem>& problems) {
  Node node;
  node.kind = Node::Kind::kString;
  node.text = text;
  if (rule.form == Form::kPair || rule.form == Form::kSize) {
    const std::size_t at = text.find(rule.form == Form::kSize ? 'x' : ',');
    if (at == std::string::npos) {
      problems.push_back(problem_at({}, rule.path, fmt::format("expected {}, not \"{}\"", value_name(rule), text)));
      return {{}, {}, false};
    }
    Node pair;
    pair.kind = Node::Kind::kArray;
    for (const std::string& part : {text.substr(0, at), text.substr(at + 1)}) {
      node.text = part;
      pair.items.push_back(node);
    }
    node = std::move(pair);
  }
  return read_value(rule, node, problems);
}

bool is_allowed(const Rule& rule, double value) {
  return (value >= rule.low && value <= rule.high) || (rule.or_zero && value == 0);
}

std::string range_of(const Rule& rule) {
  return (rule.or_zero ? "0 or " : "") + format_range(rule.low, rule.high, rule.dimension);
}

std::string allowed(const Rule& rule) {
  std::string names;
  for (std::size_t i = 0; i < rule.names.size(); ++i) {
    const bool is_last = i + 1 == rule.names.size();
    names += fmt::format("{}`\"{}\"`", i == 0 ? "" : is_last ? " or " : ", ", rule.names[i]);
  }
  std::string whole = fmt::format("whole, {:.16g} to {:.16g}", rule.low, rule.high);
  switch (rule.form) {
    case Form::kQuantity:
      return names + (names.empty() ? "" : " or ") + range_of(rule);
    case Form::kWhole:
      return whole;
    case Form::kName:
      return names;
    case Form::kText:
      return rule.expected.empty() ? "text" : rule.expected;
    case Form::kTexts:
      return rule.names.empty() ? example_for(rule) : "a list of " + names;
    case Form::kPair:
      return "[a, b], " + range_of(rule) + " each";
    case Form::kSize:
      return fmt::format("[width, height], {}{} each", rule.only_even ? "even, " : "", whole);
    case Form::kSwitch:
      return "`true` or `false`";
    case Form::kNumbers:
      return "list of " + range_of(rule);
    case Form::kPairs:
      return "list of [a, b], " + range_of(rule) + " each";
    case Form::kBlock:
      return "object or `null`";
    case Form::kElsewhere:
      break;
  }
  return "";
}

std::string show(const Rule& rule, const Value& value) {
  if (const bool* on = std::get_if<bool>(&value)) return *on ? "on" : "off";
  if (const double* number = std::get_if<double>(&value)) return format_quantity(*number, rule.dimension);
  if (const std::string* name = std::get_if<std::string>(&value)) return fmt::format("\"{}\"", *name);
  if (const auto* size = std::get_if<std::array<double, 2>>(&value)) {
    return fmt::format("[{}, {}]", (*size)[0], (*size)[1]);
  }
  if (const auto* numbers = std::get_if<std::vector<double>>(&value)) {
    std::string text;
    for (const double number : *numbers)
      text += fmt::format("{}{}", text.empty() ? "" : ", ", format_quantity(number, rule.dimension));
    return "[" + text + "]";
  }
  if (const auto* pairs = std::get_if<std::vector<std::array<double, 2>>>(&value)) {
    std::string text;
    for (const auto& [a, b] : *pairs) text += fmt::format("{}[{}, {}]", text.empty() ? "" : ", ", a, b);
    return "[" + text + "]";
  }
  if (const auto* texts = std::get_if<std::vector<std::string>>(&value); texts != nullptr && !texts->empty()) {
    return fmt::format("[{}]", quoted(*texts));
  }
  return "none";
}

std::string value_name(const Rule& rule) {
  if (!rule.value_name.empty()) return rule.value_name;
  return rule.names.empty() ? "N" : fmt::format("{}", fmt::join(rule.names, "|"));
}

std::string fallback_of(const Rule& rule) {
  return rule.fallback_note.empty() ? show(rule, rule.fallback) : rule.fallback_note;
}

nlohmann::ordered_json to_json(const Rule& rule, const Value& value) {
  if (const double* number = std::get_if<double>(&value); number != nullptr && rule.form == Form::kWhole) {
    return static_cast<std::int64_t>(*number);
  }
  if (const auto* two = std::get_if<std::array<double, 2>>(&value); two != nullptr && rule.form == Form::kSize) {
    return {static_cast<int>((*two)[0]), static_cast<int>((*two)[1])};
  }
  return std::visit(
      [](const auto& plain) -> nlohmann::ordered_json {
        if constexpr (std::is_same_v<decltype(plain), const std::monostate&>)
          return nullptr;
        else
          return plain;
      },
      value);
}

}  // namespace shaken::keys
