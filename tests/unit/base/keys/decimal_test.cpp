// SPDX-License-Identifier: MIT
#include "base/keys/decimal.h"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <cstdlib>

namespace shaken::keys {
namespace {

TEST(Decimal, KeepsDigitsWithoutTrailingZeros) {
  EXPECT_EQ(*parse_decimal("4.50"), (Decimal{45, -1}));
  EXPECT_EQ(*parse_decimal("-0.003"), (Decimal{-3, -3}));
  EXPECT_EQ(*parse_decimal("1200"), (Decimal{12, 2}));
  EXPECT_EQ(*parse_decimal("1.5e-6"), (Decimal{15, -7}));
  EXPECT_EQ(*parse_decimal(".5"), (Decimal{5, -1}));
  EXPECT_EQ(*parse_decimal("+7E2"), (Decimal{7, 2}));
  EXPECT_EQ(*parse_decimal("-0.0"), (Decimal{0, 0}));
  EXPECT_EQ(*parse_decimal("000.000000000000000000000000000001"), (Decimal{1, -30}));
}

TEST(Decimal, RefusesWhatIsNoNumber) {
  for (const char* text : {"", "-", ".", "e5", "1e", "1e+", "1.2.3", "nan", "inf", "0x10", "1 ", " 1", "1,5", "--1"}) {
    const auto number = parse_decimal(text);
    ASSERT_FALSE(number) << text;
    EXPECT_EQ(number.error().message, '"' + std::string(text) + "\" is not a number");
  }
}

TEST(Decimal, RefusesWhatDoesNotFit) {
  EXPECT_EQ(parse_decimal("1234567890123456789").error().message,
            "1234567890123456789 has more than 18 significant digits");
  EXPECT_EQ(parse_decimal("1e400").error().message, "1e400 is too large");
  EXPECT_EQ(parse_decimal("1e-400").error().message, "1e-400 is too small");
  EXPECT_EQ(parse_decimal("1e99999999999999999999").error().message, "1e99999999999999999999 is too large");
  EXPECT_EQ(parse_decimal("0." + std::string(5000, '0') + "1").error().message.substr(0, 4), "0.00");
}

TEST(Decimal, TextReadsAsPeopleWriteNumbers) {
  EXPECT_EQ(parse_decimal("4.50")->text(), "4.5");
  EXPECT_EQ(parse_decimal("1500")->text(), "1500");
  EXPECT_EQ(parse_decimal("-0.0003")->text(), "-0.0003");
  EXPECT_EQ(parse_decimal("0")->text(), "0");
  EXPECT_EQ(parse_decimal("9999999999")->text(), "9999999999");
  // many digits alone are no reason for a power of ten, and the point stands behind the first digit
  EXPECT_EQ(parse_decimal("0.1234567890123456")->text(), "0.1234567890123456");
  EXPECT_EQ(parse_decimal("5.454153912e-7")->text(), "5.454153912e-7");
  EXPECT_EQ(parse_decimal("-0.00003")->text(), "-0.00003");
  EXPECT_EQ(parse_decimal("4e-12")->text(), "4e-12");
  EXPECT_EQ(parse_decimal("12e15")->text(), "1.2e16");
}

TEST(Decimal, TextReadsBackAsTheSameNumber) {
  EXPECT_TRUE(rc::check("parse(text(d)) == d", [] {
    const auto digits = *rc::gen::inRange<std::int64_t>(-1'000'000'000'000'000'00, 1'000'000'000'000'000'00);
    const auto exponent = *rc::gen::inRange(-40, 40);
    const Decimal number = make_decimal(digits, exponent);
    RC_ASSERT(*parse_decimal(number.text()) == number);
  }));
}

TEST(Decimal, ValueIsTheNearestDouble) {
  EXPECT_TRUE(rc::check("value agrees with the C library's reading", [] {
    const auto digits = *rc::gen::inRange<std::int64_t>(0, 1'000'000'000'000'000);
    const auto exponent = *rc::gen::inRange(-30, 30);
    const std::string text = std::to_string(digits) + "e" + std::to_string(exponent);
    RC_ASSERT(parse_decimal(text)->value() == std::strtod(text.c_str(), nullptr));
  }));
}

TEST(Decimal, ScalesExactlyOrNotAtAll) {
  EXPECT_EQ(*scaled({45, -1}, 60, -3), (Decimal{27, -2}));
  EXPECT_EQ(*scaled({5, 0}, 1, 3), (Decimal{5, 3}));
  EXPECT_FALSE(scaled({999999999999999999, 0}, 3600, 0));
  EXPECT_EQ(*digits_at({5, 2}, -1), 5000);
  EXPECT_FALSE(digits_at({1, 30}, -1));
}

}  // namespace
}  // namespace shaken::keys
