#include "scene/keys/values.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "base/core/natural_log.h"
#include "base/keys/nearest.h"

namespace shaken::scene {
namespace {

/// A value in the unit of the range that it comes from.
Node value_node(const Decimal& number, const std::string& unit, const Place& place) {
  Node node;
  node.place = place;
  node.kind = unit.empty() ? Node::Kind::kNumber : Node::Kind::kString;
  node.text = unit.empty() ? number.text() : fmt::format("{} {}", number.text(), unit);
  return node;
}

/// from, from + step, ... up to `to`, in whole numbers of the smallest decimal place that occurs.
struct Steps {
  std::int64_t first = 0;
  std::int64_t step = 0;
  std::int64_t n = 0;
  int exponent = 0;
};
Result<Steps> count_up(const Decimal& from, const Decimal& to, const Decimal& step) {
  const int exponent = std::min({from.exponent, to.exponent, step.exponent});
  const auto a = digits_at(from, exponent);
  const auto b = digits_at(to, exponent);
  const auto s = digits_at(step, exponent);
  std::int64_t span = 0;
  if (!a || !b || !s || __builtin_sub_overflow(*b, *a, &span)) return Error{"the range has too many digits"};
  if (*s == 0) return Error{"the step of a range must not be 0"};
  if (span != 0 && (span > 0) != (*s > 0)) return Error{"the step leads away from the end of the range"};
  const std::int64_t last = span / *s;
  if (last >= kMaxPoints) {
    return Error{fmt::format("a range of {} values; at most {} are allowed", last + 1, kMaxPoints)};
  }
  return Steps{*a, *s, last + 1, exponent};
}

Decimal rounded(double value, int digits) { return parse_decimal(fmt::format("{:.{}g}", value, digits)).value(); }

/// The numbers of a range, brought to one unit: a number without a unit is in the unit of the last that has one.
struct Bounds {
  std::vector<Decimal> numbers;
  std::string unit;
  bool logarithmic = false;
};

Result<Bounds> read_bounds(const std::vector<std::string_view>& texts) {
  std::vector<Written> parts;
  Bounds bounds;
  for (const std::string_view text : texts) {
    const Written part = SHAKEN_TRY(split_quantity(text));
    if (!part.unit.empty()) bounds.unit = part.unit;
    parts.push_back(part);
  }
  for (const Written& part : parts) {
    if (!part.unit.empty() && part.unit != bounds.unit) {
      return Error{fmt::format("a range in {} and {}; write it in one unit", part.unit, bounds.unit)};
    }
    bounds.numbers.push_back(part.number);
  }
  return bounds;
}

/// Reads all that is written for one field.
class ValuesReader {
 public:
  ValuesReader(const Field& field, Room& room, std::vector<Problem>& problems)
      : field_(field), room_(room), problems_(problems) {}

  /// Adds what `node` stands for; false if there are too many values, which ends it.
  bool add(const Node& node) {
    if (node.kind == Node::Kind::kArray && depth_of(node) > depth_of_value()) {
      if (node.items.empty()) report(node, "no values to sweep over");
      return std::all_of(node.items.begin(), node.items.end(), [this](const Node& item) {
        const bool nested = item.kind == Node::Kind::kArray && depth_of_value() == 0;
        return nested ? add_one(item) : add(item);
      });
    }
    const bool is_number = field_.form == Form::kQuantity || field_.form == Form::kWhole;
    if (is_number && node.kind == Node::Kind::kString && node.text.find(':') != std::string::npos) return text(node);
    if (is_number && node.kind == Node::Kind::kObject) return object(node);
    return add_one(node);
  }

  std::vector<Node> take() { return std::move(values_); }

 private:
  /// How many arrays lie within each other.
  static int depth_of(const Node& node) {
    if (node.kind != Node::Kind::kArray) return 0;
    int deepest = 0;
    for (const Node& item : node.items) deepest = std::max(deepest, depth_of(item));
    return 1 + deepest;
  }

  /// The same, of a single value of this key: an array that is deeper holds several.
  int depth_of_value() const {
    switch (field_.form) {
      case Form::kSize:
      case Form::kNumbers:
        return 1;
      case Form::kPairs:
        return 2;
      default:
        return 0;
    }
  }

  void report(const Node& node, std::string message) {
    problems_.push_back(problem_at(node.place, field_.path, std::move(message)));
  }

  bool has_room(const Node& node, std::int64_t n) {
    const bool too_many_here = static_cast<std::int64_t>(values_.size()) + n > kMaxPoints;
    if (!too_many_here && n <= room_.left) {
      room_.left -= static_cast<int>(n);
      return true;
    }
    report(node, too_many_here ? fmt::format("more than {} values", kMaxPoints)
                               : fmt::format("the sweep has more than {} values", Room{}.left));
    values_.clear();
    return false;
  }

  bool add_one(const Node& node) {
    if (!has_room(node, 1)) return false;
    values_.push_back(node);
    return true;
  }

  bool text(const Node& node) {
    std::vector<std::string_view> parts;
    std::string_view rest = node.text;
    for (std::size_t colon; (colon = rest.find(':')) != std::string_view::npos; rest.remove_prefix(colon + 1)) {
      parts.push_back(rest.substr(0, colon));
    }
    parts.push_back(rest);
    if (parts.size() != 3) {
      report(node, fmt::format("\"{}\" is not a range; write from:to:step", node.text));
      return true;
    }
    const Result<Bounds> bounds = read_bounds(parts);
    if (bounds) return steps(node, *bounds);
    report(node, bounds.error().message);
    return true;
  }

