#include "client/watch/screen.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>
#include <random>

#include "base/palettes.h"
#include "client/live/rod_colours.h"
#include "client/watch/live_screen.h"
#include "tests/support/good.h"

namespace shaken::client {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

constexpr const char* kFirst = "1f0c000000000000";
constexpr const char* kSecond = "2a0c000000000000";

Json job_json(const std::string& id, const std::string& state, const std::string& progress_state = "running") {
  return {{"id", id},
          {"label", "rods.length=2.5"},
          {"state", state},
          {"ended", state == "done"},
          {"reason", ""},
          {"progress",
           {{"state", progress_state},
            {"sim_time_s", 2.0},
            {"sim_time_total_s", 10.0},
            {"sim_rate", 0.5},
            {"eta_s", 16.0},
            {"order", 0.75},
            {"order_running_mean", 0.7},
            {"n_rods", 271},
            {"max_overlap_mm", 0.001}}}};
}

RodFrame one_rod() {
  RodFrame frame;
  frame.time = 1.25;
  frame.cell.box = 10;
  frame.outlines = {{.half_length = 2, .middle = 0.4, .end = 0.2}};
  frame.rods = {{5, 5, 0, 0}};
  return frame;
}

std::string all_text(const CellGrid& grid) {
  std::string text;
  for (int line = 0; line < grid.lines(); ++line) text += grid.text(line) + "\n";
  return text;
}

class WatchCells : public ::testing::Test {
 protected:
  CellGrid cells(int columns, int lines) {
    return watch_cells({.jobs = jobs_,
                        .steering = steering_,
                        .rods = rods_,
                        .defects = defects_,
                        .title = "sweep s1",
                        .note = "live over LCM",
                        .depth = depth_},
                       columns, lines);
  }
  std::string shown(int columns = 120, int lines = 40) { return all_text(cells(columns, lines)); }
  LiveJobs jobs_;
  Steering steering_{.job = kFirst};
  RodFrame frame_ = one_rod();
  const RodFrame* rods_ = &frame_;
  std::vector<DefectMark> defects_;
  ColourDepth depth_ = ColourDepth::kTrue;
};

TEST(WatchLayout, NumbersStandBesideThePictureOrUnderIt) {
  const auto wide = test::good(watch_layout(120, 40));
  EXPECT_EQ(*wide, (WatchLayout{.picture = {0, 1, 74, 37}, .legend = {0, 38, 74, 1}, .numbers = {75, 1, 45, 38}}));
  const auto high = test::good(watch_layout(50, 60));
  EXPECT_EQ(high->picture.columns, 50);
  EXPECT_EQ(high->numbers.line, high->legend.line + 1);
}

TEST(WatchLayout, NothingOverlapsOrLeavesTheScreen) {
  for (int columns = 1; columns < 260; columns += 3) {
    for (int lines = 1; lines < 120; ++lines) {
      const auto layout = watch_layout(columns, lines);
      EXPECT_EQ(layout.has_value(), (columns >= 60 && lines >= 16) || (columns >= 40 && lines >= 28));
      if (!layout) continue;
      std::vector<int> taken(static_cast<std::size_t>(columns * lines));
      for (const Area& area :
           {Area{0, 0, columns, 1}, layout->picture, layout->legend, layout->numbers, Area{0, lines - 1, columns, 1}}) {
        ASSERT_GE(area.columns, 1);
        ASSERT_GE(area.lines, 1);
        for (int y = area.line; y < area.line + area.lines; ++y) {
          for (int x = area.column; x < area.column + area.columns; ++x) {
            ASSERT_TRUE(x >= 0 && x < columns && y >= 0 && y < lines) << columns << "x" << lines;
            ASSERT_EQ(taken[static_cast<std::size_t>(y * columns + x)]++, 0) << columns << "x" << lines;
          }
        }
      }
      EXPECT_GE(layout->picture.columns, 24);
      EXPECT_GE(layout->picture.lines, 12);
    }
  }
}

TEST_F(WatchCells, HasRodsNumbersAndTheCurve) {
  jobs_.note_api(job_json(kFirst, "running"));
  const std::string text = shown();
  for (const char* words : {"sweep s1", "t = 1.250 s", "angle to the director", "▀", "1f0c0000", "rods.length=2.5",
                            "20.0 %", "2.0 s of 10 s", "ETA 16 s", "0.5 sim-s/s", "S 0.750  mean 0.700", "N 271",
                            "S(t)", "2 mm", "+15°", "? keys", "live over LCM"}) {
    EXPECT_THAT(text, HasSubstr(words));
  }
}

TEST_F(WatchCells, SaysWhatItNeedsWhereTheTerminalIsTooSmall) {
  jobs_.note_api(job_json(kFirst, "running"));
  const std::string text = shown(70, 10);
  EXPECT_THAT(text, HasSubstr("the rods need a terminal of 60x16 or 40x28; this one has 70x10"));
  EXPECT_THAT(text, HasSubstr("1f0c0000 running  20.0 %"));
  EXPECT_THAT(shown(30, 10), HasSubstr("the rods need a terminal of\n60x16 or 40x28; this one has\n")) << "not cut";
  steering_.numbers = true;
  EXPECT_THAT(shown(70, 10), HasSubstr("271"));
}

TEST_F(WatchCells, FillsEverySizeWithoutHarm) {
  jobs_.note_api(job_json(kFirst, "running"));
  jobs_.note_api(job_json(kSecond, "queued"));
  defects_ = {{5, 5, true}, {0, 0, false}};
  for (const bool numbers : {false, true}) {
    for (const bool help : {false, true}) {
      steering_.numbers = numbers;
      steering_.help = help;
      for (int columns = 0; columns < 150; columns += 7) {
        for (int lines = 0; lines < 70; lines += 3) {
          const std::string text = shown(columns, lines);
          EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), lines);
        }
      }
    }
  }
}

