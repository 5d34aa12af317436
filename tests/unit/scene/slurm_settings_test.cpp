#include "scene/sweeps/slurm_settings.h"

#include <gmock/gmock.h>

#include "scene/canonical.h"
#include "scene/sweeps/sweep_keys.h"
#include "tests/support/generated_page.h"
#include "tests/unit/scene/scene_support.h"

namespace shaken::scene {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

std::string refusal(const std::string& keys) {
  const Loaded<Sweep> sweep = load_sweep("{" + keys + R"(, "sweep": {}})", "s.json");
  return sweep ? "accepted" : to_string(sweep.error());
}

TEST(SlurmSettings, AreReadAndKept) {
  const Loaded<Sweep> sweep = load_sweep(R"({"executor": "slurm", "scene": {}, "slurm": {
      "partition": "short,long", "account": "soft-matter", "time": "90 min", "memory": "4G", "runs_per_task": 20,
      "options": ["--constraint=avx2", "--exclusive"]}})",
                                         "s.json");
  ASSERT_TRUE(sweep) << to_string(sweep.error());
  EXPECT_EQ(sweep->executor, "slurm");
  EXPECT_EQ(sweep->slurm.partition, "short,long");
  EXPECT_EQ(sweep->slurm.account, "soft-matter");
  EXPECT_DOUBLE_EQ(sweep->slurm.time, 5400);
  EXPECT_EQ(sweep->slurm.memory, "4G");
  EXPECT_EQ(sweep->slurm.runs_per_task, 20);
  EXPECT_THAT(sweep->slurm.options, ElementsAre("--constraint=avx2", "--exclusive"));
  EXPECT_EQ(slurm_settings(to_text(sweep->slurm)), sweep->slurm);
  EXPECT_EQ(to_text(SlurmSettings{}), "");
  EXPECT_EQ(slurm_settings(""), SlurmSettings{});
}

TEST(SlurmSettings, AreNoPartOfTheNameOfARun) {
  const Loaded<Sweep> plain = load_sweep(R"({"scene": {}, "sweep": {}})", "s.json");
  const Loaded<Sweep> there = load_sweep(R"({"executor": "slurm", "slurm": {"time": "2 h"}, "scene": {}})", "s.json");
  ASSERT_TRUE(plain && there);
  EXPECT_EQ(run_id(plain->points.at(0).plan), run_id(there->points.at(0).plan));
}

TEST(SlurmSettings, WhatIsWrongIsRefusedWithItsPlace) {
  EXPECT_THAT(refusal(R"("executor": "slrum")"),
              HasSubstr("s.json:1:14: /executor: \"slrum\" is not one of \"local\", \"slurm\""));
  EXPECT_THAT(refusal(R"("executor": "slrum")"), HasSubstr("did you mean slurm?"));
  EXPECT_THAT(refusal(R"("slurm": 3)"), HasSubstr("/slurm: expected an object"));
  EXPECT_THAT(refusal(R"("slurm": {"partion": "a"})"),
              HasSubstr("/slurm/partion: unknown key; did you mean slurm.partition?"));
  EXPECT_THAT(refusal(R"("slurm": {"time": "20 s"})"), HasSubstr("/slurm/time: 20 s is outside"));
  EXPECT_THAT(refusal(R"("slurm": {"time": "4 mm"})"), HasSubstr("/slurm/time"));
  EXPECT_THAT(refusal(R"("slurm": {"memory": "4 GB"})"), HasSubstr("/slurm/memory: expected a whole number with K"));
  EXPECT_THAT(refusal(R"("slurm": {"runs_per_task": 0})"), HasSubstr("/slurm/runs_per_task"));
  for (const char* word : {"", "-x", "a b", "a;b", "$(id)", "a\\nb"}) {
    EXPECT_THAT(refusal(std::string(R"("slurm": {"partition": ")") + word + "\"}"), HasSubstr("/slurm/partition"))
        << word;
  }
}

TEST(SlurmSettings, OptionsThatCouldDoOtherThanWhatTheySayAreRefused) {
  for (const char* fine : {"--constraint=avx2", "--qos=low", "--exclusive", "--mail-user=a b;c", "--mem-per-cpu=2G"}) {
    EXPECT_FALSE(slurm_option_problem(fine)) << fine;
  }
  for (const char* bad : {"", "-p", "--", "-p short", "--qos low", "constraint", "script.sh", "--qos=a\nb",
                          "--qos=\x7f", "---", "--Q=1"}) {
    EXPECT_TRUE(slurm_option_problem(bad)) << bad;
  }
  // the daemon's own, and their beginnings, which sbatch takes for them
  for (const char* reserved : {"--array=0-9", "--arr=3", "--job-name=x", "--job=x", "--wrap=id", "--output=/x",
                               "--wait", "--chdir=/", "--parsable", "--test-only", "--no-requeue"}) {
    EXPECT_THAT(slurm_option_problem(reserved).value_or(""), HasSubstr("is set by the daemon")) << reserved;
  }
}

// The table in docs/cluster.md. To write it anew: SHAKEN_UPDATE_DOCS=1 and run this test.
TEST(SlurmSettings, TheReferenceIsUpToDate) {
  expect_generated(SHAKEN_SOURCE_DIR "/docs/cluster.md", "keys", sweep_keys().as_markdown("slurm"));
}

}  // namespace
}  // namespace shaken::scene
