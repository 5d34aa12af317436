#include "base/keys/decimal.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstdlib>

namespace shaken::keys {

namespace {

constexpr int kMaxDigits = 18;      // fit into std::int64_t
constexpr int kMaxMagnitude = 300;  // well inside the range of a double
// Sizes that are written without a power of ten: 0.000001 to 9999999999.
constexpr int kLeastPlainMagnitude = -6;
constexpr int kMostPlainMagnitude = 9;

bool is_digit(char c) { return c >= '0' && c <= '9'; }

}  // namespace

double Decimal::value() const {
  const std::string written = fmt::format("{}e{}", digits, exponent);
  double number = 0;
  std::from_chars(written.data(), written.data() + written.size(), number);
  return number;
}

std::string Decimal::text() const {
  const char* sign = digits < 0 ? "-" : "";
  const std::string all = fmt::format("{}", std::abs(digits));
  const int magnitude = static_cast<int>(all.size()) - 1 + exponent;  // of the first digit
  if (digits != 0 && (magnitude < kLeastPlainMagnitude || magnitude > kMostPlainMagnitude)) {
    return fmt::format("{}{}{}{}e{}", sign, all.substr(0, 1), all.size() > 1 ? "." : "", all.substr(1), magnitude);
  }
  if (exponent >= 0) return fmt::format("{}{}{:0<{}}", sign, all, "", exponent);
  const std::string padded = fmt::format("{:0>{}}", all, 1 - exponent);  // at least one digit before the point
  const std::size_t point = padded.size() - static_cast<std::size_t>(-exponent);
  return fmt::format("{}{}.{}", sign, padded.substr(0, point), padded.substr(point));
}

Decimal make_decimal(std::int64_t digits, int exponent) {
  if (digits == 0) return {};
  while (digits % 10 == 0) {
    digits /= 10;
    ++exponent;
  }
  return {digits, exponent};
}

Result<Decimal> parse_decimal(std::string_view text) {
  const Error not_a_number{fmt::format("\"{}\" is not a number", text)};
  std::size_t i = 0;
  const auto here = [&](auto accepts) { return i < text.size() && accepts(text[i]); };
  const auto is = [&](char wanted) { return here([wanted](char c) { return c == wanted; }); };

  const bool negative = is('-');
  if (is('-') || is('+')) ++i;

  // The digits, with leading and trailing zeros left out of the count.
  std::string significant;
  int exponent = 0;
  bool any = false;
  for (bool fraction = false; here(is_digit) || (is('.') && !fraction); ++i) {
    if (is('.')) {
      fraction = true;
      continue;
    }
    any = true;
    if (fraction && exponent > -2 * kMaxMagnitude) --exponent;
    if (!significant.empty() || text[i] != '0') significant += text[i];
  }
  if (!any) return not_a_number;

  if (is('e') || is('E')) {
    ++i;
    const bool minus = is('-');
    if (is('-') || is('+')) ++i;
    if (!here(is_digit)) return not_a_number;
    int power = 0;
    for (; here(is_digit); ++i) power = std::min(10 * power + (text[i] - '0'), 10 * kMaxMagnitude);
    exponent += minus ? -power : power;
  }
  if (i != text.size()) return not_a_number;

  while (!significant.empty() && significant.back() == '0') {
    significant.pop_back();
    ++exponent;
  }
  if (significant.empty()) return Decimal{};
  const int n_digits = static_cast<int>(significant.size());
  if (n_digits > kMaxDigits) return Error{fmt::format("{} has more than {} significant digits", text, kMaxDigits)};
  if (exponent + n_digits > kMaxMagnitude || exponent < -kMaxMagnitude) {
    return Error{fmt::format("{} is too {}", text, exponent > 0 ? "large" : "small")};
  }
  std::int64_t digits = 0;
  std::from_chars(significant.data(), significant.data() + significant.size(), digits);
  return Decimal{negative ? -digits : digits, exponent};
}

std::optional<Decimal> scaled(const Decimal& number, std::int64_t factor, int power) {
  std::int64_t digits = 0;
  if (__builtin_mul_overflow(number.digits, factor, &digits)) return std::nullopt;
  return make_decimal(digits, number.exponent + power);
}

std::optional<std::int64_t> digits_at(const Decimal& number, int exponent) {
  std::int64_t digits = number.digits;
  for (int e = number.exponent; e > exponent; --e) {
    if (__builtin_mul_overflow(digits, 10, &digits)) return std::nullopt;
  }
  return digits;
}

}  // namespace shaken::keys
