#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <random>
#include <type_traits>
#include <vector>

#include "base/core/result.h"
#include "base/core/state_io.h"
#include "tests/support/good.h"

namespace shaken {
namespace {

Result<int> half_of(int n) {
  if (n % 2 != 0) return Error{"odd"};
  return n / 2;
}

Result<void> must_be_even(int n) {
  if (n % 2 != 0) return Error{"odd"};
  return {};
}

TEST(Result, IsAValueOrTheReasonWhyThereIsNone) {
  const Result<int> good = half_of(6), bad = half_of(7);
  ASSERT_TRUE(good);
  EXPECT_EQ(*good, 3);
  EXPECT_THROW(good.error(), std::bad_variant_access);
  ASSERT_FALSE(bad);
  EXPECT_EQ(bad.error().message, "odd");
  EXPECT_THROW(bad.value(), std::bad_variant_access);
}

TEST(Result, AValueThatCannotBeCopiedCanBeTakenOut) {
  Result<std::unique_ptr<int>> made = std::make_unique<int>(5);
  const std::unique_ptr<int> taken = std::move(made).value();
  EXPECT_EQ(*taken, 5);
}

TEST(Result, MayHaveSeveralReasons) {
  const Result<int, std::vector<Error>> bad = std::vector<Error>{{"one"}, {"two"}};
  ASSERT_FALSE(bad);
  EXPECT_EQ(bad.error().size(), 2U);
}

// True means the same for all of them. That of std::optional<Error> would be the opposite, and nothing warns of `if`.
TEST(ResultOfNothing, IsTrueOnSuccess) {
  EXPECT_TRUE(Result<void>());
  EXPECT_TRUE(must_be_even(6));
  EXPECT_THROW(must_be_even(6).error(), std::bad_optional_access);
  EXPECT_EQ(test::refusal(must_be_even(7)), "odd");
}

TEST(ResultOfNothing, AFailureIsPassedOnAsOneOfAnyType) {
  const auto third_of_even = [](int n) -> Result<double> {
    if (auto done = must_be_even(n); !done) return done.error();
    return n / 3.0;
  };
  const auto both_even = [](int a, int b) -> Result<void> {
    if (auto done = must_be_even(a); !done) return done;
    return must_be_even(b);
  };
  EXPECT_EQ(*third_of_even(6), 2);
  EXPECT_EQ(third_of_even(7).error().message, "odd");
  EXPECT_TRUE(both_even(2, 4));
  EXPECT_FALSE(both_even(1, 4));
  EXPECT_FALSE(both_even(2, 3));
}

TEST(ResultOfNothing, IsNoNumberAndNoFlag) {
  EXPECT_FALSE((std::is_convertible_v<Result<void>, bool>));
  EXPECT_FALSE((std::is_convertible_v<bool, Result<void>>));
}

TEST(StateIo, ReadsBackWhatWasWrittenExactly) {
  std::mt19937_64 random(1);
  for (int i = 0; i < 100; ++i) {
    const double real = std::ldexp(static_cast<double>(random()), static_cast<int>(random() % 2000) - 1000);
    const auto integer = static_cast<std::int64_t>(random());
    std::vector<double> reals(random() % 4);
    for (double& value : reals) value = -1.0 / static_cast<double>(random());
    std::vector<std::int64_t> integers(random() % 4);
    for (std::int64_t& value : integers) value = static_cast<std::int64_t>(random());
    StateWriter writer;
    writer.tag("Thing");
    writer.put(real);
    writer.put(reals);
    writer.put(integer);
    writer.put(integers);
    StateReader reader(writer.bytes());
    reader.tag("Thing");
    EXPECT_EQ(reader.real(), real);
    EXPECT_EQ(reader.reals(), reals);
    EXPECT_EQ(reader.integer(), integer);
    EXPECT_EQ(reader.integers(integers.size()), integers);
    reader.end();
  }
}

TEST(StateIo, EveryNumberHasItsOwnWidthAndBytesComeBack) {
  StateWriter inner;
  inner.put(Vec3(1.5, -2, 0.25));
  StateWriter writer;
  writer.put(std::uint8_t{200});
  writer.put(std::int32_t{-7});
  writer.put(std::uint32_t{4000000000});
  writer.put(inner.bytes());
  writer.append(inner.bytes());
  EXPECT_EQ(writer.bytes().size(), 1 + 4 + 4 + (8 + 24) + 24);
  StateReader reader(writer.bytes());
  std::uint8_t small = 0;
  std::int32_t negative = 0;
  std::uint32_t large = 0;
  Vec3 vector = Vec3::Zero();
  reader.get(small);
  reader.get(negative);
  reader.get(large);
  EXPECT_EQ(small, 200);
  EXPECT_EQ(negative, -7);
  EXPECT_EQ(large, 4000000000);
  EXPECT_TRUE(std::ranges::equal(reader.bytes(), inner.bytes()));
  reader.get(vector);
  EXPECT_EQ(vector, Vec3(1.5, -2, 0.25));
  EXPECT_THROW(reader.bytes(1), StateError);
  reader.end();
}

TEST(StateIo, KeepsEveryBitOfADouble) {
  StateWriter writer;
  for (const double value :
       {-0.0, std::numeric_limits<double>::denorm_min(), std::numeric_limits<double>::infinity()}) {
    writer.put(value);
  }
  writer.put(std::numeric_limits<double>::quiet_NaN());
  StateReader reader(writer.bytes());
  EXPECT_TRUE(std::signbit(reader.real()));
  EXPECT_EQ(reader.real(), std::numeric_limits<double>::denorm_min());
  EXPECT_TRUE(std::isinf(reader.real()));
  EXPECT_TRUE(std::isnan(reader.real()));
}

TEST(StateIo, EveryTruncationIsFound) {
  StateWriter writer;
  writer.tag("Thing");
  writer.put(1.5);
  writer.put(std::vector<double>{1, 2});
  writer.put(std::vector<std::int64_t>{3});
  for (std::size_t size = 0; size < writer.bytes().size(); ++size) {
    StateReader reader(std::span(writer.bytes()).first(size));
    const auto read_all = [&] {
      reader.tag("Thing");
      reader.real();
      reader.reals();
      reader.integers();
    };
    EXPECT_THROW(read_all(), StateError) << size;
  }
}

TEST(StateIo, LengthsAreNotTrusted) {
  for (const std::int64_t length : {std::int64_t{-1}, std::int64_t{2}, std::numeric_limits<std::int64_t>::max(),
                                    std::numeric_limits<std::int64_t>::min()}) {
    StateWriter writer;
    writer.put(length);
    writer.put(1.0);
    StateReader reader(writer.bytes());
    EXPECT_THROW(reader.reals(), StateError) << length;
  }
}

TEST(StateIo, RefusesWhatDoesNotFit) {
  StateWriter writer;
  writer.tag("Thing");
  writer.put(std::int64_t{5});
  writer.put(std::vector<double>{1, 2});
  StateReader other(writer.bytes());
  EXPECT_THROW(other.tag("Think"), StateError);
  StateReader range(writer.bytes());
  range.tag("Thing");
  EXPECT_THROW(range.integer(0, 4), StateError);
  EXPECT_THROW(range.reals(3), StateError);
  StateReader left_over(writer.bytes());
  left_over.tag("Thing");
  EXPECT_THROW(left_over.end(), StateError);
}

}  // namespace
}  // namespace shaken
