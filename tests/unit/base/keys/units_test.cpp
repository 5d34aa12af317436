#include "base/keys/units.h"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <cstdlib>

#include "base/keys/decimal.h"
#include "tests/support/good.h"

namespace shaken::keys {
namespace {

double length(std::string_view text) { return parse_quantity(text, Dimension::kLength).value(); }
double time(std::string_view text) { return parse_quantity(text, Dimension::kTime).value(); }

TEST(Units, NumbersAreInTheDefaultUnit) {
  EXPECT_EQ(length("4.5"), 4.5);
  EXPECT_EQ(time("4e-6"), 4e-6);
  EXPECT_EQ(parse_quantity("0.75", Dimension::kPlain).value(), 0.75);
}

// Every one is the double nearest to the decimal number: what a careless multiplication misses by a bit.
TEST(Units, ConversionsAreExact) {
  EXPECT_EQ(length("4.5 mm"), 4.5);
  EXPECT_EQ(length("450um"), 0.45);
  EXPECT_EQ(length("43.5 \u00b5m"), 0.0435);
  EXPECT_EQ(length("43.5 \u03bcm"), 0.0435);
  EXPECT_EQ(length("8.373 cm"), 83.73);
  EXPECT_EQ(length("0.08373 m"), 83.73);
  EXPECT_EQ(time("4 us"), 4e-6);
  EXPECT_EQ(time("3.3us"), 3.3e-6);
  EXPECT_EQ(time("4000ns"), 4e-6);
  EXPECT_EQ(time("  12 ms "), 0.012);
  EXPECT_EQ(time("0.1 min"), 6.0);
  EXPECT_EQ(time("1.1h"), 3960.0);
  EXPECT_EQ(parse_quantity("0.2kHz", Dimension::kFrequency).value(), 200.0);
  EXPECT_EQ(parse_quantity("9.81 m/s^2", Dimension::kAcceleration).value(), 9810.0);
  EXPECT_EQ(parse_quantity("981 cm/s^2", Dimension::kAcceleration).value(), 9810.0);
  EXPECT_EQ(parse_quantity("8.5 g/cm^3", Dimension::kDensity).value(), 8.5);
  EXPECT_EQ(parse_quantity("8500 kg/m^3", Dimension::kDensity).value(), 8.5);
  EXPECT_EQ(length("1e-3m"), 1.0);
  EXPECT_EQ(length("1E2 um"), 0.1);
}

TEST(Units, WrongUnitsAreNamed) {
  const auto message = [](std::string_view text, Dimension dimension) {
    return parse_quantity(text, dimension).error().message;
  };
  EXPECT_EQ(message("4 us", Dimension::kLength), "\"us\" is a unit of time, not of length; use mm, m, cm, um");
  EXPECT_EQ(message("4 uss", Dimension::kTime),
            "\"uss\" is not a unit of time; use s, h, min, ms, us, ns; did you mean us?");
  EXPECT_EQ(message("4 furlong", Dimension::kTime), "\"furlong\" is not a unit of time; use s, h, min, ms, us, ns");
  EXPECT_EQ(message("7 mm", Dimension::kPlain), "\"mm\": a plain number takes no unit");
  EXPECT_EQ(message("mm", Dimension::kLength), "\"mm\" is not a number");
  EXPECT_EQ(message("", Dimension::kLength), "\"\" is not a number");
  EXPECT_EQ(message("4.5.1 mm", Dimension::kLength), "\"4.5.1\" is not a number");
  EXPECT_EQ(message("nan mm", Dimension::kLength), "\"nan mm\" is not a number");
  EXPECT_EQ(message("4,5 mm", Dimension::kLength), "\"4,5 mm\": a decimal comma; write 4.5");
  EXPECT_EQ(message("4, 5 mm", Dimension::kLength), "\", 5 mm\" is not a unit of length; use mm, m, cm, um");
  EXPECT_EQ(message("4.5\u00a0mm", Dimension::kLength),
            "\"4.5\u00a0mm\": there is a no-break space (U+00A0) in it; write a plain space, or none");
  EXPECT_EQ(message("\u00a04.5 mm", Dimension::kLength),
            "\"\u00a04.5 mm\": there is a no-break space (U+00A0) in it; write a plain space, or none");
  EXPECT_EQ(message("4.5\u202fmm", Dimension::kLength),
            "\"4.5\u202fmm\": there is a narrow no-break space (U+202F) in it; write a plain space, or none");
  EXPECT_EQ(message("\u22124.5 mm", Dimension::kLength),
            "\"\u22124.5 mm\": its minus sign is that of typesetters (U+2212); write -");
}

TEST(Units, AreShownInTheUnitThatReadsBest) {
  EXPECT_EQ(format_quantity(4.5, Dimension::kLength), "4.5 mm");
  EXPECT_EQ(format_quantity(0.4, Dimension::kLength), "0.4 mm");
  EXPECT_EQ(format_quantity(4e-6, Dimension::kTime), "4 us");
  EXPECT_EQ(format_quantity(0.01, Dimension::kTime), "10 ms");
  EXPECT_EQ(format_quantity(0.001, Dimension::kTime), "1 ms");
  EXPECT_EQ(format_quantity(0, Dimension::kTime), "0 s");
  EXPECT_EQ(format_quantity(6000, Dimension::kTime), "6000 s");
  EXPECT_EQ(format_quantity(9810, Dimension::kAcceleration), "9.81 m/s^2");
  EXPECT_EQ(format_quantity(0.75, Dimension::kPlain), "0.75");
  EXPECT_EQ(format_range(1e-7, 1e-4, Dimension::kTime), "[0.1, 100] us");
  EXPECT_EQ(format_range(0.5, 50, Dimension::kLength), "[0.5, 50] mm");
}

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
    EXPECT_EQ(test::refusal(parse_decimal(text)), '"' + std::string(text) + "\" is not a number") << text;
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
