#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/core/result.h"
#include "base/keys/decimal.h"

namespace shaken::keys {

/// What a number measures. A number without a unit is in the default unit, which is also the one used inside.
enum class Dimension {
  kPlain,
  kLength,        ///< mm
  kTime,          ///< s
  kFrequency,     ///< Hz
  kAcceleration,  ///< mm/s^2
  kDensity,       ///< mg/mm^3
};

/// One unit: 1 of it is factor * 10^power default units.
struct Unit {
  std::string_view name;
  Dimension dimension;
  std::int64_t factor;
  int power;
  bool shown;  ///< used when we write a quantity for people

  double scale() const;
};

/// Every unit known.
std::span<const Unit> units();
/// The units of one dimension, the default unit first; empty for plain numbers.
std::vector<Unit> units_of(Dimension dimension);
/// "mm"; empty for plain numbers.
std::string_view default_unit(Dimension dimension);
/// "length"
std::string_view name_of(Dimension dimension);

/// A number and the name of its unit as written; `unit` is empty if none was.
struct Written {
  Decimal number;
  std::string unit;
};

/// Splits "4.5 mm" or "4.5mm".
Result<Written> split_quantity(std::string_view text);
/// In default units, exactly; fails if the unit is not one of this dimension.
Result<Decimal> in_default_unit(const Written& written, Dimension dimension);
/// Both at once: "4 us" as a time is 4e-6.
Result<double> parse_quantity(std::string_view text, Dimension dimension);

/// For people: "4.5 mm", "4 us", "0.75".
std::string format_quantity(double value, Dimension dimension);
/// For people: "[0.1, 100] us".
std::string format_range(double low, double high, Dimension dimension);

}  // namespace shaken::keys
