// Observables of recorded frames: those of the run that recorded them, to the files' single precision.
#include "run/recorded/measure_frames.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "base/scratch_folder.h"
#include "run/files/directory.h"
#include "run/files/observables_file.h"
#include "run/files/trajectory.h"
#include "run/loop/loop.h"
#include "scene/canonical.h"
#include "scene/keys/observables.h"
#include "tests/support/good.h"
#include "tests/unit/run/small_plan.h"

namespace shaken::run {
namespace {

using testing::HasSubstr;
using testing::UnorderedElementsAre;

constexpr Tick kSpacing = 500;  ///< of the frames below

scene::RunPlan recorded_plan() {
  scene::RunPlan plan = small_plan();
  plan.steady = 0.1;
  plan.measure_time = 0.2;
  plan.order = scene::MeasureOrder{0.01};
  plan.angles = scene::MeasureAngles{0.02, 36};
  plan.tilt = scene::MeasureTilt{0.01, 10};
  plan.tilt->phases = scene::SamplePhases::kLocked;
  plan.g2.emplace().every = 0.02;
  plan.msd.emplace().every = 0.01;
  plan.trajectory = scene::Trajectory{kSpacing * plan.system.dt};
  return plan;
}

std::string text_of(const scene::RunPlan& plan) { return scene::to_json(plan).dump(2); }

/// `asked` of frames of recorded_plan().
keys::Loaded<FramesPlan> asked_for(const std::string& asked, const std::vector<std::string>& settings = {}) {
  const std::string own = text_of(recorded_plan());
  return plan_for_frames({own, "frames"}, {asked.empty() ? own : asked, "asked.json"}, settings, kSpacing);
}

TEST(MeasuredFrames, GiveTheNumbersOfTheRun) {
  const ScratchFolder folder;
  const scene::RunPlan plan = recorded_plan();
  ASSERT_EQ(run(plan, options_in(folder.path())).state, RunState::kDone);
  const RunDirectory files{folder.path()};
  const auto frames = test::good(TrajectoryReader::open(files.trajectory()));
  ASSERT_EQ(*frame_spacing(frames->recorded()), kSpacing);
  const auto made = test::good(asked_for(""));
  EXPECT_TRUE(made->remarks.empty());
  const auto found = test::good(measure_frames(made->plan, frames->recorded()));

  const auto of_run = test::good(read_observables(files.observables()));
  ASSERT_EQ(found->reduction.arrays.size(), of_run->size());
  for (const auto& [path, values] : *of_run) {
    const std::vector<double>& again = found->reduction.arrays.at(path);
    ASSERT_EQ(again.size(), values.size()) << path;
    double largest = 0;
    for (const double value : values) largest = std::isfinite(value) ? std::max(largest, std::abs(value)) : largest;
    for (std::size_t k = 0; k < values.size(); ++k) {
      EXPECT_EQ(std::isfinite(again[k]), std::isfinite(values[k])) << path << " " << k;
      const double off = std::isfinite(values[k]) ? again[k] - values[k] : 0;
      EXPECT_NEAR(off, 0, 2e-5 * largest) << path << " " << k;
    }
  }
  EXPECT_NEAR(found->last, 0.3, 1e-12);

  const auto words = nlohmann::json::parse(summary_text(summary_of(*made, *found, "frames"))),
             of_the_run = nlohmann::json::parse(*read_file(files.summary()));
  EXPECT_EQ(words["frames"], (nlohmann::json{{"file", "frames"},
                                             {"n", 31},
                                             {"first_s", 0.0},
                                             {"last_s", found->last},
                                             {"remarks", nlohmann::json::array()}}));
  EXPECT_EQ(words["exit"]["tick"], of_the_run["exit"]["tick"]);
  EXPECT_EQ(words["n_rods"], of_the_run["n_rods"]);
  EXPECT_NEAR(words["order"]["mean"].get<double>(), of_the_run["order"]["mean"].get<double>(), 1e-5);
}

TEST(MeasuredFrames, AreSampledAtWholeNumbersOfFramesAndSoItIsSaid) {
  const auto made =
      test::good(asked_for("", {"measure.msd.every=4 ms", "measure.tilt.every=25 ms", "measure.tilt.phases=spread"}));
  EXPECT_DOUBLE_EQ(made->plan.msd->every, 0.01);
  EXPECT_DOUBLE_EQ(made->plan.tilt->every, 0.03);
  EXPECT_EQ(made->plan.tilt->phases, scene::SamplePhases::kLocked);
  EXPECT_THAT(made->remarks,
              UnorderedElementsAre("measure.msd.every is 0.01 s, not 0.004 s: frames are 0.01 s apart",
                                   "measure.tilt.every is 0.03 s, not 0.025 s: frames are 0.01 s apart"));
}

TEST(MeasuredFrames, LackWhatTheyDoNotTell) {
  const auto made =
      test::good(asked_for("", {"measure.collisions=true", "measure.stress=true", "measure.temperatures=true"}));
  EXPECT_FALSE(made->plan.collisions || made->plan.stress || made->plan.temperatures);
  EXPECT_TRUE(made->plan.msd);
  EXPECT_THAT(made->remarks, UnorderedElementsAre("measure.collisions is left out: it needs impacts",
                                                  "measure.temperatures is left out: it needs angular velocities",
                                                  "measure.stress is left out: it needs impacts"));
  scene::RunPlan only_impacts = recorded_plan();
  for (const scene::Observable& each : scene::observables()) each.switch_off(only_impacts);
  only_impacts.collisions.emplace();
  const auto nothing = asked_for(text_of(only_impacts));
  ASSERT_FALSE(nothing);
  EXPECT_THAT(keys::to_string(nothing.error()), HasSubstr("asked.json: /measure: names nothing that frames tell"));
}

TEST(MeasuredFrames, AreOfTheSceneThatTheyAreOf) {
  scene::RunPlan other = recorded_plan();
  other.steady = 0.15;
  other.trajectory.reset();
  EXPECT_TRUE(asked_for(text_of(other))) << "may differ";
  other.system.gap += 0.1;
  other.system.seed = 7;
  const auto made = asked_for(text_of(other));
  ASSERT_FALSE(made);
  ASSERT_EQ(made.error().size(), 2U) << "all of them: " << keys::to_string(made.error());
  EXPECT_THAT(keys::to_string(made.error()),
              HasSubstr("asked.json: /time/seed: is not that of the frames: only `measure` and `time.steady` may"));
}

/// Two rods at some ticks.
class AtTicks final : public RecordedFrames {
 public:
  explicit AtTicks(std::vector<Tick> ticks) : ticks_(std::move(ticks)) {
    header_.n_rods = 2;
    header_.dt = recorded_plan().system.dt;
    header_.cell.box = Box(12, 12);
  }
  const TrajectoryHeader& header() const override { return header_; }
  std::size_t n_frames() const override { return ticks_.size(); }
  Result<RecordedFrame> frame(std::size_t index) const override {
    const Tick tick = ticks_[index];
    return RecordedFrame{tick,
                         static_cast<double>(tick) * header_.dt,
                         {1, 1, 1, 2, 2, 1},
                         std::vector<float>(6),
                         {1, 0, 0, 0, 1, 0, 0, 0},
                         std::vector<std::int32_t>(6)};
  }

