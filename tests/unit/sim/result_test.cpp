#include "base/core/result.h"

#include <gtest/gtest.h>

#include <memory>
#include <type_traits>
#include <vector>

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
  const Result<void> bad = must_be_even(7);
  ASSERT_FALSE(bad);
  EXPECT_EQ(bad.error().message, "odd");
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

}  // namespace
}  // namespace shaken
