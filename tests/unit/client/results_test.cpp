// SPDX-License-Identifier: MIT
#include "client/results.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "base/failure.h"

namespace shaken::client {
namespace {

/// A row as the daemon sends it; no summary for order < 0.
ResultRow row(double length, int replica, double order, const char* version = "0.1.0") {
  Json json{{"job", "1f0c00000000000" + std::to_string(replica)},
            {"sweep", "s1"},
            {"state", order < 0 ? "queued" : "done"},
            {"label", "rods.length=" + std::to_string(length)},
            {"parameters", {{"rods.length", length}}},
            {"replica", replica},
            {"summary", nullptr}};
  if (order >= 0) {
    json["summary"] = {{"n_rods", 100},
                       {"order", {{"mean", order}, {"sem", 0.125}}},
                       {"collisions", {{"rod_rod", 7}}},
                       {"defects", nullptr},
                       {"versions", {{"shaken", version}}}};
  }
  return result_row(json);
}

TEST(ResultRow, FlattensSummaryAndKeepsDottedParameters) {
  const ResultRow r = row(2.5, 1, 0.75);
  EXPECT_EQ(r.number("rods.length"), 2.5);
  EXPECT_EQ(r.number("order.mean"), 0.75);
  EXPECT_EQ(r.number("collisions.rod_rod"), 7);
  EXPECT_EQ(field_text(r, "versions.shaken"), "0.1.0");
  EXPECT_FALSE(r.fields.contains("defects"));
  EXPECT_TRUE(std::isnan(r.number("state")));
}

// From a table to the files of a run.
TEST(ResultRow, KnowsWhereItsRunIs) {
  Json source = row(2.5, 1, 0.75).source;
  source["directory"] = "/data/runs/1f0c";
  const ResultRow r = result_row(source);
  EXPECT_THAT(to_csv({r}, {}), testing::HasSubstr(",directory,"));
  EXPECT_THAT(to_csv({r}, {}), testing::HasSubstr(",/data/runs/1f0c,"));
  EXPECT_FALSE(aggregated({r})[0].fields.contains("directory")) << "of several runs there is none";
}

TEST(ResultRow, NumberWithUnit) {
  ResultRow r;
  r.fields["box.gap"] = "1.2 mm";
  EXPECT_EQ(r.number("box.gap"), 1.2);
}

TEST(Aggregated, ReplicasOfAPointTogether) {
  const auto points = aggregated({row(2.5, 1, 0.25), row(4.5, 1, 0.75), row(2.5, 2, 0.5), row(4.5, 2, 0.75)});
  ASSERT_EQ(points.size(), 2u);
  EXPECT_EQ(points[0].number("rods.length"), 2.5);
  EXPECT_EQ(points[0].number("n_replicas"), 2);
  EXPECT_EQ(points[0].number("n_done"), 2);
  EXPECT_DOUBLE_EQ(points[0].number("order.mean"), 0.375);
  EXPECT_DOUBLE_EQ(points[0].number("order.sem"), 0.125);  // |0.5 - 0.25| / 2
  // Two runs that happen to agree are no better than their own errors, 0.125 each, make them.
  EXPECT_DOUBLE_EQ(points[1].number("order.sem"), 0.125 / std::sqrt(2.0));
  EXPECT_FALSE(points[0].fields.contains("order.mean:sem")) << "one name, in rows of runs and of points";
}

TEST(Aggregated, OneReplicaKeepsItsOwnStandardError) {
  const auto points = aggregated({row(2.5, 1, 0.25)});
  ASSERT_EQ(points.size(), 1u);
  EXPECT_DOUBLE_EQ(points[0].number("order.sem"), 0.125);
}

TEST(Aggregated, NeverMixesVersions) {
  const auto points = aggregated({row(2.5, 1, 0.25, "0.1.0"), row(2.5, 2, 0.75, "0.2.0")});
  ASSERT_EQ(points.size(), 2u);
  EXPECT_DOUBLE_EQ(points[0].number("order.mean"), 0.25);
  EXPECT_DOUBLE_EQ(points[1].number("order.mean"), 0.75);
}

TEST(Aggregated, NeverMixesVersionsOfThePhysics) {
  const auto of = [](int replica, double order, int physics) {
    ResultRow made = row(2.5, replica, order, "0.1.0");
    made.fields["versions.physics"] = physics;
    return made;
  };
  const std::vector<ResultRow> rows{of(1, 0.25, 3), of(2, 0.75, 4), of(3, 0.5, 4)};
  const auto points = aggregated(rows);
  ASSERT_EQ(points.size(), 2u);
  EXPECT_DOUBLE_EQ(points[0].number("order.mean"), 0.25);
  EXPECT_DOUBLE_EQ(points[1].number("order.mean"), 0.625);
  EXPECT_EQ(version_of(points[1]).text(), "shaken 0.1.0, physics 4");
  EXPECT_FALSE(points[1].fields.contains("versions.physics:sem")) << "a name, not a number";
  EXPECT_TRUE(has_several_versions(rows));
  EXPECT_FALSE(has_several_versions({rows[1], rows[2]}));
}

TEST(Aggregated, WhatNoVersionIsKnownOfIsAPointOfItsOwn) {
  ResultRow old = row(2.5, 1, 0.25);
  old.fields.erase("versions.shaken");
  const auto points = aggregated({old, row(2.5, 2, 0.75), row(2.5, 3, -1)});
  ASSERT_EQ(points.size(), 2u);
  EXPECT_DOUBLE_EQ(points[0].number("order.mean"), 0.25);
  EXPECT_EQ(points[0].number("n_replicas"), 1);
  EXPECT_DOUBLE_EQ(points[1].number("order.mean"), 0.75);
  EXPECT_EQ(points[1].number("n_replicas"), 2) << "the one that has yet to run";
}

TEST(Aggregated, EveryMeanHasItsStandardErrorAndThePointItsState) {
  std::vector<ResultRow> rows{row(2.5, 1, 0.25), row(2.5, 2, 0.5)};
  rows[0].fields["cpu_seconds"] = 3.0, rows[1].fields["cpu_seconds"] = 5.0;
  const auto points = aggregated(rows);
  ASSERT_EQ(points.size(), 1u);
  EXPECT_EQ(field_text(points[0], "state"), "done");
  for (const auto& [name, value] : points[0].fields.items()) {
    const bool is_count = name == "n_replicas" || name == "n_done" || name.ends_with(":sem");
    if (!value.is_number() || is_count || points[0].parameters.contains(name)) continue;
    if (name == error_field("order.mean")) continue;
    EXPECT_GE(points[0].number(error_field(name)), 0) << name;
  }
  // no errors of their own: |5 - 3| / 2, widened to what 68 % of two runs are within
  EXPECT_DOUBLE_EQ(points[0].number("cpu_seconds:sem"), student_factor(2));
  EXPECT_EQ(field_text(aggregated({rows[0], row(2.5, 2, -1)})[0], "state"), "partial");
}

TEST(Aggregated, KeysOfTheScenesAreNotAveraged) {
  std::vector<ResultRow> rows{row(2.5, 1, 0.25), row(2.5, 2, 0.5)};
  for (int k : {0, 1}) {
    rows[k].scene = {{"box.gap", 1.2}, {"time.seed", 7 + k}};
    for (const auto& [path, value] : rows[k].scene.items()) rows[k].fields[path] = value;
  }
  const auto points = aggregated(rows);
  ASSERT_EQ(points.size(), 1u);
  EXPECT_EQ(points[0].fields.at("box.gap"), 1.2);
  EXPECT_FALSE(points[0].fields.contains("box.gap:sem"));
  EXPECT_FALSE(points[0].fields.contains("time.seed")) << "each has its own";
}

TEST(Aggregated, UnfinishedReplicasCountButDoNotEnterTheMean) {
  const auto points = aggregated({row(2.5, 1, 0.25), row(2.5, 2, -1), row(2.5, 3, 0.5)});
  ASSERT_EQ(points.size(), 1u);
  EXPECT_EQ(points[0].number("n_replicas"), 3);
  EXPECT_EQ(points[0].number("n_done"), 2);
  EXPECT_DOUBLE_EQ(points[0].number("order.mean"), 0.375);
}

/// A row whose summary says whether it came to rest.
ResultRow row_with_verdict(int replica, const Json& steady, const Json& theta_m_steady = nullptr) {
  ResultRow source = row(2.5, replica, 0.5);
  Json json = source.source;
  json["summary"]["steady"] = steady;
  json["summary"]["order"]["steady"] = steady;
  json["summary"]["order"]["n_effective"] = 20.0;
  json["summary"]["measured"]["theta_m_deg"] = {
      {"value", 8.5}, {"sem", 0.5}, {"n_effective", 10.0}, {"steady", theta_m_steady}};
  return result_row(json);
}

TEST(Steadiness, OwnVerdictFirstThenThatOfTheRun) {
  const ResultRow relaxing = row_with_verdict(1, false), settled = row_with_verdict(2, true, false);
  EXPECT_EQ(steadiness(relaxing, "order.mean"), Steadiness::kRelaxing);
  EXPECT_EQ(steadiness(relaxing, "measured.theta_m_deg.value"), Steadiness::kRelaxing)
      << "unknown, in a run that relaxes";
  EXPECT_NE(steadiness(relaxing, "cpu_seconds"), Steadiness::kRelaxing);
  EXPECT_NE(steadiness(relaxing, "order.t_steady_s"), Steadiness::kRelaxing);
  EXPECT_NE(steadiness(settled, "order.mean"), Steadiness::kRelaxing);
  EXPECT_EQ(steadiness(settled, "measured.theta_m_deg.value"), Steadiness::kRelaxing);
  // Of an older version: nothing is known.
  EXPECT_NE(steadiness(row(2.5, 1, 0.5), "order.mean"), Steadiness::kRelaxing);
}

TEST(Aggregated, OneReplicaThatRelaxesMakesThePointRelax) {
  const auto mixed = aggregated({row_with_verdict(1, true, true), row_with_verdict(2, false, true)});
  ASSERT_EQ(mixed.size(), 1u);
  EXPECT_EQ(steadiness(mixed[0], "order.mean"), Steadiness::kRelaxing);
  EXPECT_NE(steadiness(mixed[0], "measured.theta_m_deg.value"), Steadiness::kRelaxing);
  const auto turned = aggregated({row_with_verdict(1, false, true), row_with_verdict(2, true, true)});
  EXPECT_EQ(steadiness(turned[0], "order.mean"), Steadiness::kRelaxing) << "whichever of them it is";
  const auto settled = aggregated({row_with_verdict(1, true), row_with_verdict(2, true)});
  EXPECT_EQ(settled[0].fields.at("order.steady"), true);
  EXPECT_TRUE(settled[0].fields.at("measured.theta_m_deg.steady").is_null()) << "nobody knows";
  EXPECT_EQ(settled[0].number("order.n_effective"), 40) << "samples add up";
  EXPECT_DOUBLE_EQ(settled[0].number("measured.theta_m_deg.sem"), 0.5 / std::sqrt(2.0));
}

// theta_m has no value where P(theta) has one peak: of three runs one may have one, and that is what there is to say.
TEST(Aggregated, AMeanIsOfTheRunsThatHaveAValueAndSaysHowMany) {
  std::vector<ResultRow> rows{row_with_verdict(1, true), row_with_verdict(2, true), row_with_verdict(3, true)};
  rows[1].fields["measured.theta_m_deg.value"] = nullptr;
  rows[2].fields["measured.theta_m_deg.value"] = nullptr;
  const ResultRow point = aggregated(rows)[0];
  EXPECT_EQ(point.number("measured.theta_m_deg.value"), 8.5);
  EXPECT_EQ(point.number("measured.theta_m_deg.value:n"), 1);
  EXPECT_FALSE(point.fields.contains("order.mean:n")) << "all have one";
  rows[0].fields["measured.theta_m_deg.value"] = nullptr;
  EXPECT_TRUE(aggregated(rows)[0].fields.at("measured.theta_m_deg.value").is_null()) << "asked for, and no value";
  EXPECT_EQ(resolved_field(rows, "theta_m_deg"), "measured.theta_m_deg.value")
      << "a field that is null everywhere is there";
  EXPECT_EQ(field_text(rows[0], "measured.theta_m_deg.value"), "");
}

// The window of mean velocities, say, is no result: replicas have it in common.
TEST(Aggregated, TheTimeThatANumberIsTakenOverIsThatOfItsRuns) {
  std::vector<ResultRow> rows{row_with_verdict(1, true), row_with_verdict(2, true)};
  for (ResultRow& row : rows) row.fields["measured.velocity_rms_mm_s.over_s"] = 0.4;
  const ResultRow point = aggregated(rows)[0];
  EXPECT_EQ(point.number("measured.velocity_rms_mm_s.over_s"), 0.4);
  EXPECT_FALSE(point.fields.contains("measured.velocity_rms_mm_s.over_s:sem"));
}

// Points of a sweep that are the same run, such as those of a whole number drawn eight times of 1 and 2: the run is one
// sample, however often it is listed.
TEST(Aggregated, ARunThatIsListedTwiceCountsOnce) {
  const ResultRow once = row_with_verdict(1, true);
  const ResultRow point = aggregated({once, once, once, once})[0];
  EXPECT_EQ(point.number("n_replicas"), 1);
  EXPECT_EQ(point.number("n_done"), 1);
  EXPECT_EQ(point.number("order.n_effective"), once.number("order.n_effective"));
  EXPECT_EQ(point.number("order.sem"), once.number("order.sem"));
  const ResultRow two = aggregated({once, row_with_verdict(2, true), once})[0];
  EXPECT_EQ(two.number("n_replicas"), 2);
}

// A run that was done, was asked to go on and is held on its way has results all the time.
TEST(Aggregated, ARunThatGoesOnForLongerStillCounts) {
  Json held = row_with_verdict(1, true).source;
  held["state"] = "held";
  EXPECT_EQ(aggregated({result_row(held)})[0].number("n_done"), 0);
  held["summary"]["exit"] = {{"state", "stopped"}, {"done_before_s", 20.0}};
  const ResultRow point = aggregated({result_row(held), row_with_verdict(2, true)})[0];
  EXPECT_EQ(point.number("n_done"), 2);
  EXPECT_EQ(point.state, "partial");
  held["state"] = "running";
  held["summary"]["exit"] = {{"state", "done"}};
  EXPECT_EQ(aggregated({result_row(held)})[0].number("n_done"), 1);
}

TEST(Steadiness, ThreeStatesHaveThreeMarks) {
  EXPECT_EQ(steadiness(row_with_verdict(1, true), "order.mean"), Steadiness::kSteady);
  EXPECT_EQ(steadiness(row_with_verdict(1, false), "order.mean"), Steadiness::kRelaxing);
  EXPECT_EQ(steadiness(row_with_verdict(1, nullptr), "order.mean"), Steadiness::kNotKnown);
  EXPECT_EQ(steadiness(row_with_verdict(1, nullptr), "cpu_seconds"), Steadiness::kSteady) << "no average";
  EXPECT_EQ(mark_of(Steadiness::kSteady) + std::string(mark_of(Steadiness::kRelaxing)) + mark_of(Steadiness::kNotKnown),
            "~?");
}

TEST(ResolvedField, MeasuredScalarsByTheirName) {
  const std::vector<ResultRow> rows{row_with_verdict(1, true)};
  EXPECT_EQ(resolved_field(rows, "order.mean"), "order.mean");
  EXPECT_EQ(resolved_field(rows, "theta_m_deg"), "measured.theta_m_deg.value");
  EXPECT_EQ(resolved_field(rows, "S"), "order.mean") << "as tables and figures have it";
  EXPECT_THROW((void)resolved_field(rows, "theta"), Failure);
  const std::pair<const char*, const char*> slips[] = {{"theta_m", "did you mean theta_m_deg?"},
                                                       {"tehta_m_deg", "did you mean theta_m_deg?"},
                                                       {"order.maen", "did you mean order.mean?"}};
  for (const auto& [word, hint] : slips) {
    try {
      (void)resolved_field(rows, word);
      ADD_FAILURE() << word;
    } catch (const Failure& failure) {
      EXPECT_NE(std::string(failure.what()).find(hint), std::string::npos) << failure.what();
    }
  }
  EXPECT_EQ(resolved_field(rows, "order.sem"), "order.sem");
  for (const auto& some : {rows, aggregated(rows)}) {
    EXPECT_EQ(resolved_field(some, "order.sem"), "order.sem") << "the error that a mean has";
    for (const char* word : {"theta_m_deg.sem", "theta_m_deg:sem", "measured.theta_m_deg.sem"})
      EXPECT_EQ(resolved_field(some, word), "measured.theta_m_deg.sem") << word;
  }
}

TEST(SweptParameters, OnlyThoseThatDiffer) {
  ResultRow a;
  a.parameters = {{"rods.length", 2.5}, {"box.gap", 1.2}};
  ResultRow b;
  b.parameters = {{"rods.length", 3.5}, {"box.gap", 1.2}};
  EXPECT_EQ(swept_parameters({a, b}), std::vector<std::string>{"rods.length"});
}

TEST(ToCsv, OneLinePerRowWithGapsWhereAFieldIsMissing) {
  ResultRow a;
  a.fields = {{"label", "l=1, w=2"}, {"n", 3}};
  ResultRow b;
  b.fields = {{"label", "x"}, {"s", 0.5}};
  EXPECT_EQ(to_csv({a, b}), "label,n,s\n\"l=1, w=2\",3,\nx,,0.5\n");
  EXPECT_EQ(to_csv({a, b}, {"s", "n"}), "s,n\n,3\n0.5,\n");
  EXPECT_EQ(to_csv({}), "");
}

}  // namespace
}  // namespace shaken::client