TEST_F(WatchCells, DrawingTheFilmIsAStateOfItsOwn) {
  Json job = job_json(kFirst, "running", "rendering");
  job["progress"]["drawn"] = 0.0;
  job["progress"]["eta_s"] = -1;
  jobs_.note_api(job);
  EXPECT_THAT(shown(), HasSubstr("drawing the film 0 %"));
  EXPECT_THAT(shown(), Not(HasSubstr("ETA"))) << "before the first frame nobody knows";
  job["progress"]["drawn"] = 0.5;
  job["progress"]["eta_s"] = 12;
  jobs_.note_api(job);
  EXPECT_THAT(shown(), HasSubstr("drawing the film 50 %, ETA 12 s"));
  EXPECT_THAT(shown(), HasSubstr("████████········ the run is done"));
  rods_ = nullptr;
  EXPECT_THAT(shown(), HasSubstr("the run is done; drawing the film 50 %, ETA 12 s"));
  steering_.numbers = true;
  EXPECT_THAT(shown(), HasSubstr("1f0c0000  ████████········ drawing the film 50 %, ETA 12 s"));
  steering_.numbers = false;
  jobs_.note_api(job_json(kFirst, "running"));
  EXPECT_THAT(shown(), Not(HasSubstr("drawing")));
}

TEST_F(WatchCells, SaysWhyThereAreNoRods) {
  rods_ = nullptr;
  jobs_.note_api(job_json(kFirst, "running"));
  EXPECT_THAT(shown(), HasSubstr("no frame has come yet"));
  jobs_.note_api(job_json(kFirst, "queued"));
  EXPECT_THAT(shown(), HasSubstr("waits in the queue"));
}

TEST_F(WatchCells, NumbersOfAllRuns) {
  jobs_.note_api(job_json(kFirst, "running"));
  jobs_.note_api(job_json(kSecond, "running"));
  EXPECT_THAT(shown(), HasSubstr("run 1 of 2"));
  EXPECT_THAT(shown(), Not(HasSubstr("2a0c0000")));
  steering_.numbers = true;
  EXPECT_THAT(shown(), HasSubstr("1f0c0000"));
  EXPECT_THAT(shown(), HasSubstr("2a0c0000"));
  EXPECT_THAT(shown(), HasSubstr("o rods  q leave  ? keys  live over LCM"));
}

