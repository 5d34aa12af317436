#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "base/core/result.h"

namespace shaken::keys {

/// A decimal number exactly as written, digits * 10^exponent, so that changing its unit or counting through a range
/// never leaves a trail of rounding: 0.45 + 8 * 0.05 is 0.85, and 4 us is the double nearest to 0.000004.
struct Decimal {
  std::int64_t digits = 0;  ///< signed, without trailing zeros
  int exponent = 0;         ///< 0 for the number zero

  /// The nearest double.
  double value() const;
  /// For people: "0.45", "1500"; very small and large numbers with a power of ten, "5.4e-7".
  std::string text() const;
  bool is_whole() const { return exponent >= 0; }

  friend bool operator==(const Decimal&, const Decimal&) = default;
};

/// Reads "4.5", "-0.3", "1e-3", ".5"; at most 18 significant digits, size between 1e-300 and 1e300.
Result<Decimal> parse_decimal(std::string_view text);

/// digits * 10^exponent with trailing zeros moved into the exponent.
Decimal make_decimal(std::int64_t digits, int exponent);

/// number * factor * 10^power; none if that has more digits than fit.
std::optional<Decimal> scaled(const Decimal& number, std::int64_t factor, int power);

/// The digits of `number` when written with `exponent` (<= its own); none if they do not fit.
std::optional<std::int64_t> digits_at(const Decimal& number, int exponent);

}  // namespace shaken::keys