  bool object(const Node& node) {
    const bool by_count = node.find("n") != nullptr;
    if (by_count && node.find("step")) {
      report(node, "a range takes \"step\" or \"n\", not both");
      return true;
    }
    const std::string last_key = by_count ? "n" : "step";
    const auto bounds = keys(node, {"from", "to", last_key}, by_count);
    if (!bounds) return true;
    if (!by_count) return steps(node, *bounds);

    const auto n = read_count(field_.path, node.find("n")->value, 1, kMaxPoints, problems_);
    if (!n) return true;
    if (!has_room(node, *n)) return false;
    const double from = bounds->numbers[0].value();
    const double to = bounds->numbers[1].value();
    for (int i = 0; i < *n; ++i) {
      // Twelve digits: even steps come out as the decimals that they are.
      const double value = i == 0                 ? from
                           : !bounds->logarithmic ? from + (to - from) * i / (*n - 1)
                           : i == *n - 1          ? to
                                                  : between_on_log_scale(from, to, static_cast<double>(i) / (*n - 1));
      values_.push_back(value_node(rounded(value, 12), bounds->unit, node.place));
    }
    return true;
  }

  bool steps(const Node& node, const Bounds& bounds) {
    const Result<Steps> range = count_up(bounds.numbers[0], bounds.numbers[1], bounds.numbers[2]);
    if (!range) {
      report(node, range.error().message);
      return true;
    }
    if (!has_room(node, range->n)) return false;
    for (std::int64_t i = 0; i < range->n; ++i) {
      const Decimal number = make_decimal(range->first + i * range->step, range->exponent);
      values_.push_back(value_node(number, bounds.unit, node.place));
    }
    return true;
  }

  /// The values of exactly these keys; "n" is left to the caller. There may be a "scale" too where it `can_scale`.
  std::optional<Bounds> keys(const Node& node, const std::vector<std::string>& wanted, bool can_scale) {
    std::vector<std::string_view> texts;
    bool ok = true;
    const auto fail = [&](const Place& place, std::string message) {
      problems_.push_back(problem_at(place, field_.path, std::move(message)));
      ok = false;
    };
    if (node.kind != Node::Kind::kObject) {
      fail(node.place, fmt::format("expected an object with \"from\" and \"to\", not {}", describe(node)));
      return std::nullopt;
    }
    std::vector<std::string> known = wanted;
    if (can_scale) known.emplace_back("scale");
    for (const Member& member : node.members) {
      if (std::find(known.begin(), known.end(), member.key) == known.end()) {
        const std::string meant = suggestion(problems_, [&] { return did_you_mean(nearest(member.key, known)); });
        fail(member.place, fmt::format("unknown key \"{}\" in a range{}", member.key, meant));
      }
    }
    for (const std::string& key : wanted) {
      const Member* member = node.find(key);
      if (!member) {
        fail(node.place, fmt::format("the range lacks \"{}\"", key));
      } else if (member->value.kind != Node::Kind::kNumber && member->value.kind != Node::Kind::kString) {
        fail(member->value.place, fmt::format("expected a number, not {}", describe(member->value)));
      } else if (key != "n") {
        texts.push_back(member->value.text);
      }
    }
    bool logarithmic = false;
    if (const Member* scale = can_scale ? node.find("scale") : nullptr) {
      const std::vector<std::string> scales{"linear", "log"};
      const bool is_text = scale->value.kind == Node::Kind::kString;
      logarithmic = is_text && scale->value.text == "log";
      if (!is_text || (!logarithmic && scale->value.text != "linear")) {
        fail(scale->value.place, fmt::format("\"scale\" is \"linear\" or \"log\", not {}{}", describe(scale->value),
                                             did_you_mean(nearest(scale->value.text, scales))));
      }
    }
    if (!ok) return std::nullopt;
    Result<Bounds> bounds = read_bounds(texts);
    if (!bounds) {
      fail(node.place, bounds.error().message);
      return std::nullopt;
    }
    bounds->logarithmic = logarithmic;
    if (logarithmic && !(bounds->numbers[0].digits > 0 && bounds->numbers[1].digits > 0)) {
      fail(node.place, "a range with \"scale\": \"log\" must lie above 0");
      return std::nullopt;
    }
    return *bounds;
  }

  const Field& field_;
  Room& room_;
  std::vector<Problem>& problems_;
  std::vector<Node> values_;
};

/// e^x; the same bits on every machine. Numerics: x = k ln 2 + r with |r| <= ln(2) / 2, and the series of e^r, of which
/// the first term left out is below 1e-17.
double exponential(double x) {
  constexpr double kLn2High = 0x1.62e42fefa38p-1;  // as in natural_log.h
  constexpr double kLn2Low = 0x1.ef35793c7673p-45;
  const double k = std::floor(x / kLn2High + 0.5);
  const double r = (x - k * kLn2High) - k * kLn2Low;
  double series = 1.0;
  for (int term = 14; term >= 1; --term) series = 1.0 + r / term * series;
  return std::ldexp(series, static_cast<int>(k));
}

}  // namespace

std::vector<Node> read_values(const Field& field, const Node& node, Room& room, std::vector<Problem>& problems) {
  ValuesReader reader(field, room, problems);
  reader.add(node);
  return reader.take();
}

std::optional<int> read_count(std::string_view path, const Node& node, int low, int high,
                              std::vector<Problem>& problems) {
  if (node.kind == Node::Kind::kNumber) {
    const Result<Decimal> number = parse_decimal(node.text);
    if (number && number->is_whole() && number->value() >= low && number->value() <= high) {
      return static_cast<int>(number->value());
    }
  }
  problems.push_back(problem_at(node.place, path,
                                fmt::format("expected a whole number in [{}, {}], not {}", low, high, describe(node))));
  return std::nullopt;
}

double between_on_log_scale(double from, double to, double share) {
  return from * exponential(share * natural_log(to / from));
}

}  // namespace shaken::scene