TEST_F(WatchCells, HelpNamesEveryKey) {
  steering_.help = true;
  for (const char* line : kWatchKeys) EXPECT_THAT(shown(), HasSubstr(line));
}

TEST_F(WatchCells, TheLegendHasTheColoursOfItsScale) {
  jobs_.note_api(job_json(kFirst, "running"));
  const auto colours = [&](Colouring colouring, char32_t unit) {
    steering_.colouring = colouring;
    const CellGrid grid = cells(120, 40);
    std::vector<Ink> inks;
    for (int column = 0, is_past = 0; column < 74; ++column) {
      const ScreenCell& cell = grid.at(column, 38);
      if (is_past != 0 && cell.back != kOwnInk) inks.push_back(cell.back);
      is_past += cell.glyph == unit ? 1 : 0;
    }
    return inks;
  };
  std::vector<Ink> wheel, tilt;
  for (int k = 0; k < 6; ++k) wheel.push_back(ink_of(wheel_tone(k * std::numbers::pi / 6)));
  for (int k = -2; k <= 2; ++k) tilt.push_back(ink_of(tilt_tone(k * kFullTilt / 2)));
  EXPECT_EQ(colours(Colouring::kWheel, U'°'), wheel);
  EXPECT_EQ(colours(Colouring::kTilt, U'−'), tilt);
}

TEST_F(WatchCells, WithoutColoursThereAreDotsAndNoInks) {
  depth_ = ColourDepth::kNone;
  jobs_.note_api(job_json(kFirst, "running"));
  steering_.grain = Grain::kBlocks;  // cannot be had
  EXPECT_THAT(shown(), Not(HasSubstr("▀")));
  EXPECT_THAT(shown(), HasSubstr("⣿"));
}

TEST_F(WatchCells, NothingThatATerminalObeysOrThatIsWideIsShown) {
  Json evil = job_json(kFirst, "running");
  evil["label"] = "e\x1b]0;title\x07\u202evil \u6f22\u0301\u00ad";
  jobs_.note_api(evil);
  const std::string text = shown();
  EXPECT_THAT(text, HasSubstr("e\\u001b]0;title\\u0007"));
  for (const char* bytes : {"\x1b", "\x07", "\u202e", "\u6f22", "\u0301", "\u00ad"}) {
    EXPECT_THAT(text, Not(HasSubstr(bytes)));
  }
  EXPECT_THAT(text, HasSubstr("vil ???"));
}

TEST(JobToShow, FollowsWhatRuns) {
  LiveJobs jobs;
  EXPECT_EQ(job_to_show("", jobs), "");
  jobs.note_api(job_json(kFirst, "queued"));
  EXPECT_EQ(job_to_show("", jobs), kFirst);
  jobs.note_api(job_json(kSecond, "running"));
  EXPECT_EQ(job_to_show(kFirst, jobs), kSecond);
  EXPECT_EQ(choices(jobs), std::vector<std::string>{kSecond});
  jobs.note_api(job_json(kFirst, "running"));
  EXPECT_EQ(job_to_show(kSecond, jobs), kSecond) << "it still runs";
  jobs.note_api(job_json(kSecond, "done"));
  EXPECT_EQ(job_to_show(kSecond, jobs), kFirst);
  jobs.note_api(job_json(kSecond, "running"));
  jobs.note_api(job_json(kFirst, "running", "rendering"));
  EXPECT_EQ(job_to_show("", jobs), kSecond) << "it moves";
  EXPECT_EQ(job_to_show(kFirst, jobs), kFirst) << "one may look at a film being drawn";
  jobs.note_api(job_json(kSecond, "done"));
  jobs.note_api(job_json(kFirst, "done"));
  EXPECT_EQ(job_to_show(kFirst, jobs), kFirst) << "nothing runs: what was last seen stays";
}

/// 2,300 rods of the paper's box, somewhere.
RodFrame many_rods() {
  RodFrame frame = one_rod();
  frame.cell.box = 83.73;
  std::mt19937 random(3);
  std::uniform_real_distribution<double> place(0, frame.cell.box.x()), angle(-0.5, 0.5);
  frame.rods.clear();
  for (int i = 0; i < 2300; ++i) frame.rods.push_back({place(random), place(random), angle(random), 0});
  return frame;
}

