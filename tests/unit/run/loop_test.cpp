// Whole runs in a directory: stopping and going on must leave no trace in the results, and damage must never lead to
// a wrong one.
#include "run/loop/loop.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>

#include "base/files.h"
#include "base/scratch_folder.h"
#include "proto/bus.h"
#include "proto/frame_codec.h"
#include "run/files/content_hash.h"
#include "run/files/done.h"
#include "run/files/observables_file.h"
#include "run/files/trajectory.h"
#include "run/loop/replay.h"
#include "run/loop/saved_run.h"
#include "scene/canonical.h"
#include "scene/length.h"
#include "tests/support/good.h"
#include "tests/support/in_child.h"
#include "tests/unit/run/small_plan.h"

namespace shaken::run {
namespace {

using testing::HasSubstr;

/// small_plan() without anything that is measured or recorded.
scene::RunPlan bare_plan() {
  scene::RunPlan plan = small_plan();
  static_cast<scene::MeasurePlan&>(plan) = {};
  plan.trajectory.reset();
  return plan;
}

nlohmann::json summary_in(const std::filesystem::path& folder) {
  const auto text = read_file(RunDirectory{folder}.summary());
  return text ? nlohmann::json::parse(*text) : nlohmann::json();
}

RunOutcome run_in(const std::filesystem::path& folder, const scene::RunPlan& plan, const RunCallbacks& callbacks = {}) {
  return run(plan, options_in(folder), callbacks);
}

/// Runs in pieces: each is stopped once the simulated time has passed the next of `stops` [s].
void run_with_stops(const std::filesystem::path& folder, const scene::RunPlan& plan, const std::vector<double>& stops) {
  for (const double time : stops) {
    std::atomic<bool> stop = false;
    RunOptions options = options_in(folder);
    options.stop = &stop;
    options.progress_every = WallSeconds(0);
    RunCallbacks callbacks;
    callbacks.on_progress = [&](const Progress& progress) { stop = stop || progress.sim_time >= time; };
    const RunOutcome outcome = run(plan, options, callbacks);
    ASSERT_EQ(outcome.state, RunState::kStopped) << outcome.message;
    EXPECT_EQ(read_progress(RunDirectory{folder}.progress())->state, "stopped");
    EXPECT_EQ(summary_in(folder)["exit"]["state"], "stopped");
  }
}

void expect_bitwise_equal(const Observables& a, const Observables& b) {
  ASSERT_EQ(a.size(), b.size());
  for (const auto& [path, values] : a) {
    ASSERT_TRUE(b.count(path)) << path;
    const auto& others = b.at(path);
    ASSERT_EQ(values.size(), others.size()) << path;
    EXPECT_EQ(std::memcmp(values.data(), others.data(), values.size() * sizeof(double)), 0) << path;
  }
}

void expect_same_results(const std::filesystem::path& a, const std::filesystem::path& b) {
  const auto summary_a = summary_in(a);
  const auto summary_b = summary_in(b);
  EXPECT_EQ(summary_a["exit"]["state"], "done");
  for (const char* key : {"state_hash", "run_id", "collisions", "order", "defects", "effects", "max_overlap_mm"}) {
    EXPECT_EQ(summary_a[key], summary_b[key]) << key;
  }
  expect_bitwise_equal(*read_observables(RunDirectory{a}.observables()),
                       *read_observables(RunDirectory{b}.observables()));
  const auto frames_a = TrajectoryReader::open(RunDirectory{a}.trajectory());
  const auto frames_b = TrajectoryReader::open(RunDirectory{b}.trajectory());
  ASSERT_TRUE(frames_a);
  ASSERT_TRUE(frames_b);
  ASSERT_EQ(frames_a->n_frames(), frames_b->n_frames());
  for (std::size_t i = 0; i < frames_a->n_frames(); ++i) {
    const auto frame_a = frames_a->frame(i);
    const auto frame_b = frames_b->frame(i);
    EXPECT_EQ(frame_a->tick, frame_b->tick);
    EXPECT_EQ(frame_a->position, frame_b->position);
    EXPECT_EQ(frame_a->director, frame_b->director);
    EXPECT_EQ(frame_a->image, frame_b->image);
  }
}

/// Work of all effects of a run that are off, and how many they are.
std::pair<int, double> work_of_effects_off(const nlohmann::json& summary) {
  int n_off = 0;
  double work = 0;
  for (const auto& [name, effect] : summary["effects"].items()) {
    if (effect["on"]) continue;
    ++n_off;
    for (const auto& [key, amount] : effect.items()) work += key == "on" ? 0.0 : amount.get<double>();
  }
  return {n_off, work};
}

/// One undisturbed run, made once, to compare the others with.
const std::filesystem::path& undisturbed() {
  static const ScratchFolder folder;
  static const bool made = run_in(folder.path(), small_plan()).state == RunState::kDone;
  EXPECT_TRUE(made);
  return folder.path();
}

TEST(Run, EffectsThatAreOffDoNoWork) {
  const ScratchFolder folder;
  scene::RunPlan plan = small_plan();
  plan.measure_time = 0.05;
  for (ContactParameters* contact : {&plan.system.rod_rod, &plan.system.rod_base, &plan.system.rod_lid}) {
    *contact = {0.0, 0.0};
  }
  plan.system.gravity = 0;
  plan.system.amplitude = 0;
  plan.system.rod.end_diameter = plan.system.rod.mid_diameter;
  plan.order.reset();
  plan.trajectory.reset();
  ASSERT_EQ(run_in(folder.path(), plan).state, RunState::kDone);
  const auto summary = summary_in(folder.path());
  const auto [n_off, work] = work_of_effects_off(summary);
  // friction and restitution; gravity, vibration, taper, spin; order, g2, msd, trajectory, stream, movie; and what a
  // scene has only if it asks for it
  EXPECT_GE(n_off, 3 * 2 + 4 + 6);
  EXPECT_EQ(work, 0);
  EXPECT_GT(summary["effects"]["rod_base_collisions"]["impulses"].get<int>(), 0);
}

TEST(Run, FillsItsDirectory) {
  const RunDirectory directory{undisturbed()};
  const auto summary = summary_in(directory.root);
  EXPECT_EQ(summary["n_rods"], 24);
  EXPECT_NEAR(summary["sim_seconds"].get<double>(), 0.3, 1e-12);
  EXPECT_EQ(summary["exit"]["tick"], 15000);
  EXPECT_GT(summary["collisions"]["rod_base"].get<int>(), 0);
  EXPECT_EQ(summary["run_id"], scene::run_id(small_plan()));
  EXPECT_EQ(summary["effects"]["measure_order"]["samples"], 151);
  EXPECT_EQ(summary["effects"]["trajectory"]["frames"], 31);
  EXPECT_EQ(summary["effects"]["stream"]["on"], false);
  EXPECT_GT(summary["effects"]["rod_base_friction"]["impulses"].get<int>(), 0);
  EXPECT_EQ(summary["effects"]["vibration"]["periods"], 60);
  for (const auto& file : {directory.trajectory(), directory.observables()}) {
    const ContentHash hash = content_hash(file).value();
    EXPECT_EQ(summary["files"][file.filename().string()]["bytes"], hash.size) << file;
    EXPECT_EQ(summary["files"][file.filename().string()]["xxh3"], fmt::format("{:016x}", hash.xxh3)) << file;
  }
  EXPECT_EQ(read_progress(directory.progress())->state, "done");
  EXPECT_EQ(read_progress(directory.progress())->fraction(), 1.0);

  const auto trajectory = test::good(TrajectoryReader::open(directory.trajectory()));
  ASSERT_EQ(trajectory->n_frames(), 31U);
  EXPECT_EQ(trajectory->frame(0)->tick, 0);
  EXPECT_EQ(trajectory->frame(30)->tick, 15000);
  EXPECT_EQ(trajectory->header().scene_json, *read_file(directory.scene()));
}

TEST(Run, StoppedAndResumedIsBitwiseTheStraightRun) {
  const ScratchFolder folder;
  run_with_stops(folder.path(), small_plan(), {0, 0.05, 0.0501, 0.123, 0.29});
  ASSERT_EQ(run_in(folder.path(), small_plan()).state, RunState::kDone);
  expect_same_results(undisturbed(), folder.path());
}

TEST(Run, StopsWhileItCompressesAndNeedNotDoSoAgain) {
  scene::RunPlan plan = small_plan();
  plan.system.start = Start::kCompressed;
  plan.system.n_rods = 60;
  const ScratchFolder straight, folder;
  ASSERT_EQ(run_in(straight.path(), plan).state, RunState::kDone);

  std::atomic<bool> stop = true;
  RunOptions options = options_in(folder.path());
  options.stop = &stop;
  EXPECT_EQ(run(plan, options).state, RunState::kStopped);
  EXPECT_EQ(read_progress(RunDirectory{folder.path()}.progress())->state, "stopped");
  EXPECT_FALSE(std::filesystem::exists(RunDirectory{folder.path()}.checkpoint()));
  run_with_stops(folder.path(), plan, {0, 0.1});
  EXPECT_TRUE(std::filesystem::exists(RunDirectory{folder.path()}.checkpoint()));
  ASSERT_EQ(run_in(folder.path(), plan).state, RunState::kDone);
  expect_same_results(straight.path(), folder.path());
}

TEST(Run, FinishedRunsAreNotDoneAgain) {
  const ScratchFolder folder;
  ASSERT_EQ(run_in(folder.path(), small_plan()).state, RunState::kDone);
  const RunDirectory directory{folder.path()};
  const auto written = std::filesystem::last_write_time(directory.summary());
  std::filesystem::remove(directory.checkpoint());
  EXPECT_EQ(run_in(folder.path(), small_plan()).state, RunState::kDone);
  EXPECT_EQ(std::filesystem::last_write_time(directory.summary()), written);
  EXPECT_FALSE(std::filesystem::exists(directory.checkpoint()));
}

TEST(Run, WhoseResultsAreGoneIsNotDoneAndMakesThemAnew) {
  const ScratchFolder folder;
  ASSERT_EQ(run_in(folder.path(), small_plan()).state, RunState::kDone);
  const RunDirectory directory{folder.path()};
  for (const auto& file : {directory.observables(), directory.trajectory()}) {
    const ContentHash before = content_hash(file).value();
    std::filesystem::remove(file);
    EXPECT_FALSE(is_done(directory, small_plan()));
    EXPECT_EQ(run_in(folder.path(), small_plan()).state, RunState::kDone);
    EXPECT_EQ(content_hash(file).value().size, before.size) << file;
    EXPECT_TRUE(is_done(directory, small_plan()));
  }
}

// A damaged trajectory cannot be gone on from.
TEST(Run, WhoseTrajectoryIsDamagedIsMadeAnewWhereItsSummaryIsRemoved) {
  const ScratchFolder folder;
  ASSERT_EQ(run_in(folder.path(), small_plan()).state, RunState::kDone);
  const RunDirectory directory{folder.path()};
  const auto state_hash = summary_in(folder.path())["state_hash"];
  std::filesystem::resize_file(directory.trajectory(), std::filesystem::file_size(directory.trajectory()) / 2);
  EXPECT_FALSE(TrajectoryReader::open(directory.trajectory()));
  std::filesystem::remove(directory.summary());
  EXPECT_EQ(run_in(folder.path(), small_plan()).state, RunState::kDone);
  EXPECT_EQ(summary_in(folder.path())["state_hash"], state_hash);
  EXPECT_TRUE(TrajectoryReader::open(directory.trajectory()));
}

/// Leaves a run stopped with two checkpoints; returns their folder.
void stop_twice(const ScratchFolder& folder) {
  run_with_stops(folder.path(), small_plan(), {0.1, 0.2});
  ASSERT_TRUE(std::filesystem::exists(RunDirectory{folder.path()}.checkpoint()));
  ASSERT_TRUE(std::filesystem::exists(RunDirectory{folder.path()}.previous_checkpoint()));
}

void flip_a_byte(const std::filesystem::path& file) {
  std::string content = *read_file(file);
  content[content.size() / 2] = static_cast<char>(content[content.size() / 2] ^ 0x40);
  ASSERT_TRUE(write_file(file, content));
}

// It falls back to the previous checkpoint, or starts anew where none is whole or the trajectory is lost.
TEST(Run, WhoseFilesAreDamagedIsBitwiseTheStraightRun) {
  using Damage = std::function<void(const RunDirectory&)>;
  const Damage newest = [](const RunDirectory& of) { flip_a_byte(of.checkpoint()); };
  const Damage both = [&](const RunDirectory& of) { newest(of), flip_a_byte(of.previous_checkpoint()); };
  const Damage frames = [](const RunDirectory& of) { std::filesystem::remove(of.frames()); };
  for (const auto& [what, damage] : {std::pair{"checkpoint", newest}, {"checkpoints", both}, {"frames", frames}}) {
    SCOPED_TRACE(what);
    const ScratchFolder folder;
    stop_twice(folder);
    damage(RunDirectory{folder.path()});
    ASSERT_EQ(run_in(folder.path(), small_plan()).state, RunState::kDone);
    expect_same_results(undisturbed(), folder.path());
  }
}

TEST(SavedRun, GoesOnFromTheNewestCheckpointThatCanBeUsed) {
  const ScratchFolder folder;
  stop_twice(folder);
  const RunDirectory directory{folder.path()};
  const Result<scene::RunPlan> plan = test::good(read_plan(directory));
  const std::string id = scene::run_id(*plan);
  const auto resumed = [&](Tick before = std::numeric_limits<Tick>::max()) {
    return resume_last(directory, id, plan->system, before);
  };
  ASSERT_TRUE(resumed());
  const Tick newest = resumed()->tick();
  ASSERT_TRUE(resumed(newest));
  const Tick older = resumed(newest)->tick();
  EXPECT_LT(older, newest);
  EXPECT_FALSE(resumed(older));
  flip_a_byte(directory.checkpoint());
  EXPECT_EQ(resumed()->tick(), older);
  flip_a_byte(directory.previous_checkpoint());
  EXPECT_NE(resumed().error().message.find("checkpoint.bin"), std::string::npos) << "of the newest";
}

TEST(Run, SurvivesASuddenEnd) {
  const ScratchFolder folder;
  EXPECT_EQ(in_child([&] {
              RunOptions options = options_in(folder.path());
              options.checkpoint_every = WallSeconds(0.001);
              options.progress_every = WallSeconds(0);
              RunCallbacks callbacks;
              callbacks.on_progress = [&](const Progress& progress) {
                if (progress.sim_time > 0.17) kill(getpid(), SIGKILL);
              };
              run(small_plan(), options, callbacks);
              return true;
            }),
            128);
  EXPECT_TRUE(std::filesystem::exists(RunDirectory{folder.path()}.checkpoint()));
  ASSERT_EQ(run_in(folder.path(), small_plan()).state, RunState::kDone);
  expect_same_results(undisturbed(), folder.path());
}

TEST(Run, ReadsNoSceneOnceMoreThatItWasGiven) {
  const ScratchFolder folder;
  ASSERT_TRUE(write_file(RunDirectory{folder.path()}.scene(), "{"));
  EXPECT_THAT(run_in(folder.path(), small_plan()).message, HasSubstr("a run whose scene cannot be read"));
  RunOptions options = options_in(folder.path());
  options.is_own_scene = true;
  EXPECT_EQ(run(small_plan(), options).state, RunState::kDone);
  EXPECT_EQ(*read_file(RunDirectory{folder.path()}.scene()), "{");
}

TEST(Run, RefusesTheDirectoryOfAnotherScene) {
  scene::RunPlan other = small_plan();
  other.system.seed += 1;
  const auto before = read_file(RunDirectory{undisturbed()}.summary());
  EXPECT_THAT(test::said_with(RunState::kFailed, run_in(undisturbed(), other)), HasSubstr("another scene"));
  EXPECT_EQ(*read_file(RunDirectory{undisturbed()}.summary()), *before);
}

scene::RunPlan with_length(double seconds) {
  scene::RunPlan plan = small_plan();
  plan.measure_time = seconds;
  return plan;
}

TEST(Run, ExtendedIsBitwiseTheLongRun) {
  const ScratchFolder folder;
  for (const double length : {0.07, 0.1, 0.205}) {
    ASSERT_EQ(run_in(folder.path(), with_length(length)).state, RunState::kDone);
    EXPECT_NEAR(summary_in(folder.path())["sim_seconds"].get<double>(), length, 1e-9);
  }
  ASSERT_EQ(run_in(folder.path(), small_plan()).state, RunState::kDone);
  expect_same_results(folder.path(), undisturbed());
  const RunDirectory directory{folder.path()};
  EXPECT_EQ(read_plan(directory)->measure_time, small_plan().measure_time);
  EXPECT_EQ(TrajectoryReader::open(directory.trajectory())->header().scene_json, *read_file(directory.scene()));
}

TEST(Run, ExtensionThatIsStoppedIsBitwiseTheLongRun) {
  const ScratchFolder folder;
  ASSERT_EQ(run_in(folder.path(), with_length(0.1)).state, RunState::kDone);
  run_with_stops(folder.path(), small_plan(), {0.15, 0.25});
  ASSERT_EQ(run_in(folder.path(), small_plan()).state, RunState::kDone);
  expect_same_results(folder.path(), undisturbed());
}

TEST(Run, AskedForLessIsLeftAsItIs) {
  const ScratchFolder folder;
  ASSERT_EQ(run_in(folder.path(), with_length(0.1)).state, RunState::kDone);
  const auto summary = read_file(RunDirectory{folder.path()}.summary());
  ASSERT_EQ(run_in(folder.path(), with_length(0.05)).state, RunState::kDone);
  EXPECT_EQ(*read_file(RunDirectory{folder.path()}.summary()), *summary);
  EXPECT_EQ(read_plan(RunDirectory{folder.path()})->measure_time, 0.1);
}

TEST(Run, FilmOfAnExtendedRunIsDrawnAnew) {
  const ScratchFolder folder;
  int n_drawn = 0;
  RunCallbacks callbacks;
  callbacks.make_movie = [&](const OnDrawn&) -> Result<void> {
    return write_file(RunDirectory{folder.path()}.movie(), std::to_string(++n_drawn));
  };
  for (const double length : {0.05, 0.1}) {
    scene::RunPlan plan = with_length(length);
    plan.movie = scene::Movie{0.01, 320, 240};
    ASSERT_EQ(run_in(folder.path(), plan, callbacks).state, RunState::kDone);
  }
  EXPECT_EQ(*read_file(RunDirectory{folder.path()}.movie()), "2");
}

/// A run that is over at the first end at which S is known to `order_sem`.
scene::RunPlan plan_until(double order_sem, double at_most) {
  scene::RunPlan plan = with_length(0.05);
  plan.until = scene::Until{order_sem, at_most};
  return plan;
}

TEST(Run, ThatIsStoppedOnItsWayToALaterEndKnowsTheFormerOne) {
  const ScratchFolder folder;
  ASSERT_EQ(run_in(folder.path(), with_length(0.05)).state, RunState::kDone);
  const double former = summary_in(folder.path())["sim_seconds"];
  EXPECT_FALSE(summary_in(folder.path())["exit"].contains("done_before_s"));
  for (const double stop : {0.3, 0.6}) {
    run_with_stops(folder.path(), with_length(1), {stop});
    EXPECT_EQ(summary_in(folder.path())["exit"]["done_before_s"], former);
  }
  ASSERT_EQ(run_in(folder.path(), with_length(1)).state, RunState::kDone);
  EXPECT_FALSE(summary_in(folder.path())["exit"].contains("done_before_s"));
}

TEST(Run, GoesOnUntilTheErrorIsSmallEnough) {
  const ScratchFolder folder;
  RunOptions options = options_in(folder.path());
  options.progress_every = WallSeconds(0.01);
  std::vector<double> fractions;
  RunCallbacks callbacks;
  callbacks.on_progress = [&](const Progress& progress) { fractions.push_back(progress.fraction()); };
  ASSERT_EQ(run(plan_until(0.05, 20), options, callbacks).state, RunState::kDone);
  const auto summary = summary_in(folder.path());
  EXPECT_LE(summary["order"]["sem"].get<double>(), 0.05);
  EXPECT_NE(summary["order"]["steady"], false);
  const auto tick = summary["exit"]["tick"].get<Tick>();
  EXPECT_GT(tick, scene::total_ticks(with_length(0.05))) << "else nothing was tested";
  EXPECT_LT(tick, scene::total_ticks(with_length(20)));

  // progress is that to the latest end
  EXPECT_TRUE(std::is_sorted(fractions.begin(), fractions.end()));
  EXPECT_EQ(fractions.back(), 1);
  std::erase(fractions, 1.0);
  ASSERT_FALSE(fractions.empty());
  EXPECT_LE(fractions.back(), summary["sim_seconds"].get<double>() / 20);

  // one that stops on the way ends where this one did, for the possible ends follow from the plan
  const ScratchFolder stopped;
  const double end = summary["sim_seconds"].get<double>();
  run_with_stops(stopped.path(), plan_until(0.05, 20), {0.3 * end, 0.8 * end});
  ASSERT_EQ(run_in(stopped.path(), plan_until(0.05, 20)).state, RunState::kDone);
  expect_same_results(stopped.path(), folder.path());

  // at no earlier one of these ends was the error small enough
  const ScratchFolder shorter;
  for (Tick at = scene::total_ticks(plan_until(0.05, 20)); at < tick;
       at = scene::next_end(plan_until(0.05, 20), at + 1)) {
    ASSERT_EQ(run_in(shorter.path(), with_length(static_cast<double>(at) * small_plan().system.dt)).state,
              RunState::kDone);
    EXPECT_FALSE(is_done(RunDirectory{shorter.path()}, plan_until(0.05, 20))) << at;
  }
}

TEST(Run, WithoutACheckpointOnAFullDiskBeginsAnewAndSaysSo) {
  const ScratchFolder folder;
  for (const char* name : {"checkpoint.bin", "checkpoint.prev.bin"}) {
    std::filesystem::create_directories(folder.path() / name / "in the way");
  }
  const RunOutcome outcome = run_in(folder.path(), with_length(0.05));
  EXPECT_NE(outcome.state, RunState::kDone);
  EXPECT_THAT(outcome.message, HasSubstr("there is no checkpoint yet: the run begins anew when started again"));
}

TEST(Run, EndsAtTheLatestWhereUntilSays) {
  const ScratchFolder folder;
  ASSERT_EQ(run_in(folder.path(), plan_until(1e-9, 0.11)).state, RunState::kDone);
  EXPECT_NEAR(summary_in(folder.path())["sim_seconds"].get<double>(), 0.11, 1e-9);
  EXPECT_TRUE(is_done(RunDirectory{folder.path()}, plan_until(1e-9, 0.11)));
  EXPECT_FALSE(is_done(RunDirectory{folder.path()}, plan_until(1e-9, 0.12)));
}

TEST(Run, RefusesADirectoryInUse) {
  const ScratchFolder folder;
  const auto lock = test::good(DirectoryLock::acquire(RunDirectory{folder.path()}.lock()));
  EXPECT_THAT(test::said_with(RunState::kFailed, run_in(folder.path(), small_plan())),
              HasSubstr(std::to_string(getpid())));
  EXPECT_FALSE(std::filesystem::exists(RunDirectory{folder.path()}.progress())) << "that is its owner's";
}

TEST(Run, NamesTheFileThatCannotBeWritten) {
  const ScratchFolder folder;
  std::filesystem::create_directories(RunDirectory{folder.path()}.frames());
  const RunOutcome outcome = run_in(folder.path(), small_plan());
  EXPECT_EQ(outcome.state, RunState::kFailed);
  EXPECT_NE(outcome.message.find("trajectory.part"), std::string::npos) << outcome.message;
  const auto progress = test::good(read_progress(RunDirectory{folder.path()}.progress()));
  EXPECT_EQ(progress->state, "failed");
  EXPECT_EQ(progress->message, outcome.message);
}

TEST(Run, GoesOnAfterAFullDisk) {
  const ScratchFolder folder;
  EXPECT_EQ(in_child([&] {
              limit_file_size(110000);
              RunOptions options = options_in(folder.path());
              options.checkpoint_every = WallSeconds(0.001);
              const RunOutcome outcome = run(small_plan(), options);
              return outcome.state == RunState::kFailed &&
                     outcome.message.find(folder.path().string()) != std::string::npos;
            }),
            0);
  EXPECT_EQ(read_progress(RunDirectory{folder.path()}.progress())->state, "failed");
  ASSERT_EQ(run_in(folder.path(), small_plan()).state, RunState::kDone);
  expect_same_results(undisturbed(), folder.path());
}

TEST(Run, SaysWhyItCannotStart) {
  const ScratchFolder folder;
  scene::RunPlan crowded = small_plan();
  crowded.system.n_rods = 5000;
  const RunOutcome outcome = run_in(folder.path(), crowded);
  EXPECT_EQ(outcome.state, RunState::kFailed);
  EXPECT_FALSE(outcome.message.empty());
  EXPECT_EQ(read_progress(RunDirectory{folder.path()}.progress())->message, outcome.message);
}

/// Plates that move by just less than half the radius of the thinnest bead in a tick: rods that they throw move by
/// more.
TEST(Run, NumericalTroubleIsReportedAndNeverRepaired) {
  const ScratchFolder folder;
  scene::RunPlan violent = small_plan();
  violent.system.frequency = 200;
  violent.system.amplitude = 0.7;
  violent.system.n_rods = 30;
  violent.system.rod_rod.restitution = violent.system.rod_base.restitution = violent.system.rod_lid.restitution = 1;
  violent.system.dt = 1e-4;
  const RunOutcome outcome = run_in(folder.path(), violent);
  EXPECT_EQ(outcome.state, RunState::kFailed);
  EXPECT_NE(outcome.message.find("numerical trouble at tick"), std::string::npos) << outcome.message;
  EXPECT_NE(outcome.message.find("a shorter time.step helps"), std::string::npos) << outcome.message;
  const auto exit = summary_in(folder.path())["exit"];
  EXPECT_EQ(exit["state"], "failed");
  EXPECT_EQ(exit["reason"], outcome.message);
  EXPECT_FALSE(exit["rods"].empty());
  EXPECT_GT(exit["tick"].get<Tick>(), 0);
  EXPECT_EQ(read_progress(RunDirectory{folder.path()}.progress())->state, "failed");
  EXPECT_EQ(run_in(folder.path(), violent).message, outcome.message) << "it happens again, in the same place";
  auto again = test::good(replay(folder.path()));
  EXPECT_TRUE(as_text(*again, violent.system.dt).ends_with("\nthe same trouble at the same tick\n"));
  again->met.reset();
  EXPECT_NE(as_text(*again, violent.system.dt).find("no trouble at this tick\nNOT the same: "), std::string::npos);
}

TEST(Run, EmptyPlanLeavesNoTrajectoryAndNoObservables) {
  const ScratchFolder folder;
  scene::RunPlan bare = bare_plan();
  bare.measure_time = 0.01;
  ASSERT_EQ(run_in(folder.path(), bare).state, RunState::kDone);
  EXPECT_FALSE(std::filesystem::exists(RunDirectory{folder.path()}.trajectory()));
  EXPECT_TRUE(read_observables(RunDirectory{folder.path()}.observables())->empty());
  EXPECT_TRUE(summary_in(folder.path())["order"].is_null());
}

TEST(Run, MeasuringAndRecordingDoNotDisturbTheMotion) {
  const ScratchFolder folder;
  ASSERT_EQ(run_in(folder.path(), bare_plan()).state, RunState::kDone);
  EXPECT_EQ(summary_in(folder.path())["state_hash"], summary_in(undisturbed())["state_hash"]);
}

TEST(Run, MovieIsDrawnOnceAndRecordsAtTheFinerCadence) {
  const ScratchFolder folder;
  scene::RunPlan plan = small_plan();
  plan.measure_time = 0.05;
  plan.movie = scene::Movie{0.005, 320, 240};
  int n_drawn = 0;
  std::vector<std::string> states;
  std::vector<std::pair<double, double>> drawing;  // share drawn, wall seconds to the end
  RunCallbacks callbacks;
  callbacks.on_progress = [&](const Progress& progress) {
    states.push_back(progress.state);
    if (progress.state != "rendering") return;
    drawing.emplace_back(progress.drawn, progress.eta);
    EXPECT_EQ(read_progress(RunDirectory{folder.path()}.progress())->drawn, progress.drawn);
  };
  callbacks.make_movie = [&](const OnDrawn& on_drawn) -> Result<void> {
    ++n_drawn;
    on_drawn(0.25, 12);
    return Error{"no renderer here"};
  };
  const RunOutcome failed_movie = run_in(folder.path(), plan, callbacks);
  EXPECT_EQ(failed_movie.state, RunState::kFailed) << "a film that was not made is said";
  EXPECT_TRUE(is_done(RunDirectory{folder.path()}, scene::run_id(plan))) << "it does not lose the run";
  EXPECT_NE(failed_movie.message.find("no renderer here"), std::string::npos);
  EXPECT_EQ(n_drawn, 1);
  EXPECT_EQ(drawing, (std::vector<std::pair<double, double>>{{0, -1}, {0.25, 12}}));
  EXPECT_EQ(states.back(), "failed");
  EXPECT_EQ(TrajectoryReader::open(RunDirectory{folder.path()}.trajectory())->n_frames(), 11U);

  callbacks.make_movie = [&](const OnDrawn&) -> Result<void> {
    ++n_drawn;
    return write_file(RunDirectory{folder.path()}.movie(), "a movie");
  };
  EXPECT_EQ(run_in(folder.path(), plan, callbacks).state, RunState::kDone);
  EXPECT_EQ(n_drawn, 2) << "the missing movie is made up for";
  EXPECT_EQ(run_in(folder.path(), plan, callbacks).state, RunState::kDone);
  EXPECT_EQ(n_drawn, 2);
}

/// LCM's file provider stands in for the network: everything that is published ends in a log.
TEST(Run, LiveFramesComeAtTheirOwnRateAndAreThoseOfTheTrajectory) {
  const ScratchFolder folder;
  scene::RunPlan plan = small_plan();
  plan.stream = scene::Stream{1000};
  plan.trajectory = scene::Trajectory{plan.measure_time};  // the first and the last state alone
  RunOptions options = options_in(folder / "run");
  options.job_id = "0123456789abcdef";
  options.label = "rods.length=2.5";
  options.lcm_url = "file://" + (folder / "live.lcmlog").string() + "?mode=w";
  ASSERT_EQ(run(plan, options).state, RunState::kDone);
  EXPECT_EQ(summary_in(options.directory)["state_hash"], summary_in(undisturbed())["state_hash"])
      << "streaming changes nothing";

  const auto log = test::good(proto::Bus::open("file://" + (folder / "live.lcmlog").string() + "?speed=0"));
  std::vector<frame_t> frames;
  std::vector<observables_t> observables;
  int n_static = 0;
  log.value()->subscribe<frame_t>(proto::kFrameChannel, [&](const frame_t& frame) { frames.push_back(frame); });
  log.value()->subscribe<observables_t>(proto::kObservablesChannel,
                                        [&](const observables_t& message) { observables.push_back(message); });
  log.value()->subscribe<frame_static_t>(proto::kFrameStaticChannel, [&](const frame_static_t& message) {
    ++n_static;
    EXPECT_EQ(message.label, "rods.length=2.5");
    EXPECT_EQ(message.n_rods, 24);
  });
  while (log.value()->handle(200)) {
  }
  EXPECT_GE(n_static, 1);
  EXPECT_GE(observables.size(), 1U);
  ASSERT_GE(frames.size(), 1U);

  const auto trajectory = test::good(TrajectoryReader::open(RunDirectory{options.directory}.trajectory()));
  std::map<Tick, Snapshot> recorded;
  for (std::size_t i = 0; i < trajectory->n_frames(); ++i) {
    const auto frame = trajectory->frame(i);
    recorded[frame->tick] = *frame;
  }
  ASSERT_EQ(recorded.size(), 2U);
  EXPECT_TRUE(recorded.contains(frames.back().tick)) << "the last state is always sent";
  int n_between = 0;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    EXPECT_EQ(frames[i].sequence, static_cast<std::int64_t>(i)) << "numbers without gaps";
    EXPECT_EQ(frames[i].job_id, "0123456789abcdef");
    if (!recorded.contains(frames[i].tick)) {
      ++n_between;
      continue;
    }
    const Snapshot& frame = recorded[frames[i].tick];
    const auto rods = proto::decode_chunk(frames[i]);
    ASSERT_EQ(rods.size(), frame.position.size());
    for (std::size_t r = 0; r < rods.size(); ++r) {
      const double side = plan.system.box_side;
      EXPECT_LT(std::abs(std::remainder(rods[r].x - frame.position[r].x(), side)), 1.1 * side / 131072);
      EXPECT_LT(std::abs(std::remainder(rods[r].y - frame.position[r].y(), side)), 1.1 * side / 131072);
      const auto axis = rods[r].axis();
      EXPECT_NEAR(Vec3(axis[0], axis[1], axis[2]).dot(frame.director[r]), 1, 1e-6);
    }
  }
  EXPECT_GT(n_between, 0) << "nothing is measured or recorded there";
}

/// With the real program, beside this one.
TEST(Run, TheFilmIsDrawnAndTellsHowFarItIs) {
  const ScratchFolder folder;
  scene::RunPlan plan = small_plan();
  plan.measure_time = 0.05;
  plan.movie = scene::Movie{0.005, 320, 240};
  std::vector<double> drawn;
  const std::atomic<bool> stop = false;
  RunCallbacks callbacks;
  callbacks.on_progress = [&](const Progress& progress) {
    if (progress.state == "rendering") drawn.push_back(progress.drawn);
  };
  callbacks.make_movie = [&](const OnDrawn& on_drawn) {
    return render_movie(folder.path(), stop, "rods.length=2.5", on_drawn);
  };
  const RunOutcome outcome = run_in(folder.path(), plan, callbacks);
  EXPECT_EQ(outcome.message, "");
  EXPECT_TRUE(std::filesystem::exists(RunDirectory{folder.path()}.movie()));
  EXPECT_FALSE(std::filesystem::exists(folder / "drawing.json"));
  ASSERT_GE(drawn.size(), 2U);
  EXPECT_TRUE(std::is_sorted(drawn.begin(), drawn.end()));
  EXPECT_EQ(drawn.back(), 1);
}

TEST(Run, LcmThatCannotStartIsOnlyAWarning) {
  const ScratchFolder folder;
  scene::RunPlan plan = small_plan();
  plan.stream = scene::Stream{20};
  RunOptions options = options_in(folder.path());
  options.lcm_url = "nonsense://";
  ASSERT_EQ(run(plan, options).state, RunState::kDone);
  EXPECT_EQ(summary_in(folder.path())["state_hash"], summary_in(undisturbed())["state_hash"]);
}

/// small_plan(), from where that of `seconds` has left the rods, shaken harder.
scene::RunPlan plan_from(double seconds) {
  scene::RunPlan plan = with_length(0.1);
  plan.start = scene::StartState{scene::run_id(small_plan()), seconds};
  plan.system.amplitude *= 1.25;
  return plan;
}

TEST(Run, StartsWhereAnotherHasEnded) {
  const ScratchFolder folder;
  ASSERT_EQ(run_in(folder.path() / "one", small_plan()).state, RunState::kDone);
  const RunOutcome outcome = run_in(folder.path() / "two", plan_from(0.3));
  ASSERT_EQ(outcome.state, RunState::kDone) << outcome.message;
  const auto summary = summary_in(folder.path() / "two");
  EXPECT_EQ(summary["start"]["run"], scene::run_id(small_plan()));
  EXPECT_EQ(summary["start"]["time_s"], 0.3);
  EXPECT_TRUE(summary_in(folder.path() / "one")["start"].is_null());
  EXPECT_NE(summary["run_id"], scene::run_id(with_length(0.1)));

  const auto left = TrajectoryReader::open(RunDirectory{folder.path() / "one"}.trajectory());
  const auto begun = TrajectoryReader::open(RunDirectory{folder.path() / "two"}.trajectory());
  const auto last = left->frame(left->n_frames() - 1);
  const auto first = begun->frame(0);
  EXPECT_EQ(first->tick, 0);
  ASSERT_EQ(first->director.size(), last->director.size());
  for (std::size_t i = 0; i < first->director.size(); ++i) {
    EXPECT_NEAR((first->director[i] - last->director[i]).norm(), 0, 1e-6) << i;
  }
}

TEST(Run, StartingFromAnotherNeedsThatOneOnlyOnce) {
  const ScratchFolder folder;
  ASSERT_EQ(run_in(folder.path() / "one", small_plan()).state, RunState::kDone);
  ASSERT_EQ(run_in(folder.path() / "whole", plan_from(0.3)).state, RunState::kDone);
  run_with_stops(folder.path() / "two", plan_from(0.3), {0.0});
  std::filesystem::remove_all(folder.path() / "one");
  ASSERT_EQ(run_in(folder.path() / "two", plan_from(0.3)).state, RunState::kDone);
  expect_same_results(folder.path() / "two", folder.path() / "whole");
}

TEST(Run, StartsFromAnotherInASmallerBoxWithEitherStepperAndThroughStops) {
  const ScratchFolder folder;
  ASSERT_EQ(run_in(folder.path() / "one", small_plan()).state, RunState::kDone);
  scene::RunPlan plan = plan_from(0.3);
  plan.system.box_side *= 0.97;
  plan.system.gap *= 0.95;
  const RunOutcome whole = run_in(folder.path() / "whole", plan);
  ASSERT_EQ(whole.state, RunState::kDone) << whole.message;
  run_with_stops(folder.path() / "stopped", plan, {0.0, 0.05});
  ASSERT_EQ(run_in(folder.path() / "stopped", plan).state, RunState::kDone);
  expect_same_results(folder.path() / "stopped", folder.path() / "whole");

  plan.system.stepper = StepperKind::kReference;
  ASSERT_EQ(run_in(folder.path() / "slow", plan).state, RunState::kDone);
  EXPECT_EQ(summary_in(folder.path() / "slow")["state_hash"], summary_in(folder.path() / "whole")["state_hash"]);
}

TEST(Run, StartingFromAStateThatIsNotThereFailsWithTheReason) {
  const ScratchFolder folder;
  EXPECT_THAT(test::said_with(RunState::kFailed, run_in(folder.path() / "two", plan_from(0.3))),
              HasSubstr("from which this one starts, is not in " + folder.path().string()));

  ASSERT_EQ(run_in(folder.path() / "one", small_plan()).state, RunState::kDone);
  EXPECT_THAT(test::said_with(RunState::kFailed, run_in(folder.path() / "earlier", plan_from(0.2))),
              HasSubstr("no state of it at 0.2 s: its last saved state is that at 0.3 s"));

  // a damaged checkpoint is no hindrance where the one before has the state, nor is a copy without it
  const RunDirectory parent{folder.path() / "one"};
  std::filesystem::create_directories(folder.path() / scene::run_id(small_plan()));
  std::filesystem::copy(parent.scene(), folder.path() / scene::run_id(small_plan()) / "scene.json");
  std::filesystem::copy(parent.checkpoint(), parent.previous_checkpoint(),
                        std::filesystem::copy_options::overwrite_existing);
  ASSERT_TRUE(write_file(parent.checkpoint(), "damaged"));
  EXPECT_EQ(run_in(folder.path() / "four", plan_from(0.3)).state, RunState::kDone);
  std::filesystem::copy(parent.previous_checkpoint(), parent.checkpoint(),
                        std::filesystem::copy_options::overwrite_existing);
  std::filesystem::remove_all(folder.path() / scene::run_id(small_plan()));

  scene::RunPlan longer = plan_from(0.3);
  longer.system.box_aspect = 2;
  EXPECT_THAT(run_in(folder.path() / "three", longer).message, HasSubstr("the shape of the box"));
}

}  // namespace
}  // namespace shaken::run
