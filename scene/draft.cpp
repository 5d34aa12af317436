// SPDX-License-Identifier: MIT
#include "scene/draft.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/core/check.h"
#include "scene/nearest.h"

namespace shaken::scene {

namespace {

std::string quoted(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += fmt::format("{}\"{}\"", text.empty() ? "" : ", ", name);
  return text;
}

bool is_run_id(std::string_view text) {
  return text.size() == 16 && text.find_first_not_of("0123456789abcdef") == std::string_view::npos;
}

/// A value like the one written that would be allowed: the same digits with another unit or with the point moved.
/// Of several the one nearest to the default.
std::string slip_of_the_pen(const Field& field, const Written& written) {
  const double* usual = std::get_if<double>(&field.fallback);
  if (!usual || *usual <= 0 || written.number.digits <= 0) return {};
  const auto written_value = in_default_unit(written, field.dimension);
  if (!written_value) return {};
  std::string best;
  double least = std::abs(std::log(written_value->value() / *usual));
  const auto consider = [&](const Written& candidate) {
    const Result<Decimal> number = in_default_unit(candidate, field.dimension);
    if (!number || !is_allowed(field, number->value())) return;
    const double distance = std::abs(std::log(number->value() / *usual));
    if (distance >= least) return;
    const std::string_view unit = candidate.unit.empty() ? default_unit(field.dimension) : candidate.unit;
    best = fmt::format("{}{}{}", candidate.number.text(), unit.empty() ? "" : " ", unit);
    least = distance;
  };
  for (const Unit& unit : units_of(field.dimension)) {
    if (static_cast<unsigned char>(unit.name.front()) < 0x80) consider({written.number, std::string(unit.name)});
  }
  for (int power = -3; power <= 3; ++power) consider({*scaled(written.number, 1, power), written.unit});
  return best;
}

std::string example_for(const Field& field) {
  switch (field.form) {
    case Form::kQuantity:
      return field.dimension == Dimension::kPlain
                 ? "a number"
                 : fmt::format("a number in {} or a text with a unit", default_unit(field.dimension));
    case Form::kWhole:
      return "a whole number";
    case Form::kName:
      return "one of " + quoted(field.names);
    case Form::kRunId:
      return "the id of a run, 16 hex digits";
    case Form::kSize:
      return "[width, height]";
    case Form::kSwitch:
      return "true or false";
    case Form::kNumbers:
      return fmt::format("a list of numbers in {} or of texts with a unit", default_unit(field.dimension));
    case Form::kBlock:
      return "an object, null or false";
  }
  return "";
}

/// Reads one value for one field; a value with a problem is not ok.
class ValueReader {
 public:
  ValueReader(const Field& field, std::vector<Problem>& problems) : field_(field), problems_(problems) {}

  Given read(const Node& node) {
    Given given{{}, node.place, true};
    switch (field_.form) {
      case Form::kQuantity:
        read_quantity(node, given);
        break;
      case Form::kWhole:
        read_whole(node, given);
        break;
      case Form::kName:
        read_name(node, given);
        break;
      case Form::kRunId:
        // an id may look like a number
        if ((node.kind != Node::Kind::kString && node.kind != Node::Kind::kNumber) || !is_run_id(node.text)) {
          expected(node, given);
        } else {
          given.value = node.text;
        }
        break;
      case Form::kSize:
        read_size(node, given);
        break;
      case Form::kSwitch:
        if (node.kind != Node::Kind::kBoolean) {
          expected(node, given);
        } else {
          given.value = node.boolean;
        }
        break;
      case Form::kNumbers:
        read_numbers(node, given);
        break;
      case Form::kBlock:
        SHAKEN_CHECK(false, "blocks are the draft's business");
        break;
    }
    return given;
  }

 private:
  void report(const Node& node, Given& given, std::string message) {
    problems_.push_back(problem_at(node.place, field_.path, std::move(message)));
    given.ok = false;
  }

  void expected(const Node& node, Given& given) {
    report(node, given, fmt::format("expected {}, not {}", example_for(field_), describe(node)));
  }

  void read_quantity(const Node& node, Given& given) {
    if (node.kind == Node::Kind::kString && !field_.names.empty() &&
        (node.text.empty() || node.text.find_first_of("0123456789") == std::string::npos)) {
      return read_name(node, given);
    }
    if (node.kind != Node::Kind::kNumber && node.kind != Node::Kind::kString) return expected(node, given);
    const Result<Written> written = split_quantity(node.text);
    if (!written) return report(node, given, written.error().message);
    const Result<Decimal> number = in_default_unit(*written, field_.dimension);
    if (!number) return report(node, given, number.error().message);
    const double value = number->value();
    given.value = value;
    if (is_allowed(field_, value)) return;

    std::string_view unit = written->unit.empty() ? default_unit(field_.dimension) : written->unit;
    report(
        node, given,
        fmt::format("{}{}{} is outside {}{}", written->number.text(), unit.empty() ? "" : " ", unit, range_of(field_),
                    suggestion(problems_, [&] { return did_you_mean(slip_of_the_pen(field_, *written)); })));
  }

  void read_numbers(const Node& node, Given& given) {
    if (node.kind != Node::Kind::kArray || node.items.empty()) return expected(node, given);
    std::vector<double> numbers;
    for (const Node& item : node.items) {
      Given one{{}, item.place, true};
      read_quantity(item, one);
      given.ok = given.ok && one.ok;
      if (one.ok) numbers.push_back(std::get<double>(one.value));
    }
    given.value = std::move(numbers);
  }