 private:
  std::vector<Tick> ticks_;
  TrajectoryHeader header_;
};

TEST(MeasuredFrames, AreEquallyFarApart) {
  EXPECT_EQ(*frame_spacing(AtTicks({7})), 1);
  EXPECT_EQ(*frame_spacing(AtTicks({500, 1000})), 500);
  EXPECT_THAT(frame_spacing(AtTicks({})).error().message, HasSubstr("no frames"));
  EXPECT_THAT(frame_spacing(AtTicks({500, 500})).error().message, HasSubstr("not later than the first"));
  EXPECT_THAT(frame_spacing(AtTicks({100, 600})).error().message, HasSubstr("not at a multiple"));
  const auto made = test::good(asked_for(""));
  EXPECT_TRUE(measure_frames(made->plan, AtTicks({500, 1000, 1500})));
  EXPECT_EQ(measure_frames(made->plan, AtTicks({0, 500, 1500})).error().message,
            "frame 2 is at tick 1500, where others are 500 ticks apart");
}

TEST(MeasuredFrames, AreLeftWhereOneIsInterrupted) {
  const auto made = asked_for("");
  std::size_t seen = 0;
  const auto found = measure_frames(made->plan, AtTicks({0, 500, 1000}), [&](std::size_t frame) {
    seen = frame;
    return frame < 1;
  });
  EXPECT_EQ(found.error().message, "interrupted");
  EXPECT_EQ(seen, 1U);
}

}  // namespace
}  // namespace shaken::run
