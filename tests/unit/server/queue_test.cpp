#include "server/queue/queue.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <thread>

#include "scene/canonical.h"
#include "scene/load.h"
#include "server/queue/database_schema.h"
#include "tests/unit/server/server_support.h"

namespace shaken::server {
namespace {

using enum JobState;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

class QueueTest : public testing::Test {
 protected:
  JobState state(char digit) const { return queue_.job(std::string(16, digit))->state; }
  std::vector<std::string> transitions(char digit) const {
    std::vector<std::string> result;
    for (const Change& change : queue_.changes_since(0, 1000)) {
      if (change.job == std::string(16, digit)) result.push_back(change.from + ">" + change.to);
    }
    return result;
  }

  ScratchFolder directory_;
  Queue queue_{directory_ / "queue.db"};
  const std::string a_ = std::string(16, 'a');
  const std::string b_ = std::string(16, 'b');
};

TEST_F(QueueTest, ASubmittedSweepIsThereInItsOrder) {
  const std::vector<NewJob> jobs{new_job('b', "x=1"), new_job('a', "x=2")};
  const Submitted submitted = queue_.submit("first", 0, jobs);
  EXPECT_TRUE(submitted.created);
  EXPECT_EQ(submitted.n_new, 2);
  EXPECT_EQ(submitted.n_requeued, 0);
  EXPECT_EQ(submitted.counts[kQueued], 2);

  const auto stored = queue_.jobs(submitted.sweep);
  ASSERT_EQ(stored.size(), 2U);
  EXPECT_EQ(stored[0].id, b_);
  EXPECT_EQ(stored[0].label, "x=1");
  EXPECT_EQ(stored[0].sweep, submitted.sweep);
  EXPECT_EQ(stored[0].state, kQueued);
  EXPECT_EQ(stored[0].attempt, 0);
  EXPECT_GT(stored[0].created, 0);
  EXPECT_EQ(stored[1].id, a_);
  EXPECT_EQ(queue_.scene(a_), jobs[1].scene);
  EXPECT_EQ(queue_.sweep(submitted.sweep)->name, "first");
  EXPECT_EQ(queue_.sweep_named("first")->id, submitted.sweep);
}

TEST_F(QueueTest, TheSameSweepAgainIsTheSameSweep) {
  const std::vector<NewJob> jobs{new_job('a'), new_job('b')};
  const Submitted first = queue_.submit("twice", 0, jobs);
  const Submitted second = queue_.submit("twice", 0, jobs);
  EXPECT_FALSE(second.created);
  EXPECT_EQ(second.sweep, first.sweep);
  EXPECT_EQ(second.n_new, 0);
  EXPECT_EQ(queue_.sweeps().size(), 1U);

  // One point more, or another name: another sweep, of the same jobs.
  const std::vector<NewJob> more{new_job('a'), new_job('b'), new_job('c')};
  EXPECT_EQ(queue_.submit("twice", 0, more).n_new, 1);
  EXPECT_EQ(queue_.submit("other", 0, jobs).n_new, 0);
  EXPECT_EQ(queue_.sweeps().size(), 3U);
  EXPECT_EQ(queue_.counts().total(), 3);
}

TEST_F(QueueTest, AJobOfTwoSweepsIsSeenThroughEither) {
  const auto first = queue_.submit("one", 0, std::vector{new_job('a', "as one")}).sweep;
  const auto second = queue_.submit("two", 0, std::vector{new_job('a', "as two")}).sweep;
  EXPECT_EQ(queue_.jobs(first).front().label, "as one");
  EXPECT_EQ(queue_.jobs(second).front().label, "as two");
  EXPECT_EQ(queue_.job(a_)->label, "as two");
  EXPECT_EQ(queue_.jobs(std::nullopt).size(), 1U);
}

TEST_F(QueueTest, ARunningJobIsDoneWithItsAttemptCounted) {
  queue_.submit("s", 0, std::vector{new_job('a')});
  EXPECT_EQ(begin(queue_, a_), 1);
  EXPECT_EQ(begin(queue_, a_), std::nullopt);
  queue_.set_worker(a_, 4711);
  EXPECT_EQ(queue_.job(a_)->pid, 4711);
  EXPECT_GT(queue_.job(a_)->started, 0);
  queue_.ended(a_, JobEvent::kWorkerDone);
  const Job done = *queue_.job(a_);
  EXPECT_EQ(done.state, kDone);
  EXPECT_EQ(done.attempt, 1);
  EXPECT_EQ(done.pid, 0);
  EXPECT_GE(done.finished, done.started);
  EXPECT_THAT(transitions('a'), ElementsAre(">queued", "queued>running", "running>done"));
  EXPECT_THROW(queue_.ended(a_, JobEvent::kWorkerFailed, "too late"), std::logic_error);
}

TEST_F(QueueTest, CancelLeavesOtherSweepsAlone) {
  queue_.submit("one", 0, std::vector{new_job('a')});
  const auto two = queue_.submit("two", 0, std::vector{new_job('b')}).sweep;
  EXPECT_EQ(queue_.cancel(two), 1);
  EXPECT_EQ(state('a'), kQueued);
  EXPECT_EQ(queue_.cancel("nobody"), 0);
}

TEST_F(QueueTest, ARunIsTimedOutAndARetryGivesItAsMuchTimeAgain) {
  const std::vector<NewJob> jobs{new_job('a')};
  const auto sweep = queue_.submit("s", 0, jobs, {.time_limit = std::chrono::hours(2)}).sweep;
  begin(queue_, a_);
  queue_.add_wall(std::vector{std::pair(a_, std::chrono::milliseconds(7'200'000))});
  queue_.time_out(a_);
  EXPECT_EQ(state('a'), kStopping);
  EXPECT_EQ(queue_.hold(a_), 0) << "the limit was first";
  queue_.crashed(a_, "worker was killed by signal 9 (SIGKILL)", false, {});
  EXPECT_EQ(state('a'), kTimedOut);
  EXPECT_EQ(queue_.job(a_)->reason, "it ran for 2 h 00 min, its time limit; `shaken retry` gives it as much again");
  EXPECT_GT(queue_.job(a_)->finished, 0);
  EXPECT_EQ(queue_.job(a_)->wall, std::chrono::hours(2));
  EXPECT_EQ(queue_.resume(sweep), 0) << "resume is for what is held";
  EXPECT_EQ(queue_.retry(sweep), 1);
  EXPECT_EQ(queue_.job(a_)->wall.count(), 0);
  EXPECT_EQ(queue_.job(a_)->time_limit, std::chrono::hours(2));

  // Asked for again while it stops: the time begins anew as well.
  begin(queue_, a_);
  queue_.add_wall(std::vector{std::pair(a_, std::chrono::milliseconds(7'200'000))});
  queue_.time_out(a_);
  EXPECT_EQ(queue_.submit("s", 0, jobs, {.time_limit = std::chrono::hours(3)}).n_requeued, 1);
  queue_.ended(a_, JobEvent::kWorkerStopped, "checkpoint");
  EXPECT_EQ(state('a'), kQueued);
  EXPECT_EQ(queue_.job(a_)->wall.count(), 0);
  EXPECT_EQ(queue_.job(a_)->time_limit, std::chrono::hours(3));
}

TEST_F(QueueTest, APauseBegunBeforeTheClockWasSetBackIsOver) {
  const std::array pauses{std::chrono::milliseconds(60'000)};
  queue_.submit("s", 0, std::vector{new_job('a')});
  begin(queue_, a_);
  queue_.crashed(a_, "crash", false, pauses);
  EXPECT_THAT(queue_.next(1), IsEmpty());
  const auto move_clock_back = [&](std::int64_t hours) {
    Database(directory_ / "queue.db")
        .run("UPDATE jobs SET not_before_utime = not_before_utime + ?1", hours * 3'600'000'000);
  };
  move_clock_back(24);
  EXPECT_EQ(Queue(directory_ / "queue.db").next(1).size(), 1U) << "of a daemon that has not seen it before";
}

/// A job with a real scene, which asks for so many simulated seconds.
NewJob job_of(const std::string& seconds, std::optional<bool> has_results = std::nullopt) {
  const auto plan = scene::load_scene(R"({"box": {"side": 30}, "time": {"measure": )" + seconds + "}}", "f");
  return {scene::run_id(*plan), scene::to_json(*plan).dump(2) + "\n", "measure " + seconds, "{}", 1, has_results};
}

double seconds_asked(const Queue& queue, const std::string& id) {
  return scene::load_scene(queue.scene(id), "f")->measure_time;
}

TEST_F(QueueTest, ALongerSceneExtendsTheJobThatIsThere) {
  const NewJob short_one = job_of("2");
  ASSERT_EQ(short_one.id, job_of("5").id);
  EXPECT_EQ(queue_.submit("s", 0, std::vector{short_one}).n_new, 1);
  EXPECT_EQ(queue_.submit("s", 0, std::vector{job_of("3")}).n_extended, 1);
  EXPECT_EQ(queue_.submit("s", 0, std::vector{job_of("2.5")}).n_extended, 0) << "it is longer already";
  EXPECT_EQ(seconds_asked(queue_, short_one.id), 3);

  begin(queue_, short_one.id);
  queue_.ended(short_one.id, JobEvent::kWorkerDone);
  EXPECT_EQ(queue_.submit("s", 0, std::vector{job_of("1")}).n_extended, 0);
  EXPECT_EQ(queue_.job(short_one.id)->state, kDone);
  const Submitted longer = queue_.submit("s", 0, std::vector{job_of("4", false)});
  EXPECT_EQ(longer.n_extended, 1);
  EXPECT_EQ(longer.n_requeued, 0) << "counted once";
  EXPECT_EQ(queue_.job(short_one.id)->state, kQueued);
  EXPECT_EQ(seconds_asked(queue_, short_one.id), 4);
}

TEST_F(QueueTest, AJobIsLaunchedWithTheSceneOfThatMoment) {
  const NewJob job = job_of("2");
  queue_.submit("s", 0, std::vector{job});
  queue_.extend(std::vector{std::pair{job.id, job_of("4").scene}});
  std::string scene;
  const auto prepare = [&](const std::string& given) {
    scene = given;
    return Obstacle{};
  };
  EXPECT_EQ(queue_.launch(job.id, prepare)->attempt, 1);
  EXPECT_EQ(scene, queue_.scene(job.id));
  EXPECT_FALSE(queue_.job(job.id)->longer);
}

TEST_F(QueueTest, AJobThatCannotBePreparedFailsOrStaysQueuedForAPause) {
  queue_.submit("s", 0, std::vector{new_job('b'), new_job('c')});
  const auto refuse = [](const std::string&) { return Obstacle{.failure = "refused"}; };
  const std::string c(16, 'c');
  queue_.hold(c);
  for (const std::string& id : {b_, c}) EXPECT_FALSE(queue_.launch(id, refuse));
  EXPECT_EQ(state('b'), kFailed);
  EXPECT_EQ(state('c'), kHeld) << "since it was listed, it was held";

  queue_.submit("s", 0, std::vector{new_job('a')});
  EXPECT_FALSE(queue_.launch(a_, [](const std::string&) {
    return Obstacle{.delay = "the directory is in use", .pause = std::chrono::minutes(1)};
  }));
  EXPECT_EQ(state('a'), kQueued);
  EXPECT_EQ(queue_.job(a_)->attempt, 0);
  EXPECT_EQ(queue_.job(a_)->reason, "the directory is in use");
  EXPECT_THAT(queue_.next(1), IsEmpty());
  EXPECT_FALSE(queue_.launch(a_));
}

TEST_F(QueueTest, ACancelledJobIsDoneAgainForAsLongAsItIsAskedForThen) {
  const NewJob job = job_of("1000");
  queue_.submit("s", 0, std::vector{job});
  queue_.cancel(job.id);
  EXPECT_EQ(queue_.submit("s", 0, std::vector{job_of("10")}).n_requeued, 1);
  EXPECT_EQ(seconds_asked(queue_, job.id), 10) << "1000 was a slip";
  begin(queue_, job.id);
  queue_.cancel(job.id);
  EXPECT_EQ(queue_.submit("s", 0, std::vector{job_of("5")}).n_requeued, 1) << "it is about to be cancelled";
  EXPECT_EQ(seconds_asked(queue_, job.id), 5);
}

// The model does not read words.
TEST_F(QueueTest, AJobSaysWhatItWaitsForAndWhyItIsHeldOrGaveWay) {
  std::vector<NewJob> jobs{new_job('a'), new_job('b'), new_job('c')};
  jobs[1].starts_from = a_;
  jobs[2].starts_from = std::string(16, 'f');
  queue_.submit("s", 0, jobs);
  EXPECT_EQ(queue_.job(b_)->reason, "waits for run aaaaaaaaaaaaaaaa, from which it starts");
  begin(queue_, a_);
  EXPECT_TRUE(queue_.preempt(a_));
  EXPECT_EQ(queue_.history(a_).back().cause, "its soft limit is over: it gives way to others");
  queue_.ended(a_, JobEvent::kWorkerFailed, "exit 1");
  EXPECT_EQ(queue_.job(a_)->reason, "exit 1");
  EXPECT_EQ(queue_.job(b_)->reason, "it is to start from run aaaaaaaaaaaaaaaa: failed");
  EXPECT_EQ(begin(queue_, jobs[2].id), 1) << "nobody waits for a run that is not in the queue";
}

TEST_F(QueueTest, IdsAreFoundByTheirBeginning) {
  NewJob near = new_job('a');
  near.id = "aaab000000000000";
  queue_.submit("s", 0, std::vector{new_job('a'), near, new_job('b')});
  EXPECT_THAT(queue_.ids_beginning_with("aaa", 10), ElementsAre(a_, near.id));
  EXPECT_THAT(queue_.ids_beginning_with("aaab", 10), ElementsAre(near.id));
  EXPECT_THAT(queue_.ids_beginning_with("", 2), ElementsAre(a_, near.id));
  EXPECT_THAT(queue_.ids_beginning_with("c", 10), IsEmpty());
  EXPECT_THAT(queue_.ids_beginning_with("%", 10), IsEmpty());
}

TEST_F(QueueTest, TheJournalTellsTimeAndCause) {
  queue_.submit("s", 0, std::vector{new_job('a')});
  const std::int64_t before = queue_.last_change();
  begin(queue_, a_);
  queue_.ended(a_, JobEvent::kWorkerFailed, "exit 1: why");
  const auto changes = queue_.changes_since(before, 10);
  ASSERT_EQ(changes.size(), 2U);
  EXPECT_EQ(changes[1].to, "failed");
  EXPECT_EQ(changes[1].cause, "exit 1: why");
  EXPECT_EQ(changes[1].attempt, 1);
  EXPECT_EQ(changes[1].sequence, queue_.last_change());
  EXPECT_GE(changes[1].utime, changes[0].utime);
  EXPECT_EQ(queue_.changes_since(before, 1).size(), 1U);
}

TEST_F(QueueTest, AWaiterWakesWithTheNextChange) {
  const std::int64_t before = queue_.last_change();
  std::thread writer([&] { queue_.submit("s", 0, std::vector{new_job('a')}); });
  queue_.wait_for_change(before, std::chrono::seconds(20));
  EXPECT_GT(queue_.last_change(), before);
  writer.join();
}

TEST_F(QueueTest, ThreadsMayWorkOnItTogether) {
  std::vector<std::thread> threads;
  for (int thread = 0; thread < 4; ++thread) {
    threads.emplace_back([&, thread] {
      for (int i = 0; i < 10; ++i) {
        NewJob job = new_job('a');
        job.id = std::to_string(thread) + "-" + std::to_string(i);
        queue_.submit("thread " + std::to_string(thread) + "." + std::to_string(i), 0, std::vector{job});
        queue_.cancel(job.id);
        queue_.counts();
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(queue_.counts()[kCancelled], 40);
  EXPECT_EQ(queue_.last_change(), 80);
}

// What kill -9 leaves behind: the files as they are while the queue is open.
TEST_F(QueueTest, AfterAKillEverythingAcknowledgedIsThere) {
  queue_.submit("s", 0, std::vector{new_job('a'), new_job('b'), new_job('c'), new_job('d')});
  begin(queue_, a_);
  begin(queue_, b_);
  queue_.cancel(b_);
  queue_.cancel(std::string(16, 'c'));
  std::filesystem::create_directory(directory_ / "copy");
  for (const char* name : {"queue.db", "queue.db-wal"}) {
    std::filesystem::copy_file(directory_ / name, directory_ / "copy" / name);
  }

  Queue copy(directory_ / "copy" / "queue.db");
  EXPECT_EQ(copy.job(a_)->state, kRunning);
  EXPECT_THAT(copy.recover(), ElementsAre(a_, b_));
  EXPECT_EQ(copy.job(a_)->state, kQueued);
  EXPECT_EQ(copy.job(a_)->attempt, 1);
  EXPECT_EQ(copy.job(b_)->state, kCancelled);
  EXPECT_EQ(copy.job(std::string(16, 'c'))->state, kCancelled);
  EXPECT_EQ(copy.job(std::string(16, 'd'))->state, kQueued);
  EXPECT_EQ(begin(copy, a_), 2);
  EXPECT_THAT(copy.changes_since(queue_.last_change(), 1).front().cause, HasSubstr("without warning"));
}

TEST(QueueFileTest, AWriteAheadLogCutAnywhereGivesWholeSweepsOnly) {
  const ScratchFolder directory;
  {
    Queue queue(directory / "queue.db");
    queue.submit("one", 0, std::vector{new_job('a'), new_job('b'), new_job('c')});
    queue.submit("two", 0, std::vector{new_job('d'), new_job('e'), new_job('f')});
    std::filesystem::copy_file(directory / "queue.db", directory / "main");
    std::filesystem::copy_file(directory / "queue.db-wal", directory / "wal");
  }
  const std::string log = read_text(directory / "wal");
  std::vector<std::size_t> sizes_seen;
  for (std::size_t size = 0; size <= log.size(); size += 2003) {
    const auto file = directory / "cut.db";
    std::filesystem::remove(directory / "cut.db-shm");
    std::filesystem::copy_file(directory / "main", file, std::filesystem::copy_options::overwrite_existing);
    write_text(directory / "cut.db-wal", log.substr(0, size));
    const Queue queue(file);
    for (const Sweep& sweep : queue.sweeps()) EXPECT_EQ(sweep.counts[kQueued], 3) << "cut at byte " << size;
    EXPECT_EQ(queue.counts().total(), 3 * static_cast<std::int64_t>(queue.sweeps().size()));
    sizes_seen.push_back(queue.sweeps().size());
  }
  EXPECT_TRUE(std::is_sorted(sizes_seen.begin(), sizes_seen.end()));
  EXPECT_EQ(sizes_seen.front(), 0U);
}

TEST(QueueFileTest, AnotherThatWritesIsWaitedFor) {
  const ScratchFolder directory;
  Queue queue(directory / "queue.db");
  Database other(directory / "queue.db");
  other.execute("BEGIN IMMEDIATE");
  const std::jthread later([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    other.execute("COMMIT");
  });
  queue.submit("s", 0, std::vector{new_job('a')});
  EXPECT_EQ(queue.sweeps().size(), 1U);
}

TEST(QueueFileTest, ADamagedFileIsRefusedInWords) {
  const ScratchFolder directory;
  write_text(directory / "queue.db", std::string(8192, 'x'));
  EXPECT_THROW(Queue(directory / "queue.db"), StorageError);
  EXPECT_EQ(read_text(directory / "queue.db"), std::string(8192, 'x')) << "and it is left as it is";
}

TEST(QueueFileTest, AFileOfAnotherVersionIsRefusedWithAWayOut) {
  for (const std::string version : {"4", "99", "-1"}) {
    const ScratchFolder directory;
    { const Queue queue(directory / "queue.db"); }
    Database(directory / "queue.db").execute(("PRAGMA user_version = " + version).c_str());
    EXPECT_THAT([&] { Queue(directory / "queue.db"); },
                testing::ThrowsMessage<StorageError>(
                    AllOf(HasSubstr("has schema version " + version + ","), HasSubstr("--root"))));
  }
}

TEST(QueueFileTest, EachMigrationIsAppliedOnceAndWhollyOrNotAtAll) {
  const ScratchFolder directory;
  const auto file = directory / "queue.db";
  { const Queue queue(file); }
  const auto version = [&] {
    Database database(file);
    Query query = database.query("PRAGMA user_version");
    query.next();
    return query.integer(0);
  };
  const std::int64_t first = version();
  const Migration one = [](Database& database) { database.execute("CREATE TABLE one(x INTEGER)"); };
  const Migration two = [](Database& database) { database.execute("CREATE TABLE two(x INTEGER)"); };
  const Migration fails = [](Database& database) { database.execute("CREATE TABLE two(x INTEGER); nonsense"); };
  const auto prepare = [&](const std::vector<Migration>& more) {
    std::vector<Migration> all(migrations().begin(), migrations().end());
    all.insert(all.end(), more.begin(), more.end());
    Database database(file);
    prepare_schema(database, all);
  };
  EXPECT_THROW(prepare({one, fails}), StorageError);
  EXPECT_EQ(version(), first);
  prepare({one});
  prepare({one, two});
  prepare({one, two});
  EXPECT_EQ(version(), first + 2);
  EXPECT_THROW(prepare({one}), StorageError) << "an older program";
  std::filesystem::remove(file);
  prepare({one, two});
  EXPECT_EQ(version(), first + 2) << "an empty file";
}

TEST(QueueFileTest, AQueueOfTheFormerVersionIsUpgradedWithItsJobs) {
  const ScratchFolder directory;
  const auto file = directory / "queue.db";
  {
    Database database(file);
    prepare_schema(database, {});
    database.execute(
        "INSERT INTO sweeps(name, created_utime) VALUES('old', 1), ('older', 1);"
        "INSERT INTO jobs(id, state, priority, created_utime, sweep, label, parameters, replica, waits)"
        " VALUES('aaaaaaaaaaaaaaaa', 'queued', 0, 1, 1, '', '{}', 1, 0), ('bbbbbbbbbbbbbbbb', 'queued', 0, 1, 2, '', "
        "'{}', 1, 1);"
        "INSERT INTO scenes(job, scene) VALUES(1, '{\"rods\": {\"count\": 7}, \"time\": {\"measure\": 2}}'), (2, '{');"
        "INSERT INTO members(sweep, position, job, label, parameters, replica) VALUES(1, 0, 1, '', '{}', 1), "
        "(2, 0, 2, '', '{}', 1);"
        "INSERT INTO prerequisites(sweep, position, target) VALUES(2, 0, 's1')");
  }
  Queue queue(file);
  const std::string a(16, 'a'), b(16, 'b');
  EXPECT_EQ(queue.job(a)->starts_from, "");
  EXPECT_EQ(queue.job(a)->work, 14.0);
  EXPECT_EQ(queue.job(b)->work, 1.0) << "its scene does not tell";
  EXPECT_EQ(queue.job(b)->reason, "waits for s1: 0 of 1 done");
  EXPECT_EQ(begin(queue, a), 1);
  queue.ended(a, JobEvent::kWorkerDone);
  EXPECT_EQ(begin(queue, b), 1);
}

TEST(QueueFileTest, AnUnwritableFolderIsAnError) { EXPECT_THROW(Queue("/nonexistent/queue.db"), StorageError); }

}  // namespace
}  // namespace shaken::server
