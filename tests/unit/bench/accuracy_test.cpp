#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <string>

#include "bench/accuracy/errors.h"

namespace shaken::bench {
namespace {

World two_rods() {
  System scene;
  scene.n_rods = 2;
  scene.box_side = 20;
  World world = empty_world(scene);
  world.rods.resize(2);
  for (Flight& flight : world.rods) {
    flight.position = {1, 10, 1};
    flight.velocity = {30, 0, 0};
    flight.prepare();
  }
  return world;
}

TEST(Errors, AreNoneBetweenEquals) { EXPECT_EQ(errors_between(two_rods(), two_rods()), (Errors{0, 0, 0})); }

TEST(Errors, OfPositionsAreRootMeanSquares) {
  World moved = two_rods();
  moved.rods[1].position += Vec3(0, 3e-3, 4e-3);
  EXPECT_NEAR(errors_between(moved, two_rods())[0], 5e-3 / std::sqrt(2), 1e-15);
}

TEST(Errors, AreOfUnwrappedPositions) {
  // 0.5 mm apart, across the box's border
  World truth = two_rods();
  World moved = two_rods();
  for (int i = 0; i < 2; ++i) {
    truth.rods[i].position.x() = 0.25;
    moved.rods[i].position.x() = 19.75;
    moved.rods[i].image[0] = -1;
  }
  EXPECT_NEAR(errors_between(moved, truth)[0], 0.5, 1e-12);
  moved.rods[0].image[0] = moved.rods[1].image[0] = 0;  // as far apart as it looks
  EXPECT_NEAR(errors_between(moved, truth)[0], 19.5, 1e-12);
}

TEST(Errors, OfDirectorsAreAngles) {
  for (const double angle : {1e-9, 0.1, 2.0}) {
    World turned = two_rods();
    for (Flight& flight : turned.rods) {
      flight.director = {std::cos(angle), std::sin(angle), 0};
      flight.prepare();
    }
    EXPECT_NEAR(errors_between(turned, two_rods())[1], angle, 1e-12 * angle);
  }
}

TEST(Errors, OfEnergyAreRelative) {
  World faster = two_rods();
  for (Flight& flight : faster.rods) flight.velocity *= 1.1;
  EXPECT_NEAR(errors_between(faster, two_rods())[2], 0.21, 1e-12);
}

TEST(Quartiles, AreBetweenNeighbours) {
  EXPECT_EQ(quartiles_of({4, 1, 3, 2}), Json::parse(R"({"lower": 1.75, "median": 2.5, "upper": 3.25})"));
  EXPECT_EQ(quartiles_of({7}).at("upper"), 7);
  EXPECT_TRUE(quartiles_of({}).at("median").is_null());
}

TEST(StartCases, LastWholeNumbersOfTheLongestStep) {
  for (const StartCase& start : start_cases()) {
    const double steps = start.duration / kLongestStep;
    EXPECT_NEAR(steps, std::round(steps), 1e-9) << start.name;
  }
}

TEST(StartCases, BeginApartAndThenHit) {
  for (const StartCase& start : start_cases()) {
    for (int member = 0; member < 3; ++member) {
      const std::vector<Flight> rods = start.rods(member);
      ASSERT_EQ(rods.size(), static_cast<std::size_t>(start.scene.n_rods)) << start.name;
      Simulation simulation = begin(start, rods, variants().front(), StepperKind::kScheduled, 1e-6);
      if (start.name != "hundred") {  // which is caught in the middle of its motion
        ASSERT_FALSE(simulation.advance_to(1));
        EXPECT_EQ(simulation.world().counters.max_overlap(), 0) << start.name << " begins with an overlap";
      }
      ASSERT_FALSE(simulation.advance_to(std::llround(start.duration / 1e-6))) << start.name;
      const Counters& done = simulation.world().counters;
      EXPECT_GT(done.impulses_rod_rod + done.impulses_rod_base + done.impulses_rod_lid, 0) << start.name;
    }
  }
}

// Errors are compared from one version to the next: each case begins where it did.
TEST(StartCases, BeginAsTheyDidAndMembersDiffer) {
  const std::map<std::string, std::string> known{
      {"rattling", "2b01a83ba4e45b8c in 30 mm"},    {"wedged", "1d3489c2a3fc822b in 30 mm"},
      {"head-on", "3c377257cb131899 in 30 mm"},     {"glancing", "77991c97bf4d0b10 in 30 mm"},
      {"crossing", "9e08a8a8e4267ba2 in 30 mm"},    {"dozen", "924bfbe77a088a31 in 20 mm"},
      {"hundred", "c6b9823b7d4d21a1 in 18.235 mm"},
  };
  for (const StartCase& start : start_cases()) {
    const std::vector<Flight> rods = start.rods(1);
    EXPECT_NE(start.rods(0)[0].velocity, rods[0].velocity) << start.name;
    const Simulation begun = begin(start, rods, variants().front(), StepperKind::kScheduled, kLongestStep);
    EXPECT_EQ(fmt::format("{:016x} in {} mm", begun.state_hash(), start.scene.box_side), known.at(start.name));
  }
}

TEST(StartCases, AreTheSameAtAnyStep) {
  // up to the first impact flight is exact, whatever the step
  const StartCase& start = start_cases().front();
  const std::vector<Flight> rods = start.rods(0);
  Simulation coarse = begin(start, rods, variants().front(), StepperKind::kReference, kLongestStep);
  Simulation fine = begin(start, rods, variants().front(), StepperKind::kScheduled, kLongestStep / 16);
  ASSERT_FALSE(coarse.advance_to(4));
  ASSERT_FALSE(fine.advance_to(64));
  EXPECT_LT((coarse.snapshot().position[0] - fine.snapshot().position[0]).norm(), 1e-13);
}

// One rod that rattles, at its longest steps: errors grow with the step, and those of either stepper are the same.
TEST(Convergence, IsMeasuredOfEveryStepAgainstOneSolution) {
  const StartCase& start = start_cases().front();
  const ConvergenceEffort effort{.steps = {kLongestStep / 4, kLongestStep}, .members = 3};
  const Json of = measure_convergence(start, variants().at(2), effort);
  ASSERT_EQ(of.at("rows").size(), 2u);
  for (std::size_t k = 0; k < 2; ++k) {
    const Json& row = of.at("rows").at(k);
    EXPECT_EQ(row.at("dt_s"), effort.steps[k]);
    EXPECT_EQ(row.at("in_trouble"), 0);
    EXPECT_TRUE(row.at("states_equal").get<bool>());
  }
  const auto position = [&](const Json& errors) { return errors.at("position").at("median").get<double>(); };
  const double fine = position(of.at("rows").at(0).at("error")), coarse = position(of.at("rows").at(1).at("error"));
  EXPECT_GT(fine, position(of.at("converged").at("error")));
  EXPECT_GT(coarse, fine);
  EXPECT_LT(coarse, 0.1);
  EXPECT_EQ(of.at("converged").at("dt_s"), effort.steps.front() / 64);
  EXPECT_GT(of.at("converged").at("impulses").get<double>(), 1);
  EXPECT_TRUE(of.at("converged").contains("from_first"));
  EXPECT_FALSE(measure_convergence(start, variants().front(), effort).at("converged").contains("from_first"));
}

}  // namespace
}  // namespace shaken::bench
