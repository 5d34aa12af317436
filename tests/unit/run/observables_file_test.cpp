#include "run/files/observables_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <hdf5.h>

#include <cmath>

#include "base/files.h"
#include "base/scratch_folder.h"
#include "run/files/order_curve.h"
#include "run/files/unit_of_name.h"
#include "run/files/version.h"
#include "tests/support/good.h"
#include "tests/support/in_child.h"
#include "tests/support/recorded_rods.h"
#include "tests/unit/run/hdf5_attributes.h"

namespace shaken::run {
namespace {

TEST(ObservablesFile, KeepsEveryNumberExactly) {
  const ScratchFolder folder;
  const Observables written{{"/order/time_s", {0, 0.01, 1.0 / 3.0}},
                            {"/order/order", {1e-300, -0.0, 0.1}},
                            {"/defects/n_plus", {}},
                            {"/defects/list/x_mm", {83.73}}};
  ASSERT_TRUE(write_observables(folder / "observables.h5", written));
  const auto read = test::good(read_observables(folder / "observables.h5"));
  EXPECT_EQ(*read, written);
}

TEST(ObservablesFile, EveryArrayHasItsUnitAndTheFileItsRun) {
  const ScratchFolder folder;
  const Observables written{{"/order/time_s", {0}}, {"/order/order", {1}}, {"/velocity/c_v_along_sem_mm2_s2", {1}}};
  ASSERT_TRUE(write_observables(folder / "observables.h5", written, {"0123456789abcdef", 77}));
  const hid_t file = H5Fopen((folder / "observables.h5").c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  ASSERT_GE(file, 0);
  EXPECT_EQ(hdf5_text_attribute(file, "/order/time_s", "unit"), "s");
  EXPECT_EQ(hdf5_text_attribute(file, "/order/order", "unit"), "1");
  EXPECT_EQ(hdf5_text_attribute(file, "/velocity/c_v_along_sem_mm2_s2", "unit"), "mm2 s-2");
  EXPECT_EQ(hdf5_text_attribute(file, "/", "run_id"), "0123456789abcdef");
  EXPECT_EQ(hdf5_text_attribute(file, "/", "shaken_version"), version());
  EXPECT_GT(H5Aexists_by_name(file, "/", "seed", H5P_DEFAULT), 0);
  H5Fclose(file);
}

TEST(UnitOfName, IsWhatTheNameEndsIn) {
  EXPECT_EQ(unit_of_name("/order/time_s"), "s");
  EXPECT_EQ(unit_of_name("/temperatures/along_pJ"), "pJ");
  EXPECT_EQ(unit_of_name("/tilt/v_along_sem_mm_s"), "mm s-1");
  EXPECT_EQ(unit_of_name("/msd/d_total_mm2_s"), "mm2 s-1");
  EXPECT_EQ(unit_of_name("/layers/q_per_mm"), "mm-1");
  EXPECT_EQ(unit_of_name("defect_created_per_mm2_s"), "mm-2 s-1");
  EXPECT_EQ(unit_of_name("/angles/density_per_rad"), "rad-1");
  EXPECT_EQ(unit_of_name("rotational_diffusion_rad2_s"), "rad2 s-1");
  EXPECT_EQ(unit_of_name("theta_m_deg"), "deg");
  EXPECT_EQ(unit_of_name("viscosity_pJ_s_per_mm2"), "pJ s-1 mm-2");
  EXPECT_EQ(unit_of_name("slowness_s_per_mm"), "s mm-1");
  EXPECT_EQ(unit_of_name("/g2/g2"), "1");
  EXPECT_EQ(unit_of_name("/tilt/n_z"), "1");
  EXPECT_EQ(unit_of_name("layers_per_box"), "1");
  EXPECT_EQ(unit_of_name(""), "1");
}

TEST(ObservablesFile, NotANumberComesBack) {
  const ScratchFolder folder;
  ASSERT_TRUE(write_observables(folder / "observables.h5", {{"/tilt/v_along_mm_s", {std::nan("")}}}));
  const auto read = test::good(read_observables(folder / "observables.h5"));
  EXPECT_TRUE(std::isnan(read->at("/tilt/v_along_mm_s").at(0)));
}

TEST(ObservablesFile, ReplacesAnEarlierOne) {
  const ScratchFolder folder;
  ASSERT_TRUE(write_observables(folder / "observables.h5", {{"/a/x", {1, 2, 3}}}));
  ASSERT_TRUE(write_observables(folder / "observables.h5", {{"/b/y", {4}}}));
  EXPECT_EQ(*read_observables(folder / "observables.h5"), (Observables{{"/b/y", {4}}}));
}

TEST(ObservablesFile, ErrorsNameTheFile) {
  const ScratchFolder folder;
  EXPECT_THAT(test::refusal(read_observables(folder / "observables.h5")), testing::HasSubstr("observables.h5"));
  ASSERT_TRUE(write_file_atomically(folder / "observables.h5", "not HDF5"));
  EXPECT_FALSE(read_observables(folder / "observables.h5"));
  EXPECT_THAT(test::refusal(write_observables(folder / "no" / "observables.h5", {})),
              testing::HasSubstr("no/observables.h5"));
}

TEST(ObservablesFile, FullDiskIsReported) {
  const ScratchFolder folder;
  EXPECT_EQ(in_child([&] {
              limit_file_size(2000);
              return !write_observables(folder / "observables.h5", {{"/x", std::vector<double>(10000, 1.5)}});
            }),
            0);
  EXPECT_FALSE(std::filesystem::exists(folder / "observables.h5"));
}

TEST(OrderCurve, IsThatOfEvenlyChosenFrames) {
  const ScratchFolder folder;
  const RunDirectory directory{folder.path()};
  test::record_rods(directory, 9);
  const OrderCurve all = recorded_order(directory, 100).value();
  EXPECT_EQ(all.times.size(), 9u);
  EXPECT_NEAR(all.orders.front(), 1, 1e-6);
  EXPECT_NEAR(all.orders.back(), 0, 1e-6) << "rods across each other";
  const OrderCurve some = recorded_order(directory, 3).value();
  ASSERT_EQ(some.times.size(), 3u);
  EXPECT_DOUBLE_EQ(some.times[0], 0);
  EXPECT_NEAR(some.times[1], 0.4, 1e-12);
  EXPECT_NEAR(some.times[2], 0.8, 1e-12);
  EXPECT_NEAR(recorded_order(directory, 1)->times.at(0), 0.8, 1e-12);
  test::record_rods(directory, 0);
  EXPECT_TRUE(recorded_order(directory, 3)->times.empty());
}

TEST(OrderCurve, SpheresHaveNone) {
  const ScratchFolder folder;
  test::record_rods({folder.path()}, 3, {{0}, {0.4}});
  EXPECT_TRUE(recorded_order({folder.path()}, 10)->times.empty());
}

TEST(OrderCurve, WithoutFramesItIsThatOfTheObservables) {
  const ScratchFolder folder;
  const RunDirectory directory{folder.path()};
  EXPECT_FALSE(recorded_order(directory, 3));
  ASSERT_TRUE(write_observables(directory.observables(), {{"/order/time_s", {1, 2}}, {"/order/order", {0.5, 0.25}}}));
  const OrderCurve curve = recorded_order(directory, 3).value();
  EXPECT_EQ(curve.times, (std::vector<double>{1, 2}));
  EXPECT_EQ(curve.orders, (std::vector<double>{0.5, 0.25}));
}

}  // namespace
}  // namespace shaken::run
