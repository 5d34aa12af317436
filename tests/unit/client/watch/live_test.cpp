#include "client/live/live.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <fstream>
#include <limits>
#include <sstream>

#include "base/scratch_folder.h"
#include "base/text.h"
#include "client/watch/overview.h"
#include "tests/support/recorded_rods.h"

namespace shaken::client {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

Json api_job(const std::string& id, const std::string& state, double time) {
  Json job{{"id", id},       {"label", "rods.length=2.5"},
           {"state", state}, {"ended", state == "done" || state == "failed" || state == "cancelled"},
           {"reason", ""},   {"progress", nullptr}};
  if (time >= 0) {
    job["progress"] = {{"sim_time_s", time}, {"sim_time_total_s", 10.0},  {"sim_rate", 0.5}, {"eta_s", 12.0},
                       {"order", 0.25},      {"order_running_mean", 0.2}, {"n_rods", 271},   {"max_overlap_mm", 0.001}};
  }
  return job;
}

observables_t message(const std::string& id, std::int64_t sequence, double time, double order) {
  observables_t m{};
  m.job_id = id;
  m.sequence = sequence;
  m.sim_time_s = time;
  m.sim_time_total_s = 10;
  m.n_rods = 271;
  m.order = order;
  return m;
}

TEST(SequenceCounter, GapsAreLossesRestartsAreNot) {
  SequenceCounter counter;
  for (const std::int64_t sequence : {5, 6, 9, 10, 0, 1, 3}) counter.note(sequence);
  EXPECT_EQ(counter.received(), 7);
  EXPECT_EQ(counter.lost(), 3);  // 7, 8 and 2; what was before the first is not ours
}

TEST(SequenceCounter, NumbersThatNoSenderReachesAreNoLosses) {
  constexpr auto kLeast = std::numeric_limits<std::int64_t>::min(), kMost = std::numeric_limits<std::int64_t>::max();
  SequenceCounter counter;
  for (const std::int64_t sequence : {kLeast, kMost, kLeast, std::int64_t{0}, kMost, std::int64_t{-1}, kMost}) {
    counter.note(sequence);
    EXPECT_EQ(counter.lost(), 0) << sequence;
  }
}

TEST(HitCounter, IsOfOneRodAndOfTheTimeJustPast) {
  HitCounter counter;
  observables_t now{};
  now.n_rods = 100;
  const auto hits = [&](double time, std::int64_t rods, std::int64_t base) {
    now.sim_time_s = time;
    now.collisions_rod_rod = rods;
    now.collisions_rod_base = base;
    counter.note(now);
    return std::pair(counter.rates().rod, counter.rates().base);
  };
  EXPECT_EQ(hits(10, 5'000, 200'000), std::pair(10.0, 200.0)) << "since the start; each hits two rods";
  EXPECT_EQ(hits(10.1, 5'050, 202'000), std::pair(10.0, 200.0)) << "too few to count";
  EXPECT_EQ(hits(11, 6'000, 240'000), std::pair(20.0, 400.0));
  EXPECT_EQ(hits(5, 2'500, 100'000), std::pair(20.0, 400.0)) << "back to a checkpoint";
  EXPECT_EQ(hits(6, 3'000, 150'000), std::pair(10.0, 500.0));
}

TEST(History, KeepsTheWholeCurveInBoundedMemory) {
  History history;
  for (int i = 0; i < 100000; ++i) history.add(i, 2.0 * i);
  EXPECT_LT(history.times().size(), 4096u);
  EXPECT_EQ(history.times().size(), history.values().size());
  EXPECT_EQ(history.times().front(), 0);
  EXPECT_EQ(history.times().back(), 99999);
  for (std::size_t i = 0; i < history.times().size(); ++i) EXPECT_EQ(history.values()[i], 2 * history.times()[i]);
  history.add(50, 1);
  EXPECT_EQ(history.times(), std::vector<double>{50});
}

TEST(LiveJobs, MessagesWinOverOlderFilesAndStrangersAreIgnored) {
  LiveJobs jobs;
  jobs.note_api(api_job("aa", "running", 1.0));
  const LiveJob& first = jobs.jobs()[0];
  EXPECT_EQ(first.order, 0.25);
  EXPECT_EQ((std::array{first.sim_rate, first.eta, first.order_mean, first.max_overlap, 1.0 * first.n_rods}),
            (std::array{0.5, 12.0, 0.2, 0.001, 271.0}));
  jobs.note(message("aa", 0, 2.0, 0.75));
  jobs.note(message("bb", 0, 2.0, 0.5));
  jobs.note_api(api_job("aa", "running", 1.5));
  ASSERT_EQ(jobs.jobs().size(), 1u);
  EXPECT_EQ(jobs.jobs()[0].order, 0.75);
  EXPECT_EQ(jobs.jobs()[0].sim_time, 2.0);
  // Messages have stopped coming: the file takes over.
  jobs.note_api(api_job("aa", "running", 3.0));
  EXPECT_EQ(jobs.jobs()[0].sim_time, 3.0);
  EXPECT_EQ(jobs.jobs()[0].order, 0.25);
}

/// Frames of rods at 0, 0.5, 1.0 ... in `directory`.
void record_frames(const std::filesystem::path& directory, int n_frames) {
  test::record_rods({directory}, n_frames, test::kRod, 0.5);
}

TEST(LiveJobs, OrderFromBeforeTheyWereWatchedComesFromTheRunsFiles) {
  const ScratchFolder folder;
  record_frames(folder.path(), 5);
  LiveJobs jobs;
  Json job = api_job("aa", "running", 1.25);
  job["directory"] = folder.path().string();
  jobs.note_api(job);
  jobs.note(message("aa", 0, 1.5, 0.75));
  const History& history = jobs.jobs()[0].order_history;
  EXPECT_EQ(history.times(), (std::vector<double>{0, 0.5, 1, 1.25, 1.5}));
  EXPECT_EQ(history.values(), (std::vector<double>{1, 1, 1, 0.25, 0.75}));
  // Back to a checkpoint: what is drawn anew begins with the files again, though messages are newer than the answer.
  jobs.note(message("aa", 0, 0.75, 0.5));
  EXPECT_EQ(history.times(), std::vector<double>{0.75});
  jobs.note(message("aa", 1, 1.5, 0.5));
  jobs.note_api(job);
  EXPECT_EQ(history.times(), (std::vector<double>{0, 0.5, 0.75, 1.5}));
}

TEST(LiveJobs, TheAxisBeginsWhereOrderDoesIfThereAreNoFiles) {
  const ScratchFolder folder;
  LiveJobs jobs;
  Json job = api_job("aa", "running", 4.0);
  job["directory"] = folder.path().string();
  jobs.note_api(job);
  jobs.note(message("aa", 0, 5.0, 0.75));
  const auto axis = [&] { return order_chart(jobs.jobs()[0], 40, 8).back(); };
  EXPECT_THAT(axis(), AllOf(HasSubstr(" 4 "), HasSubstr("5 s   S(t), live only")));
  const auto lines = order_chart(jobs.jobs()[0], 40, 9);  // of which seven are between the axes
  for (std::size_t k = 0; k < 7; ++k)
    EXPECT_THAT(lines.at(k), StartsWith(k == 0 ? "1.00 ┤" : k == 3 ? "0.50 ┤" : k == 6 ? "0.00 ┤" : "     │")) << k;
  LiveJobs soon;  // the first twentieth is not missed
  soon.note_api(api_job("aa", "running", 0.49));
  soon.note(message("aa", 0, 10.0, 0.75));
  EXPECT_THAT(order_chart(soon.jobs()[0], 40, 8).back(), AllOf(HasSubstr(" 0 "), HasSubstr("10 s   S(t)")));
  record_frames(folder.path(), 2);
  LiveJobs others;
  others.note_api(job);
  const std::string whole = order_chart(others.jobs()[0], 40, 8).back();
  EXPECT_THAT(whole, AllOf(HasSubstr(" 0 "), HasSubstr("4 s   S(t)"), Not(HasSubstr("live"))));
}

TEST(LiveJobs, SpheresHaveNoOrder) {
  LiveJobs jobs;
  Json job = api_job("aa", "running", 1.0);
  job["progress"]["order"] = job["progress"]["order_running_mean"] = nullptr;
  jobs.note_api(job);
  EXPECT_FALSE(jobs.jobs()[0].order);
  jobs.note(message("aa", 0, 2.0, std::numeric_limits<double>::quiet_NaN()));
  EXPECT_FALSE(jobs.jobs()[0].order);
  EXPECT_TRUE(jobs.jobs()[0].order_history.times().empty());
  const std::string line = watch_line(jobs.jobs()[0]);
  EXPECT_EQ(line.find(" S "), std::string::npos) << line;
  EXPECT_THAT(line, HasSubstr("overlap"));
  std::ostringstream out, err;
  const Console console{.out = out, .err = err, .in = nullptr, .width = 100, .height = 24};
  for (const std::string& shown : watch_screen(jobs, "all", "", console)) {
    EXPECT_EQ(shown.find(" S "), std::string::npos) << shown;
    EXPECT_EQ(shown.find("nan"), std::string::npos) << shown;
  }
}

TEST(LiveJobs, CountsDefectsLossesAndEnds) {
  LiveJobs jobs;
  jobs.note_api(api_job("aa", "running", 0));
  jobs.note_api(api_job("bb", "failed", -1));
  jobs.note(message("aa", 0, 1, 0.5));
  jobs.note(message("aa", 4, 2, 0.5));
  defects_t defects{};
  defects.job_id = "aa";
  defects.charge = {0.5, -0.5, 0.5};
  defects.n_defects = 3;
  jobs.note(defects);
  EXPECT_EQ(jobs.jobs()[0].n_plus, 2);
  EXPECT_EQ(jobs.jobs()[0].n_minus, 1);
  EXPECT_EQ(jobs.received(), 3);
  EXPECT_EQ(jobs.lost(), 3);
  EXPECT_FALSE(jobs.all_ended());
  jobs.note_api(api_job("aa", "done", -1));
  EXPECT_TRUE(jobs.all_ended());
}

TEST(LiveJobs, AMessageEndsNothing) {
  LiveJobs jobs;
  jobs.note_api(api_job("aa", "running", 0));
  job_t message{};
  message.job_id = "aa";
  message.state = "running";
  EXPECT_FALSE(jobs.contradicts(message));
  message.state = "done";
  EXPECT_TRUE(jobs.contradicts(message)) << "a reason to ask the daemon";
  EXPECT_FALSE(jobs.all_ended());
  message.job_id = "bb";
  EXPECT_FALSE(jobs.contradicts(message)) << "nobody watches it";
}

TEST(WatchScreen, FitsEveryTerminal) {
  LiveJobs jobs;
  for (const char* id : {"aaaaaaaaaaaaaaaa", "bbbbbbbbbbbbbbbb", "cccccccccccccccc"}) {
    jobs.note_api(api_job(id, "running", 0.5));
    for (int i = 1; i < 50; ++i) jobs.note(message(id, i, 0.1 * i, 0.02 * i));
  }
  std::ostringstream out;
  for (int width = 1; width < 130; width += 9) {
    for (int height = 1; height < 60; height += 3) {
      const Console console{.out = out, .err = out, .colour = true, .width = width, .height = height};
      const auto screen = watch_screen(jobs, "sweep s1", "live", console);
      EXPECT_LE(screen.size(), static_cast<std::size_t>(height));
      for (const std::string& line : screen) {
        EXPECT_LE(display_width(line), static_cast<std::size_t>(width)) << line;
      }
    }
  }
}

TEST(WatchScreen, ShowsChartsWhereThereIsRoom) {
  LiveJobs jobs;
  jobs.note_api(api_job("aaaaaaaaaaaaaaaa", "running", 0.5));
  std::ostringstream out;
  const Console console{.out = out, .err = out, .width = 100, .height = 30};
  const auto screen = watch_screen(jobs, "sweep s1", "note", console);
  EXPECT_EQ(screen.back(), "note");
  EXPECT_THAT(screen, ::testing::Contains(HasSubstr("S(t)")));
  EXPECT_THAT(screen, ::testing::Contains(HasSubstr("aaaaaaaa ")));
}

TEST(WatchLine, DrawingTheFilmIsAStateOfItsOwn) {
  LiveJobs jobs;
  Json job = api_job("aaaaaaaaaaaaaaaa", "running", 10);
  job["progress"]["state"] = "rendering";
  job["progress"]["drawn"] = 0.257;
  job["progress"]["eta_s"] = 70;
  jobs.note_api(job);
  EXPECT_THAT(watch_line(jobs.jobs()[0]), HasSubstr("aaaaaaaa drawing the film 25 %, ETA 1 min 10 s"));
  // A message that is late does not hide it.
  jobs.note(message("aaaaaaaaaaaaaaaa", 0, 10, 0.5));
  jobs.note_api(job);
  EXPECT_TRUE(jobs.jobs()[0].draws_film);
  job["progress"]["drawn"] = 0.5;
  jobs.note_api(job);
  EXPECT_EQ(jobs.jobs()[0].drawn, 0.5) << "nor what the file says of it";
  job["progress"]["drawn"] = "much";
  jobs.note_api(job);
  EXPECT_EQ(jobs.jobs()[0].drawn, 0.5);
  jobs.note_api(api_job("aaaaaaaaaaaaaaaa", "done", -1));
  EXPECT_FALSE(jobs.jobs()[0].draws_film);
}

TEST(WatchLine, OfARunThatIsDoneHasItsMeanWithTheMarkOfTables) {
  const ScratchFolder folder;
  std::ofstream(folder / "summary.json") << R"({"order": {"mean": 0.625}, "steady": false})";
  Json job = api_job("aa", "running", 9.0);
  job["directory"] = folder.path().string();
  LiveJobs jobs;
  jobs.note_api(job);
  EXPECT_THAT(watch_line(jobs.jobs()[0]), HasSubstr("  S 0.250 (mean 0.200)"));
  job["state"] = "done";
  jobs.note_api(job);
  EXPECT_THAT(watch_line(jobs.jobs()[0]), HasSubstr("  mean S ~0.625 (still relaxing)"));
}

TEST(WatchLine, HasTheNumbers) {
  LiveJobs jobs;
  jobs.note_api(api_job("aaaaaaaaaaaaaaaa", "running", 5));
  jobs.note(message("aaaaaaaaaaaaaaaa", 0, 6, 0.5));
  jobs.note(message("aaaaaaaaaaaaaaaa", 2, 7, 0.875));
  const std::string line = watch_line(jobs.jobs()[0]);
  EXPECT_THAT(line, HasSubstr("aaaaaaaa running"));
  EXPECT_THAT(line, HasSubstr("70.0 %"));
  EXPECT_THAT(line, HasSubstr("S 0.875"));
  EXPECT_THAT(line, HasSubstr("1 messages lost"));
  EXPECT_THAT(line, HasSubstr("rods.length=2.5"));
}

}  // namespace
}  // namespace shaken::client
