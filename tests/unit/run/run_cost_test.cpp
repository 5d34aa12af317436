#include "run/cost/run_cost.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "base/files.h"
#include "base/scratch_folder.h"
#include "run/loop/effects.h"
#include "run/loop/loop.h"
#include "run/loop/open_run.h"
#include "scene/length.h"
#include "sim/effects/registry.h"
#include "tests/support/good.h"
#include "tests/unit/run/small_plan.h"

namespace shaken::run {
namespace {

scene::RunPlan busy_plan() {
  scene::RunPlan plan = small_plan(60, 14);
  plan.system.dt = 1e-5;
  plan.measure_time = 1.5;
  plan.tilt = scene::MeasureTilt{0.003, 10};
  plan.g2 = scene::MeasureG2{0.05, 20};
  plan.msd = scene::MeasureMsd{0.01};
  plan.pairs = scene::MeasurePairs{0.1, 21, 0};
  plan.layers = scene::MeasureLayers{0.05};
  plan.lattice = scene::MeasureLattice{0.3};
  return plan;
}

Result<RunCost> probed_from_start(const scene::RunPlan& plan, double cpu) {
  return cost_of_run(plan, Simulation::start(plan.system).value(), cpu);
}

double bytes_of(const std::filesystem::path& file) { return static_cast<double>(std::filesystem::file_size(file)); }

TEST(RunCost, FindsWhatARunThenTakes) {
  const scene::RunPlan plan = busy_plan();
  const auto probed = test::good(probed_from_start(plan, 0.2));

  const ScratchFolder folder;
  ASSERT_EQ(run(plan, options_in(folder.path())).state, RunState::kDone);
  const RunDirectory directory{folder.path()};
  const auto summary = nlohmann::json::parse(*read_file(directory.summary()));

  // counts are exact
  EXPECT_EQ(probed->run_ticks, summary["exit"]["tick"].get<double>());
  for (const auto& [effect, cost] : probed->parts) {
    const char* counted = effect == "trajectory" ? "frames" : "samples";
    EXPECT_EQ(cost.count, summary["effects"][effect][counted].get<std::int64_t>()) << effect;
  }
  EXPECT_EQ(probed->parts.size(), 9u + 1u);
  // files; the probe sees the start only, whose rods still stand in rows and compress better
  EXPECT_NEAR(probed->disk.trajectory / bytes_of(directory.trajectory()), 1, 0.15);
  // how many defects there will be is not known
  EXPECT_NEAR(probed->disk.observables / bytes_of(directory.observables()), 1, 0.4);
  EXPECT_NEAR(probed->disk.checkpoints / bytes_of(directory.checkpoint()), 1, 0.2);
  // of the same order only: the machine may do other things meanwhile
  const double cpu = probed->total() / summary["cpu_seconds"].get<double>();
  EXPECT_GT(cpu, 0.1);
  EXPECT_LT(cpu, 10);
}

// What is kept of a long run is bounded: S(t) and the numbers of defects at 65,536 points, single rods' ways by their
// duration; but for the list of defects. It follows from the plan.
TEST(RunCost, OfOneFrameIsItsFile) {
  scene::RunPlan plan = small_plan(60, 14);
  plan.measure_time = 0.01;
  plan.trajectory = scene::Trajectory{0.1};
  const ScratchFolder folder;
  ASSERT_EQ(run(plan, options_in(folder.path())).state, RunState::kDone);
  const double bytes = bytes_of(RunDirectory{folder.path()}.trajectory());
  EXPECT_NEAR(probed_from_start(plan, 0.01).value().disk.trajectory / bytes, 1, 0.02);
}

TEST(RunCost, OfAMovieIsThatOfItsFrames) {
  scene::RunPlan plan = small_plan();
  plan.movie = scene::Movie{0.01, 320, 240};
  const RunCost cost = probed_from_start(plan, 0.01).value();
  EXPECT_EQ(cost.movie_trouble, "");
  EXPECT_EQ(cost.parts.at("movie").count, std::llround(plan.total_time() / 0.01) + 1);
  EXPECT_GT(cost.cpu_of("movie"), 0);
}

TEST(RunCost, KnowsWhatALongRunThenKeeps) {
  scene::RunPlan nothing = busy_plan();
  static_cast<scene::MeasurePlan&>(nothing) = {};
  nothing.trajectory.reset();
  const auto disk = [&](const scene::RunPlan& plan) { return probed_from_start(plan, 0.01).value().disk; };

  scene::RunPlan plan = nothing;
  plan.measure_time = 6000;
  EXPECT_NEAR(disk(plan).checkpoints / disk(nothing).checkpoints, 2, 0.01) << "the last two";
  plan.order = scene::MeasureOrder{0.001};
  EXPECT_LT(disk(plan).observables, 3e6);
  EXPECT_GT(disk(plan).observables, 32768 * 24);
  plan.order.reset();
  plan.defects = scene::MeasureDefects{0.01, 1.25, 0.3125};
  const double counts = disk(plan).observables;
  EXPECT_LT(counts, 3e6);
  plan.defects->list = true;
  EXPECT_GT(disk(plan).observables, counts + 1e6);

  // against as many samples: 1.5 times what one sample a point has room for, and longer than rods are followed
  plan = nothing;
  plan.measure_time = 100;
  plan.order = scene::MeasureOrder{0.001};
  plan.rods = scene::MeasureRods{0.01, 4, 20};
  plan.steady = 0;
  const RunCost cost = probed_from_start(plan, 0.01).value();
  const DiskUse promised = cost.disk;
  Measurements measurements(plan);
  Snapshot state = Simulation::start(plan.system).value().snapshot();
  const Tick end = scene::total_ticks(plan);
  for (Tick tick = 0; tick <= end; tick = measurements.next_due(tick + 1)) {
    state.tick = tick;
    state.time = static_cast<double>(tick) * plan.system.dt;
    measurements.sample(state);
  }
  // a run that takes long on this machine keeps two
  const double checkpoint = promised.checkpoints / std::min<double>(2, static_cast<double>(cost.checkpoints.count));
  EXPECT_NEAR(checkpoint / static_cast<double>(measurements.save().size()), 1, 0.02);
  const ScratchFolder folder;
  ASSERT_TRUE(write_observables(folder.path() / "observables.h5", measurements.reduce(100).arrays));
  EXPECT_NEAR(promised.observables / bytes_of(folder.path() / "observables.h5"), 1, 0.02);
}

TEST(RunCost, SharesAddUpToTheWhole) {
  const auto probed = test::good(probed_from_start(busy_plan(), 0.1));
  const auto report = cost_report(busy_plan(), *probed);
  EXPECT_GT(report["memory_bytes"].get<double>(), 1e6);
  double sum = 0;
  for (const char* part : {"stepping", "checkpoints"}) {
    sum += report[part + std::string("_cpu_share")].get<double>();
  }
  int n_on = 0;
  for (const auto& effect : report["effects"]) {
    const std::string name = effect["name"];
    const bool besides = name.starts_with("measure_") || name == "trajectory" || name == "stream";
    EXPECT_EQ(effect.contains("cpu_share"), besides && effect["on"]) << name << ": the physics has no share of its own";
    if (effect["on"]) ++n_on;
    if (effect.contains("cpu_share")) sum += effect["cpu_share"].get<double>();
  }
  int n_physics = 0;
  for (const Effect& effect : all_effects()) n_physics += effect.is_on(busy_plan().system) ? 1 : 0;
  EXPECT_EQ(n_on, n_physics + 9 + 1);  // the measurements, the trajectory
  EXPECT_GT(report["stepping_cpu_share"], 0);
  EXPECT_NEAR(sum, 1, 1e-9);
}

TEST(RunCost, GoesOnFromAnyState) {
  const scene::RunPlan plan = busy_plan();
  auto simulation = test::good(Simulation::start(plan.system));
  ASSERT_FALSE(simulation->advance_to(100).has_value());
  const auto probed = test::good(cost_of_run(plan, std::move(simulation).value(), 0.02));
  EXPECT_GT(probed->simulated, 0);
  EXPECT_GT(probed->tick_cpu, 0);
}

TEST(RunCost, EndsInTroubleWithItsWords) {
  scene::RunPlan plan = busy_plan();
  plan.system.amplitude = 5;
  plan.system.dt = 2e-4;  // too long a step for such plates
  EXPECT_THAT(test::refusal(probed_from_start(plan, 0.02)), testing::HasSubstr("numerical trouble at tick"));
}

TEST(Effects, AreListedWithTheKeyThatDecides) {
  scene::RunPlan plan = busy_plan();
  plan.trajectory.reset();
  plan.movie = scene::Movie{};
  std::map<std::string, EffectLine> lines;
  for (const EffectLine& line : list_effects(plan)) EXPECT_TRUE(lines.emplace(line.name, line).second) << line.name;
  EXPECT_TRUE(lines.at("measure_order").on);
  EXPECT_EQ(lines.at("measure_order").why, "measure.order.every = 2 ms");
  EXPECT_TRUE(lines.at("trajectory").on) << "a movie is drawn from it";
  EXPECT_EQ(lines.at("trajectory").why, "movie.every = 50 ms");
  EXPECT_FALSE(lines.at("stream").on);
  EXPECT_EQ(lines.at("stream").why, "stream is absent");
  EXPECT_EQ(lines.at("rod_lid_friction").why, "contacts.rod_lid.friction = 0.01");
}

TEST(Effects, SayWhichOfTheirKeysDecides) {
  scene::RunPlan plan = busy_plan();
  System& system = plan.system;
  const auto why = [&](const std::string& name) {
    const std::vector<EffectLine> lines = list_effects(plan);
    return std::ranges::find(lines, name, &EffectLine::name)->why;
  };
  EXPECT_EQ(why("spin"), why("rod_rod_friction"));
  EXPECT_EQ(why("gravity"), "gravity = 9.81 m/s^2");
  EXPECT_EQ(why("second_vibration"), "plates.second is absent");
  EXPECT_EQ(why("impacts_at_instant"), "time.impacts = \"tick_end\"");
  system.base = false;
  EXPECT_EQ(why("tilt"), "plates.lid = on") << "of several keys the first that is not neutral";
  EXPECT_EQ(why("restitution_speed"), "contacts.rod_rod.restitution_speed = 0 mm/s");
  system.rod_lid.restitution_speed = 30;
  EXPECT_EQ(why("restitution_speed"), "contacts.rod_lid.restitution_speed = 30 mm/s");
  system.added = {AddedRods{}, AddedRods{}};
  system.rod_rod.own[Contacts::place(2, 1)].friction = 0.25;
  system.rod_rod.friction = 0;
  EXPECT_EQ(why("species_contacts"), "contacts.rod_rod.rods_2_rods_3.friction = 0.25");
  EXPECT_EQ(why("rod_rod_friction"), "contacts.rod_rod.rods_2_rods_3.friction = 0.25");
  system.added_noise[1] = 0.2;
  EXPECT_EQ(why("rotational_noise"), "plates.rods_3.noise = 0.2 rad/mm");
}

}  // namespace
}  // namespace shaken::run