  void read_whole(const Node& node, Given& given) {
    if (node.kind != Node::Kind::kNumber && node.kind != Node::Kind::kString) return expected(node, given);
    const Result<Decimal> number = parse_decimal(node.text);
    if (!number) return report(node, given, number.error().message);
    if (!number->is_whole()) return report(node, given, fmt::format("{} is not a whole number", node.text));
    given.value = number->value();
    if (number->value() < field_.low || number->value() > field_.high) {
      report(node, given, fmt::format("{} is outside [{:.16g}, {:.16g}]", node.text, field_.low, field_.high));
    }
  }

  void read_name(const Node& node, Given& given) {
    if (node.kind != Node::Kind::kString) return expected(node, given);
    given.value = node.text;
    if (std::find(field_.names.begin(), field_.names.end(), node.text) != field_.names.end()) return;
    const std::string allowed = field_.form == Form::kQuantity
                                    ? fmt::format("neither {} nor {}", quoted(field_.names), example_for(field_))
                                    : fmt::format("not one of {}", quoted(field_.names));
    report(node, given, fmt::format("\"{}\" is {}{}", node.text, allowed, suggestion(problems_, [&] {
                                      return did_you_mean(nearest(node.text, field_.names));
                                    })));
  }

  void read_size(const Node& node, Given& given) {
    if (node.kind != Node::Kind::kArray || node.items.size() != 2) return expected(node, given);
    std::array<double, 2> size{};
    for (std::size_t i = 0; i < 2; ++i) {
      const Node& item = node.items[i];
      Given side{{}, item.place, true};
      read_whole(item, side);
      given.ok = given.ok && side.ok;
      if (!side.ok) continue;
      size[i] = std::get<double>(side.value);
      if (std::fmod(size[i], 2) != 0) {
        report(item, given,
               fmt::format("{} is odd; video needs even numbers of pixels; did you mean {}?", item.text, size[i] + 1));
      }
    }
    given.value = size;
  }

  const Field& field_;
  std::vector<Problem>& problems_;
};

}  // namespace

Draft::Draft(Place place) : place_(std::move(place)), given_(fields().size()) {}

void Draft::read(const Node& scene, std::vector<Problem>& problems) {
  if (scene.kind != Node::Kind::kObject) {
    problems.push_back(problem_at(scene.place, {}, fmt::format("expected an object, not {}", describe(scene))));
    return;
  }
  read_members({}, scene, problems);
}

void Draft::read_members(std::string_view path, const Node& object, std::vector<Problem>& problems) {
  for (const Member& member : object.members) {
    if (path.empty() && is_link_to_schema(member, problems)) continue;
    const std::string inner = path.empty() ? member.key : fmt::format("{}.{}", path, member.key);
    // A dot in a key would be taken for a step into an object.
    if (member.key.empty() || member.key.find('.') != std::string::npos) {
      problems.push_back(problem_at(
          member.place, inner,
          fmt::format("unknown key \"{}\"{}", member.key, field_index(inner) < 0 ? "" : "; use objects in objects")));
      continue;
    }
    assign(inner, member.place, member.value, problems);
  }
}

void Draft::assign(std::string_view path, const Place& key, const Node& node, std::vector<Problem>& problems) {
  const int found = field_index(path);
  if (found < 0 && !is_group(path)) {
    problems.push_back(problem_at(key, path, "unknown key" + suggestion(problems, [&] { return suggest_path(path); })));
    return;
  }
  const bool is_leaf = found >= 0 && fields()[static_cast<std::size_t>(found)].form != Form::kBlock;
  if (is_leaf) {
    auto& slot = given_[static_cast<std::size_t>(found)];
    if (node.kind == Node::Kind::kNull) {
      slot.reset();
      return;
    }
    slot = ValueReader(fields()[static_cast<std::size_t>(found)], problems).read(node);
    const std::string_view block = block_around(path);
    if (!is_on(block)) given_[static_cast<std::size_t>(field_index(block))] = Given{true, key, true};
    return;
  }

  clear_beneath(path);
  const bool is_object = node.kind == Node::Kind::kObject;
  if (found >= 0) {
    const bool on = is_object || (node.kind == Node::Kind::kBoolean && node.boolean);
    given_[static_cast<std::size_t>(found)] = Given{on, node.place, true};
  }
  const bool may_be_boolean = found >= 0 && node.kind == Node::Kind::kBoolean;
  if (is_object) {
    read_members(path, node, problems);
  } else if (node.kind != Node::Kind::kNull && !may_be_boolean) {
    problems.push_back(problem_at(node.place, path, fmt::format("expected an object, not {}", describe(node))));
  }
}

void Draft::clear_beneath(std::string_view path) {
  for (std::size_t i = 0; i < fields().size(); ++i) {
    if (!is_beneath(fields()[i].path, path)) continue;
    given_[i].reset();
    if (fields()[i].form == Form::kBlock) given_[i] = Given{false, place_, true};
  }
}

const Given* Draft::find(std::size_t field) const { return given_[field] ? &*given_[field] : nullptr; }

const Given* Draft::find(std::string_view path) const {
  const int index = field_index(path);
  SHAKEN_CHECK(index >= 0, std::string(path));
  return find(static_cast<std::size_t>(index));
}

bool Draft::is_ok(std::string_view path) const {
  const Given* given = find(path);
  return !given || given->ok;
}

bool Draft::is_on(std::string_view block) const {
  if (block.empty()) return true;
  const Given* given = find(block);
  return std::get<bool>(given ? given->value : field_at(block).fallback);
}

}  // namespace shaken::scene
