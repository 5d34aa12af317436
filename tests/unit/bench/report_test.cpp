#include "bench/report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "base/failure.h"
#include "bench/bench.h"
#include "bench/kinds.h"
#include "bench/rates.h"
#include "scene/canonical.h"

namespace shaken::bench {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

Contender contender(double cpu) {
  Contender of{.scene = make_case(4.5, 0.6, 12, kPaperStep, 5), .state = {}};
  of.speed.ticks = 1250;
  of.speed.cpu = {cpu * 1.5, cpu, cpu * 1.1};
  of.speed.wall = of.speed.cpu;
  of.speed.rod_seconds = 10;
  of.speed.plate_impulses = 900;
  of.speed.rod_impulses = 100;
  of.speed.max_overlap = of.scene.system().rod.mid_diameter / 8;
  return of;
}

CountedWork work() {
  CountedWork work{.rod_seconds = 5, .cpu = 0.1, .in_loops = 0.075};
  work.counts.fill(500);
  work.phases.fill(0.01);
  return work;
}

Json row(std::uint64_t scheduled_hash = 0) {
  return steppers_row(contender(0.1), contender(2), work(), 9, scheduled_hash);
}

TEST(Table, ShowsMembersOfRowsInTheirFormats) {
  const Json rows = Json::parse(R"([{"n": 12, "of": {"mean": 0.12345, "sem": 0.002}, "same": true, "why": "so"},
                                    {"n": 3, "of": {"mean": -1, "sem": 0.5}, "same": false}])");
  EXPECT_EQ(table(rows, {{"N", "n"},
                         {"%", "of/mean", "{:.1f}", 100},
                         {"mean", "of/mean", "{:.2f} +- {:.1g}", 1, "of/sem"},
                         {"same", "same"},
                         {"why", "why"}}),
            " N       %           mean  same  why\n"
            "12    12.3  0.12 +- 0.002   yes  so\n"
            " 3  -100.0   -1.00 +- 0.5    NO  -\n");
}

TEST(Csv, NamesNestedValuesWithDots) {
  EXPECT_EQ(csv(Json::parse(R"([{"a": {"b": 1, "c": "x"}, "d": [1, 2]}, {"a": {"b": 2, "c": "y"}, "d": [3, 4]}])")),
            "a.b,a.c,d\n1,x,1 2\n2,y,3 4\n");
  EXPECT_EQ(csv(Json::parse(R"([{"a": "x, \"y\""}])")), "a\n\"x, \"\"y\"\"\"\n");
  EXPECT_EQ(csv(Json::parse(R"([{"a": 1}, {"a": 2, "b": 3}])")), "a,b\n1,\n2,3\n") << "what is missing is empty";
}

/// What the options of a bench read, or the words of the error.
struct Asked {
  double side = 20;
  int repeat = 5;
  std::vector<double> lengths;
  std::string problem;
};
Asked asked(std::vector<std::string> words) {
  Asked asked;
  CLI::App app;
  add_number(app, "--side", asked.side, "MM", {9, 500}, "");
  add_number(app, "--repeat", asked.repeat, "N", {1, 10}, "");
  add_number(app, "--length", asked.lengths, "LIST", {0, 50}, "");
  try {
    std::reverse(words.begin(), words.end());
    app.parse(words);
  } catch (const CLI::ParseError& error) {
    asked.problem = error.what();
  }
  return asked;
}

TEST(Options, AreNumbersWithinTheirRanges) {
  EXPECT_EQ(asked({}).side, 20);
  EXPECT_EQ(asked({"--side", "12.5"}).side, 12.5);
  EXPECT_EQ(asked({"--length", "4.5,2.5"}).lengths, (std::vector{4.5, 2.5}));
  EXPECT_THAT(asked({"--side", "5"}).problem, HasSubstr("--side: 5 is outside [9, 500]"));
  EXPECT_THAT(asked({"--side", "long"}).problem, HasSubstr("--side: 'long' is not a number"));
  EXPECT_THAT(asked({"--length", "4.5,60"}).problem, HasSubstr("--length: 60 is outside [0, 50]"));
  EXPECT_THAT(asked({"--repeat", "2.5"}).problem, HasSubstr("--repeat = 2.5"));
}

TEST(Rates, OfBothSteppersHaveTheirRatio) {
  EXPECT_DOUBLE_EQ(row().at("scheduled").at("rod_s_per_cpu_s"), 100);
  EXPECT_DOUBLE_EQ(row().at("scheduled").at("spread"), 1.1);
  EXPECT_DOUBLE_EQ(row().at("scheduled").at("ns_per_impulse"), 1e5);
  EXPECT_DOUBLE_EQ(row().at("scheduled").at("impulses_per_rod_second").at("plates"), 90);
  EXPECT_DOUBLE_EQ(row().at("ratio"), 20);
  EXPECT_DOUBLE_EQ(row().at("max_overlap_of_thickness"), 0.125);
  EXPECT_EQ(row(0xab).at("scheduled").at("state_hash"), "00000000000000ab");
}

