// SPDX-License-Identifier: MIT
#include "analysis/state_io.h"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <cmath>
#include <limits>

namespace shaken::analysis {
namespace {

TEST(StateIo, ReadsBackWhatWasWrittenExactly) {
  EXPECT_TRUE(rc::check("round trip", [](double real, std::int64_t integer, std::vector<double> reals,
                                         std::vector<std::int64_t> integers) {
    StateWriter writer;
    writer.tag("Thing");
    writer.put(real);
    writer.put(reals);
    writer.put(integer);
    writer.put(integers);
    StateReader reader(writer.bytes());
    reader.tag("Thing");
    RC_ASSERT(reader.real() == real);
    RC_ASSERT(reader.reals() == reals);
    RC_ASSERT(reader.integer() == integer);
    RC_ASSERT(reader.integers(integers.size()) == integers);
    reader.end();
  }));
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
}  // namespace shaken::analysis
