#include "base/keys/units.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "base/keys/nearest.h"

namespace shaken::keys {

namespace {

// Of each dimension: the default unit first, then from large to small.
constexpr auto kUnits = std::to_array<Unit>({
    {"mm", Dimension::kLength, 1, 0, true},
    {"m", Dimension::kLength, 1, 3, false},
    {"cm", Dimension::kLength, 1, 1, false},
    {"um", Dimension::kLength, 1, -3, false},
    {"\u00b5m", Dimension::kLength, 1, -3, false},  // micro sign
    {"\u03bcm", Dimension::kLength, 1, -3, false},  // Greek mu
    {"s", Dimension::kTime, 1, 0, true},
    {"h", Dimension::kTime, 3600, 0, false},
    {"min", Dimension::kTime, 60, 0, false},
    {"ms", Dimension::kTime, 1, -3, true},
    {"us", Dimension::kTime, 1, -6, true},
    {"\u00b5s", Dimension::kTime, 1, -6, false},
    {"\u03bcs", Dimension::kTime, 1, -6, false},
    {"ns", Dimension::kTime, 1, -9, false},
    {"Hz", Dimension::kFrequency, 1, 0, true},
    {"kHz", Dimension::kFrequency, 1, 3, false},
    {"mm/s^2", Dimension::kAcceleration, 1, 0, false},
    {"m/s^2", Dimension::kAcceleration, 1, 3, true},
    {"cm/s^2", Dimension::kAcceleration, 1, 1, false},
    {"mg/mm^3", Dimension::kDensity, 1, 0, true},
    {"g/cm^3", Dimension::kDensity, 1, 0, false},
    {"kg/m^3", Dimension::kDensity, 1, -3, false},
});

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

/// The unit in which `value` reads best: the first shown one in which it is at least 1, else the smallest.
Unit unit_for(double value, Dimension dimension) {
  Unit best{"", dimension, 1, 0, true};
  for (const Unit& unit : units_of(dimension)) {
    if (!unit.shown) continue;
    best = unit;
    if (value == 0 || std::abs(value) >= unit.scale() * (1 - 1e-9)) break;
  }
  return best;
}

std::string with_unit(std::string number, std::string_view unit) {
  return unit.empty() ? number : fmt::format("{} {}", number, unit);
}

/// What is wrong with `rest`, which stands behind the number `number`, where people and word processors write numbers
/// in another way than here; empty if nothing is known.
std::string foreign_writing(std::string_view number, std::string_view rest) {
  struct Space {
    std::string_view bytes;
    const char* name;
  };
  static constexpr std::array kSpaces{
      Space{"\u00a0", "a no-break space (U+00A0)"}, Space{"\u2007", "a figure space (U+2007)"},
      Space{"\u2009", "a thin space (U+2009)"}, Space{"\u202f", "a narrow no-break space (U+202F)"},
      Space{"\u3000", "an ideographic space (U+3000)"}};
  for (const Space& space : kSpaces) {
    if (rest.find(space.bytes) != std::string_view::npos) {
      return fmt::format("there is {} in it; write a plain space, or none", space.name);
    }
  }
  if (rest.starts_with("\u2212")) return "its minus sign is that of typesetters (U+2212); write -";
  if (rest.size() > 1 && rest.front() == ',' && rest[1] >= '0' && rest[1] <= '9') {
    const std::size_t end = std::min(rest.find_first_not_of("0123456789", 1), rest.size());
    return fmt::format("a decimal comma; write {}.{}", number, rest.substr(1, end - 1));
  }
  return {};
}

}  // namespace

double Unit::scale() const { return Decimal{factor, power}.value(); }

std::span<const Unit> units() { return kUnits; }

std::vector<Unit> units_of(Dimension dimension) {
  std::vector<Unit> found;
  for (const Unit& unit : kUnits) {
    if (unit.dimension == dimension) found.push_back(unit);
  }
  return found;
}

std::string_view default_unit(Dimension dimension) {
  const std::vector<Unit> all = units_of(dimension);
  return all.empty() ? std::string_view{} : all.front().name;
}

std::string_view name_of(Dimension dimension) {
  constexpr std::array kNames{"plain number", "length", "time", "frequency", "acceleration", "density"};  // in order
  return kNames.at(static_cast<std::size_t>(dimension));
}

Result<Written> split_quantity(std::string_view text) {
  const std::string_view all = trimmed(text);
  // The number ends before the first character that cannot belong to it; an "e" belongs to it only before a digit.
  std::size_t end = 0;
  while (end < all.size()) {
    const char c = all[end];
    const bool exponent = (c == 'e' || c == 'E') && end > 0 && end + 1 < all.size() &&
                          all.find_first_of("0123456789", end + 1) <= end + 2;
    if (!exponent && std::string_view("0123456789+-.").find(c) == std::string_view::npos) break;
    ++end;
  }
  if (const std::string foreign = foreign_writing(all.substr(0, end), all.substr(end)); !foreign.empty()) {
    return Error{fmt::format("\"{}\": {}", text, foreign)};
  }
  if (end == 0) return Error{fmt::format("\"{}\" is not a number", text)};
  return Written{SHAKEN_TRY(parse_decimal(all.substr(0, end))), std::string(trimmed(all.substr(end)))};
}

Result<Decimal> in_default_unit(const Written& written, Dimension dimension) {
  if (written.unit.empty()) return written.number;
  for (const Unit& unit : kUnits) {
    if (unit.name != written.unit || unit.dimension != dimension) continue;
    if (const auto number = scaled(written.number, unit.factor, unit.power)) return *number;
    return Error{fmt::format("{} {} has too many digits", written.number.text(), written.unit)};
  }

  if (dimension == Dimension::kPlain) {
    return Error{fmt::format("\"{}\": a plain number takes no unit", written.unit)};
  }
  std::vector<std::string> names;
  for (const Unit& unit : units_of(dimension)) {
    if (static_cast<unsigned char>(unit.name.front()) < 0x80) names.emplace_back(unit.name);
  }
  for (const Unit& unit : kUnits) {
    if (unit.name == written.unit) {
      return Error{fmt::format("\"{}\" is a unit of {}, not of {}; use {}", written.unit, name_of(unit.dimension),
                               name_of(dimension), fmt::join(names, ", "))};
    }
  }
  return Error{fmt::format("\"{}\" is not a unit of {}; use {}{}", written.unit, name_of(dimension),
                           fmt::join(names, ", "), did_you_mean(nearest(written.unit, names)))};
}

Result<double> parse_quantity(std::string_view text, Dimension dimension) {
  const Written written = SHAKEN_TRY(split_quantity(text));
  return SHAKEN_TRY(in_default_unit(written, dimension)).value();
}

std::string format_quantity(double value, Dimension dimension) {
  const Unit unit = unit_for(value, dimension);
  return with_unit(fmt::format("{:.10g}", value / unit.scale()), unit.name);
}

std::string format_range(double low, double high, Dimension dimension) {
  const Unit unit = unit_for(high, dimension);
  return with_unit(fmt::format("[{:.10g}, {:.10g}]", low / unit.scale(), high / unit.scale()), unit.name);
}

}  // namespace shaken::keys