TEST(Rates, SayWhatIsNotTheSteadyState) {
  Conditions conditions;
  for (const bool steady : {false, true}) {
    conditions.warm_up = steady ? Conditions::kSteady : 0.5;
    const Report report = rates_report(conditions, Comparison::kSteppers, Json::array({row()}));
    EXPECT_EQ(report.text.find("NOT the steady state") == std::string::npos, steady);
    EXPECT_EQ(report.json.at("warm_up_s"), conditions.warm_up);
    EXPECT_EQ(report.json.at("steady"), steady);
    EXPECT_EQ(report.json.at("repeat"), conditions.effort.repeat);
  }
}

TEST(Rates, SayIfTheSteppersDiffer) {
  const Report same = rates_report({}, Comparison::kSteppers, Json::array({row()}));
  EXPECT_THAT(same.text, Not(HasSubstr("NO\n")));
  check_states(same, "they differ");
  const Report report = rates_report({}, Comparison::kSteppers, Json::array({row(1)}));
  EXPECT_THAT(report.text, HasSubstr("NO\n"));
  EXPECT_THAT([&] { check_states(report, "they differ"); },
              testing::ThrowsMessage<Failure>("l = 4.5 mm, phi = 0.6, L = 12 mm: they differ after 9 ticks"));
}

TEST(Rates, OfWorkArePerRodSecondAndPerPiece) {
  EXPECT_DOUBLE_EQ(row().at("per_rod_second").at("pairs_bounded"), 100);
  EXPECT_DOUBLE_EQ(row().at("ns").at("rods_visited"), 20'000);
  EXPECT_DOUBLE_EQ(row().at("phase_shares").at("pair_bounds"), 0.1);
  EXPECT_NEAR(row().at("phase_shares").at("other"), 0.2, 1e-12);
  constexpr const char* kTitle = "Where the scheduled stepper's CPU time goes";
  EXPECT_THAT(rates_report({}, Comparison::kSteppers, Json::array({row()})).text, HasSubstr(kTitle));
  const Json threads = threads_row(contender(0.1), contender(0.1), work());
  EXPECT_THAT(rates_report({}, Comparison::kThreads, Json::array({threads})).text, Not(HasSubstr(kTitle)));
}

TEST(Rates, OfASeriesAreRelativeToTheFirst) {
  EXPECT_DOUBLE_EQ(rate_row(contender(0.1), contender(0.1), work()).at("relative_cost"), 1);
  EXPECT_DOUBLE_EQ(rate_row(contender(0.15), contender(0.1), work()).at("relative_cost"), 1.5);
}

TEST(Rates, OfThreadsNameTheSpeedUpAndItsLimit) {
  const Contender first = contender(0.2);
  Contender four = contender(0.1);
  four.threads = 4;
  EXPECT_DOUBLE_EQ(threads_row(four, first, work()).at("speed_up"), 2);
  EXPECT_DOUBLE_EQ(threads_row(first, first, work()).at("limit"), 1);
  EXPECT_DOUBLE_EQ(threads_row(four, first, work()).at("limit"), 1 / (0.25 + 0.75 / 4));
  EXPECT_TRUE(threads_row(four, first, work()).at("hashes_equal"));
  four.hash = 8;
  EXPECT_FALSE(threads_row(four, first, work()).at("hashes_equal"));
}

Case kind_named(const std::string& name) {
  for (const SceneKind& kind : scene_kinds()) {
    if (name == kind.name) return case_of(kind, 0.5);
  }
  throw Failure(ExitCode::kFailed, "no kind " + name);
}

TEST(Kinds, CanAllBePlaced) {
  for (const SceneKind& kind : scene_kinds()) {
    const Result<Simulation> started = Simulation::start(case_of(kind, 0.5).system());
    EXPECT_TRUE(started) << kind.name << ": " << (started ? "" : started.error().message);
  }
}

TEST(Kinds, AreAllDifferentScenes) {
  std::set<std::string> names, scenes;
  for (const SceneKind& kind : scene_kinds()) {
    EXPECT_TRUE(names.insert(kind.name).second) << kind.name;
    EXPECT_TRUE(scenes.insert(scene::scene_hash(case_of(kind, 0.5).plan)).second) << kind.name;
  }
}

TEST(Kinds, BeginWithTheBase) {
  const Case base = case_of(scene_kinds().front(), 0.5);
  EXPECT_EQ(base.plan, make_case(4.5, 0.75, 41.865, kPaperStep, 0.5).plan);
}

TEST(Kinds, AreWhatTheirNamesSay) {
  EXPECT_EQ(kind_named("spheres").system().rod.n_beads, 1);
  EXPECT_TRUE(kind_named("two species").system().added[0]);
  EXPECT_EQ(kind_named("polar, annulus").system().walls->arena, Arena::kAnnulus);
  EXPECT_EQ(kind_named("polar, annulus").n_rods(), 175);
  EXPECT_EQ(kind_named("plates at rest").system().amplitude, 0);
}

}  // namespace
}  // namespace shaken::bench
