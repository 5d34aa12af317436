// SPDX-License-Identifier: MIT
#include "run/files/observables_file.h"

#include <gtest/gtest.h>

#include <cmath>

#include "run/files/atomic_file.h"
#include "tests/unit/run/temporary_folder.h"

namespace shaken::run {
namespace {

TEST(ObservablesFile, KeepsEveryNumberExactly) {
  const TemporaryFolder folder;
  const Observables written{{"/order/time_s", {0, 0.01, 1.0 / 3.0}},
                            {"/order/order", {1e-300, -0.0, 0.1}},
                            {"/defects/n_plus", {}},
                            {"/defects/list/x_mm", {83.73}}};
  ASSERT_FALSE(write_observables(folder / "observables.h5", written));
  const auto read = read_observables(folder / "observables.h5");
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(*read, written);
}

TEST(ObservablesFile, NotANumberComesBack) {
  const TemporaryFolder folder;
  ASSERT_FALSE(write_observables(folder / "observables.h5", {{"/tilt/v_along_mm_s", {std::nan("")}}}));
  const auto read = read_observables(folder / "observables.h5");
  ASSERT_TRUE(read);
  EXPECT_TRUE(std::isnan(read->at("/tilt/v_along_mm_s").at(0)));
}

TEST(ObservablesFile, ReplacesAnEarlierOne) {
  const TemporaryFolder folder;
  ASSERT_FALSE(write_observables(folder / "observables.h5", {{"/a/x", {1, 2, 3}}}));
  ASSERT_FALSE(write_observables(folder / "observables.h5", {{"/b/y", {4}}}));
  EXPECT_EQ(*read_observables(folder / "observables.h5"), (Observables{{"/b/y", {4}}}));
}

TEST(ObservablesFile, ErrorsNameTheFile) {
  const TemporaryFolder folder;
  const auto missing = read_observables(folder / "observables.h5");
  ASSERT_FALSE(missing);
  EXPECT_NE(missing.error().message.find("observables.h5"), std::string::npos) << missing.error().message;
  ASSERT_FALSE(write_file_atomically(folder / "observables.h5", "not HDF5"));
  EXPECT_FALSE(read_observables(folder / "observables.h5"));
  const auto unwritable = write_observables(folder / "no" / "observables.h5", {});
  ASSERT_TRUE(unwritable);
  EXPECT_NE(unwritable->message.find("no/observables.h5"), std::string::npos) << unwritable->message;
}

TEST(ObservablesFile, FullDiskIsReported) {
  const TemporaryFolder folder;
  EXPECT_EQ(
      in_child([&] {
        limit_file_size(2000);
        return write_observables(folder / "observables.h5", {{"/x", std::vector<double>(10000, 1.5)}}).has_value();
      }),
      0);
  EXPECT_FALSE(std::filesystem::exists(folder / "observables.h5"));
}

}  // namespace
}  // namespace shaken::run
