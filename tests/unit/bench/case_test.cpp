// SPDX-License-Identifier: MIT
#include "bench/case.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "base/failure.h"
#include "base/files.h"
#include "base/scratch_folder.h"

namespace shaken::bench {
namespace {

/// A dozen rods for two milliseconds.
Case small_case(double warm_up = 0.002) { return make_case(4.5, 0.3, 10, kPaperStep, warm_up); }

TEST(Case, HasTheScenesDefaults) {
  const Case made = make_case(4.5, 0.75, 41.865, kPaperStep, 0.5);
  EXPECT_EQ(made.system().n_rods, 527);
  EXPECT_EQ(made.system().rod.n_beads, 15);
  EXPECT_EQ(made.warm_up_ticks(), 125'000);
  EXPECT_EQ(made.period_ticks(), 1250);
  EXPECT_DOUBLE_EQ(made.rod_seconds(1250), 527 * 0.005);
}

TEST(Case, WhatASceneRefusesIsBadInput) {
  try {
    make_case(4.5, 0.75, 5, kPaperStep, 0.5);
    FAIL() << "not refused";
  } catch (const Failure& failure) {
    EXPECT_EQ(failure.code, ExitCode::kBadInput);
    EXPECT_NE(std::string(failure.what()).find("too small for rods"), std::string::npos) << failure.what();
  }
}

class SteadyStates : public ::testing::Test {
 protected:
  /// The only file in the cache.
  std::filesystem::path file() const { return file_in(cache_.path()); }
  static std::filesystem::path file_in(const std::filesystem::path& cache) {
    return std::filesystem::directory_iterator(cache)->path() / "checkpoint.bin";
  }
  static std::string content(const std::filesystem::path& file) { return *read_file(file); }
  static void write(const std::filesystem::path& file, const std::string& text) {
    std::ofstream(file, std::ios::binary) << text;
  }
  ScratchFolder cache_;
};

TEST_F(SteadyStates, AreMadeOnceAndThenReadBack) {
  const SteadyState made = steady_state(small_case(), cache_.path());
  EXPECT_FALSE(made.was_cached);
  const SteadyState read = steady_state(small_case(), cache_.path());
  EXPECT_TRUE(read.was_cached);
  EXPECT_EQ(read.checkpoint, made.checkpoint);
  EXPECT_EQ(resumed(small_case(), read, StepperKind::kReference).tick(), small_case().warm_up_ticks());
}

TEST_F(SteadyStates, OfAnotherWarmUpAreOthers) {
  steady_state(small_case(0.002), cache_.path());
  EXPECT_FALSE(steady_state(small_case(0.003), cache_.path()).was_cached);
}

TEST_F(SteadyStates, DamagedAreMadeAnew) {
  const SteadyState made = steady_state(small_case(), cache_.path());
  const std::string whole = content(file());
  std::string flipped = whole;
  flipped[whole.size() / 2] = static_cast<char>(flipped[whole.size() / 2] ^ 1);
  for (const std::string& damaged : {flipped, whole.substr(0, whole.size() - 1), whole + "x", std::string()}) {
    write(file(), damaged);
    const SteadyState again = steady_state(small_case(), cache_.path());
    EXPECT_FALSE(again.was_cached);
    EXPECT_EQ(again.checkpoint, made.checkpoint);
  }
}

TEST_F(SteadyStates, OfAnotherSceneUnderOurNameAreMadeAnew) {
  const SteadyState made = steady_state(small_case(), cache_.path());
  const std::filesystem::path ours = file();
  ScratchFolder elsewhere;
  steady_state(small_case(0.003), elsewhere.path());
  write(ours, content(file_in(elsewhere.path())));
  const SteadyState again = steady_state(small_case(), cache_.path());
  EXPECT_FALSE(again.was_cached);
  EXPECT_EQ(again.checkpoint, made.checkpoint);
}

TEST_F(SteadyStates, NeedAFolderThatCanBeWritten) {
  write(cache_ / "file", "");
  EXPECT_THROW(steady_state(small_case(), cache_ / "file"), Failure);
}

}  // namespace
}  // namespace shaken::bench