TEST_F(WatchCells, APictureTakesBytesByWhatHasMoved) {
  jobs_.note_api(job_json(kFirst, "running"));
  frame_ = many_rods();
  for (const auto& [depth, most] :
       {std::pair{ColourDepth::kTrue, 150'000}, {ColourDepth::k256, 100'000}, {ColourDepth::kNone, 30'000}}) {
    depth_ = depth;
    ScreenWriter writer(depth);
    const std::size_t whole = writer.update(cells(200, 60)).size();
    EXPECT_LT(whole, static_cast<std::size_t>(most));
    EXPECT_EQ(writer.update(cells(200, 60)).size(), 0u) << "nothing has moved";
    frame_.rods[0].x += frame_.rods[0].x > 40 ? -5 : 5;
    const std::size_t one = writer.update(cells(200, 60)).size();
    EXPECT_GT(one, 0u);
    EXPECT_LT(one, 1000u) << "one rod has";
    for (proto::RodPose& rod : frame_.rods) rod.y += rod.y > 80 ? -80 : 3;
    EXPECT_GT(writer.update(cells(200, 60)).size(), whole / 3) << "all have";
  }
}

TEST_F(WatchCells, RodsThatAreTooThinAreDrawnAsTheirDirector) {
  jobs_.note_api(job_json(kFirst, "running"));
  frame_ = many_rods();
  frame_.order = 0.9;
  defects_ = {{20, 20, true}, {60, 60, false}};
  const auto n_of = [&](char32_t glyph) {
    const CellGrid grid = cells(80, 24);
    int n = 0;
    for (int line = 1; line < 22; ++line) {
      for (int column = 0; column < 42; ++column) n += grid.at(column, line).glyph == glyph ? 1 : 0;
    }
    return n;
  };
  EXPECT_THAT(shown(80, 24), HasSubstr("director, S: −15°"));
  depth_ = ColourDepth::kNone;
  EXPECT_THAT(shown(80, 24), HasSubstr("director ─╱│╲  · low S"));
  EXPECT_GT(n_of(U'─'), 800) << shown(80, 24);
  EXPECT_EQ(n_of(U'+'), 1);
  // Without order there is no director, and its defects are noise.
  std::mt19937 random(5);
  std::uniform_real_distribution<double> angle(-1.57, 1.57);
  for (proto::RodPose& rod : frame_.rods) rod.theta = angle(random);
  EXPECT_GT(n_of(U'·'), 600) << shown(80, 24);
  EXPECT_EQ(n_of(U'+'), 0);
  // Seen from near there are rods again, and so there are by their tilt.
  steering_.view.zoom = 8;
  EXPECT_THAT(shown(80, 24), Not(HasSubstr("─╱│╲")));
  steering_.view.zoom = 1;
  steering_.colouring = Colouring::kTilt;
  EXPECT_THAT(shown(80, 24), Not(HasSubstr("─╱│╲")));
}

TEST_F(WatchCells, KeysAreNotCut) {
  jobs_.note_api(job_json(kFirst, "running"));
  const auto last = [&](int columns) { return cells(columns, 40).text(39); };
  for (int columns = 40; columns < 90; ++columns) EXPECT_THAT(last(columns), HasSubstr("? keys")) << columns;
  EXPECT_EQ(last(40), "q leave  Tab run  space hold  ? keys");
  EXPECT_EQ(last(60), "q leave  Tab run  space hold  +/- zoom  c colours  ? keys");
  EXPECT_EQ(last(90), "q leave  Tab run  space hold  +/- zoom  c colours  o numbers  ? keys  live over LCM");
}

TEST(PauseAfter, KeepsASlowLineFree) {
  EXPECT_EQ(pause_after(0, true).count(), 100);
  EXPECT_EQ(pause_after(15'000, true).count(), 100);
  EXPECT_EQ(pause_after(150'000, true).count(), 1000);
  EXPECT_EQ(pause_after(150'000, false).count(), 100);
}

}  // namespace
}  // namespace shaken::client
