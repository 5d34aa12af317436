// SPDX-License-Identifier: MIT
#include "server/former_ids.h"

#include <gtest/gtest.h>

#include "run/files/checkpoint_file.h"
#include "run/files/done.h"
#include "scene/canonical.h"
#include "scene/load.h"
#include "server/sqlite.h"
#include "tests/unit/server/support.h"

namespace shaken::server {
namespace {

using enum JobState;

scene::RunPlan plan_of(double side, double seconds) {
  const std::vector<std::string> settings{"box.side=" + std::to_string(side),
                                          "time.measure=" + std::to_string(seconds)};
  return *scene::load_scene("{}", "f", settings);
}

/// A job as it was before runs could be extended.
NewJob former_job(const scene::RunPlan& plan) {
  return {scene::scene_hash(plan), scene::to_json(plan).dump(2) + "\n", "label", "{}", 1};
}

class FormerIdsTest : public testing::Test {
 protected:
  /// A queue of these, of which those `done` are, and a folder with a file "seconds" for each.
  void fill(const std::vector<std::pair<scene::RunPlan, bool>>& plans) {
    const ScratchFolder& root = directory_;
    {
      Queue queue(root / "queue.db");
      std::vector<NewJob> jobs;
      for (const auto& [plan, done] : plans) jobs.push_back(former_job(plan));
      queue.submit("old", 0, jobs);
      for (const auto& [plan, done] : plans) {
        const std::string id = scene::scene_hash(plan);
        std::filesystem::create_directories(runs() / id);
        write_text(runs() / id / "seconds", std::to_string(static_cast<int>(plan.measure_time)));
        if (!done) continue;
        queue.begin(id);
        queue.finish(id, kDone, "");
      }
    }
    Database(root / "queue.db").execute("INSERT INTO upgrades VALUES('ids')");
  }
  std::filesystem::path runs() const { return directory_ / "runs"; }

  ScratchFolder directory_;
};

TEST_F(FormerIdsTest, JobsAndFoldersGetTheIdsOfToday) {
  fill({{plan_of(40, 2), true}, {plan_of(50, 3), false}});
  Queue queue(directory_ / "queue.db");
  ASSERT_TRUE(queue.has_former_ids());
  for (int again = 0; again < 2; ++again) {
    renew_ids(queue, runs());
    EXPECT_FALSE(queue.has_former_ids());
    const auto jobs = queue.jobs(1);
    ASSERT_EQ(jobs.size(), 2U);
    EXPECT_EQ(jobs[0].id, scene::run_id(plan_of(40, 2)));
    EXPECT_EQ(jobs[0].state, kDone);
    EXPECT_EQ(jobs[1].id, scene::run_id(plan_of(50, 3)));
    EXPECT_EQ(queue.history(jobs[0].id).size(), 3U) << "the journal goes with it";
    EXPECT_EQ(read_text(runs() / jobs[0].id / "seconds"), "2");
    EXPECT_FALSE(std::filesystem::exists(runs() / scene::scene_hash(plan_of(40, 2))));
  }
}

TEST_F(FormerIdsTest, RunsThatDifferInTheirLengthBecomeTheLongestThatIsDone) {
  fill({{plan_of(40, 2), true}, {plan_of(40, 8), false}, {plan_of(40, 4), true}});
  Queue queue(directory_ / "queue.db");
  renew_ids(queue, runs());
  const std::string id = scene::run_id(plan_of(40, 2));
  const auto jobs = queue.jobs(1);
  ASSERT_EQ(jobs.size(), 3U) << "the sweep has its points";
  for (const Job& job : jobs) {
    EXPECT_EQ(job.id, id);
    EXPECT_EQ(job.state, kQueued) << "8 s were asked for, 4 s are done";
  }
  EXPECT_EQ(queue.counts().total(), 1);
  EXPECT_EQ(scene::load_scene(queue.scene(id), "f")->measure_time, 8);
  EXPECT_EQ(read_text(runs() / id / "seconds"), "4");
  EXPECT_EQ(read_text(runs() / scene::scene_hash(plan_of(40, 2)) / "seconds"), "2") << "nothing is lost";
}

TEST_F(FormerIdsTest, WhatIsWithdrawnHasNoSay) {
  fill({{plan_of(40, 100), false}, {plan_of(40, 10), false}, {plan_of(50, 100), false}, {plan_of(50, 10), true}});
  Queue queue(directory_ / "queue.db");
  queue.cancel(scene::scene_hash(plan_of(40, 100)));
  queue.cancel(scene::scene_hash(plan_of(50, 100)));
  renew_ids(queue, runs());
  const std::string waiting = scene::run_id(plan_of(40, 10)), done = scene::run_id(plan_of(50, 10));
  EXPECT_EQ(queue.job(waiting)->state, kQueued);
  EXPECT_EQ(scene::load_scene(queue.scene(waiting), "f")->measure_time, 10);
  EXPECT_EQ(queue.job(done)->state, kDone) << "nobody waits for 100 s";
}

TEST_F(FormerIdsTest, FilesOfTheFolderGetTheIdToo) {
  const auto plan = plan_of(40, 2);
  fill({{plan, true}});
  const std::string former = scene::scene_hash(plan), id = scene::run_id(plan);
  const run::RunDirectory folder{runs() / former};
  write_text(folder.scene(), scene::to_json(plan).dump());
  write_text(folder.summary(), R"({"run_id": ")" + former + R"(", "exit": {"state": "done", "tick": 1000000000}})");
  ASSERT_TRUE(run::write_checkpoint(folder, former, {{std::byte{1}}, {std::byte{2}}, 3, 4}));
  Queue queue(directory_ / "queue.db");
  renew_ids(queue, runs());
  EXPECT_TRUE(run::is_done(run::RunDirectory{runs() / id}, plan));
  EXPECT_TRUE(run::read_checkpoint(run::RunDirectory{runs() / id}.checkpoint(), id));
}

TEST_F(FormerIdsTest, AfterACrashBetweenFoldersAndQueueItGoesOn) {
  fill({{plan_of(40, 2), true}});
  std::filesystem::rename(runs() / scene::scene_hash(plan_of(40, 2)), runs() / scene::run_id(plan_of(40, 2)));
  Queue queue(directory_ / "queue.db");
  renew_ids(queue, runs());
  EXPECT_EQ(read_text(runs() / queue.jobs(1).at(0).id / "seconds"), "2");
}

TEST_F(FormerIdsTest, JobsOfAnotherPhysicsKeepTheirs) {
  {
    Queue queue(directory_ / "queue.db");
    queue.submit("s", 0, std::vector{NewJob{std::string(16, 'f'), former_job(plan_of(40, 2)).scene, "", "{}", 1}});
  }
  Database(directory_ / "queue.db").execute("INSERT INTO upgrades VALUES('ids')");
  Queue queue(directory_ / "queue.db");
  renew_ids(queue, runs());
  EXPECT_EQ(queue.jobs(1).at(0).id, std::string(16, 'f'));
}

}  // namespace
}  // namespace shaken::server
