// The program as a user meets it: exit codes, messages, files.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/support/good.h"
#include "tests/unit/render/render_support.h"

namespace shaken::render {
namespace {

using testing::HasSubstr;

struct Ended {
  int code;
  std::string output;  ///< on stdout and stderr
};

Ended run_program(const std::string& arguments, const std::string& environment = "") {
  const std::string command = environment + " '" SHAKEN_RENDER_PROGRAM "' " + arguments + " 2>&1";
  std::FILE* pipe = popen(command.c_str(), "r");
  Ended ended{-1, ""};
  char text[512];
  while (std::fgets(text, sizeof(text), pipe)) ended.output += text;
  const int status = pclose(pipe);
  if (WIFEXITED(status)) ended.code = WEXITSTATUS(status);
  return ended;
}

class RenderProgram : public testing::Test {
 protected:
  /// A run with so many frames, 50 ms apart.
  void plant(int n_frames, const std::string& scene = "{}") const { plant_trajectory(run_, n_frames, scene); }

  const ScratchFolder folder_;
  const std::string run_ = folder_.path().string();
};

TEST_F(RenderProgram, PictureWritesBesideTheTrajectoryAndPrintsThePath) {
  plant(3);
  EXPECT_EQ(test::said_with(0, run_program("picture " + run_)), (folder_ / "picture.png").string() + "\n");
  const Image image = read_png(folder_ / "picture.png");
  EXPECT_EQ(image.width, 1280);
  EXPECT_EQ(image.height, 720);
}

TEST_F(RenderProgram, PicturesDoNotDependOnTheNumberOfThreads) {
  plant(2);
  std::vector<Image> images;
  for (const std::string threads : {"0", "1", "2", "4"}) {
    const std::string out = (folder_ / (threads + ".png")).string();
    ASSERT_EQ(run_program("picture " + run_ + " --size 480x270 -o " + out, "LP_NUM_THREADS=" + threads).code, 0);
    images.push_back(read_png(out));
    EXPECT_EQ(images.back(), images.front()) << threads;
  }
}

TEST_F(RenderProgram, FrameAndTimeChooseTheFrame) {
  plant(4);
  const auto picture = [&](const std::string& choice) {
    const std::string out = (folder_ / "p.png").string();
    EXPECT_EQ(run_program("picture " + run_ + " --bare --size 200x200 -c angle -o " + out + choice).code, 0);
    return read_png(out);
  };
  EXPECT_EQ(picture(" --frame 1"), picture(" --time 0.06"));
  EXPECT_EQ(picture(" --frame last"), picture(" --frame 3"));
  EXPECT_NE(picture(" --frame 1"), picture(" --frame 3"));
}

TEST_F(RenderProgram, WhatWasNotRecordedIsNotDrawn) {
  plant(5);  // 0 to 0.2 s, a frame each 50 ms
  for (const std::string& arguments : {"picture " + run_ + " --time 100s -o " + run_ + "/x.png",
                                       "movie " + run_ + " --from 5s --to 9s -o " + run_ + "/x.mp4"}) {
    EXPECT_THAT(test::said_with(2, run_program(arguments)), HasSubstr("the 5 frames are from 0 s to 0.2 s"))
        << arguments;
  }
  EXPECT_EQ(listing(folder_), "trajectory.h5");
  EXPECT_EQ(run_program("picture " + run_ + " --time 0.23 --bare --size 64x64 -o " + run_ + "/x.png").code, 0)
      << "nearest to the last one";
}

TEST_F(RenderProgram, AnOddSizeIsBadInputForEveryFilmThatCannotHaveIt) {
  plant(1);
  const auto code = [&](const std::string& ending) {
    return run_program("movie " + run_ + " --size 101x81 -o " + (folder_ / ("r" + ending)).string()).code;
  };
  EXPECT_EQ(code(".mp4"), 2);
  EXPECT_EQ(code(".webm"), 2);
  EXPECT_EQ(code(".gif"), 0);
}

// ffmpeg would take what is before the colon for a protocol, and open connections.
TEST_F(RenderProgram, ANameOfAFilmIsNeverAnAddress) {
  plant(1);
  std::filesystem::create_directories(folder_ / "http:/127.0.0.1:1");
  for (const std::string name : {"2026-11-25T02:30:00.mp4", "run:1.gif", "a:b.webm", "http://127.0.0.1:1/x.mp4"}) {
    test::expect_end(0, run_program("movie . --size 64x64 -o '" + name + "'", "cd " + run_ + " &&"));
    EXPECT_TRUE(std::filesystem::exists(folder_ / name)) << name;
  }
}

TEST_F(RenderProgram, ControlCharactersOfALabelAreWrittenOut) {
  plant(1);
  const std::string out = (folder_ / "x.svg").string();
  const Ended ended =
      run_program("picture " + run_ + " -o " + out + " --label \"$(printf 'a\\001b\\033[31m<&>\\377')\"");
  ASSERT_EQ(ended.code, 0) << ended.output;
  std::ifstream in(out, std::ios::binary);
  const std::string text((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
  for (const char c : text) ASSERT_TRUE(static_cast<unsigned char>(c) >= 0x20 || c == '\n' || c == '\t') << int{c};
  EXPECT_EQ(text.find('\377'), std::string::npos) << "no UTF-8";
  EXPECT_NE(text.find("a\\u0001b\\u001b[31m&lt;&amp;&gt;\\xff</title>"), std::string::npos);
}

TEST_F(RenderProgram, MovieReportsInJson) {
  plant(7);
  const auto said = nlohmann::json::parse(
      test::said_with(0, run_program("movie " + run_ + " --size 320x180 --every 2 --from 0.05 --frames --json")));
  EXPECT_EQ(said.at("path"), (folder_ / "movie.mp4").string());
  EXPECT_EQ(said.at("frames"), 3);  // 1, 3 and 5
  EXPECT_EQ(said.at("width_px"), 320);
  EXPECT_GT(said.at("seconds"), 0);
  EXPECT_EQ(listing(folder_), "frames movie.mp4 trajectory.h5");
  EXPECT_TRUE(std::filesystem::exists(folder_ / "frames/frame_000002.png"));
}

TEST_F(RenderProgram, MovieFollowsTheScene) {
  plant(7, R"({"movie": {"every": 0.1, "size": [320, 180]}})");
  const auto said = nlohmann::json::parse(test::said_with(0, run_program("movie " + run_ + " --json")));
  EXPECT_EQ(said.at("frames"), 4);  // 0, 0.1, 0.2 and 0.3 s; recorded every 0.05 s
  EXPECT_EQ(said.at("height_px"), 180);
}

TEST_F(RenderProgram, SpeedAndSpanMakeTheFilm) {
  plant(11);  // 0 to 0.5 s, a frame each 50 ms
  const auto frames = [&](const std::string& arguments) {
    return nlohmann::json::parse(
               test::said_with(0, run_program("movie " + run_ + " --size 128x128 --json " + arguments)))
        .at("frames")
        .get<int>();
  };
  EXPECT_EQ(frames("--from 0.1s --to 400ms"), 7);
  // 0.3 s at a tenth of the speed are 3 s: at 10 frames a second 31 with both ends, recorded ones repeated.
  EXPECT_EQ(frames("--from 0.1s --to 400ms --speed 0.1 --fps 10"), 31);
  EXPECT_EQ(frames("--speed 1 --fps 10"), 6);
}

TEST_F(RenderProgram, TheEndingNamesTheFormat) {
  plant(3);
  EXPECT_EQ(run_program("movie " + run_ + " --size 128x128 --fps 10 -o " + (folder_ / "m.gif").string()).code, 0);
  EXPECT_EQ(run_program("picture " + run_ + " --size 128x128 -o " + (folder_ / "p.svg").string()).code, 0);
  EXPECT_EQ(listing(folder_), "m.gif p.svg trajectory.h5");
  EXPECT_THAT(test::said_with(2, run_program("movie " + run_ + " -o " + (folder_ / "m.avi").string())),
              HasSubstr(".mp4, .webm or .gif"));
  EXPECT_THAT(test::said_with(2, run_program("picture " + run_ + " -o " + (folder_ / "p.jpg").string())),
              HasSubstr(".png, .svg or .pdf"));
  EXPECT_EQ(listing(folder_), "m.gif p.svg trajectory.h5");
}

TEST_F(RenderProgram, EqualCallsGiveEqualFiles) {
  plant(3);
  const auto bytes = [&](const std::string& arguments, const char* name) {
    EXPECT_EQ(run_program(arguments + " " + run_ + " --size 160x120 -o " + (folder_ / name).string()).code, 0);
    std::ifstream in(folder_ / name, std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(in), {});
  };
  for (const char* ending : {".png", ".svg", ".pdf"}) {
    EXPECT_TRUE(bytes("picture", (std::string("a") + ending).c_str()) ==
                bytes("picture", (std::string("b") + ending).c_str()))
        << ending;
  }
  EXPECT_TRUE(bytes("picture --depth 16", "a16.png") == bytes("picture --depth 16", "b16.png"));
  EXPECT_EQ(bytes("picture --depth 16", "a16.png")[24], 16) << "bits a colour, as the file's head has it";
  EXPECT_EQ(run_program("picture " + run_ + " --depth 16 -o " + (folder_ / "c.pdf").string()).code, 2);
  EXPECT_EQ(bytes("picture --transparent", "clear.png")[25], 6) << "colours and opacity, as the file's head has it";
  EXPECT_EQ(bytes("picture", "full.png")[25], 2);
  for (const char* refused : {"picture --depth 16 -o c.png ", "movie -o c.mp4 "}) {
    EXPECT_THAT(test::said_with(2, run_program(refused + run_ + " --transparent")), HasSubstr("--transparent is for"));
  }
  for (const char* ending : {".mp4", ".gif", ".webm"}) {
    EXPECT_TRUE(bytes("movie --threads 1", (std::string("a") + ending).c_str()) ==
                bytes("movie --threads 3", (std::string("b") + ending).c_str()))
        << ending;
  }
}

TEST_F(RenderProgram, RawFramesGoToStdout) {
  plant(3);
  const std::string command =
      "movie " + run_ + " --size 128x100 --bare -o - 2>/dev/null > " + (folder_ / "raw").string();
  EXPECT_EQ(run_program(command).code, 0);
  EXPECT_EQ(std::filesystem::file_size(folder_ / "raw"), 3u * 128 * 100 * 3);
}

TEST_F(RenderProgram, ProgressIsKeptInAFile) {
  plant(3);
  const std::string file = (folder_ / "progress").string();
  ASSERT_EQ(run_program("movie " + run_ + " --size 128x100 --progress " + file).code, 0);
  std::ifstream in(file);
  const auto said = nlohmann::json::parse(in);
  EXPECT_EQ(said.at("frames"), 3);
  EXPECT_GE(said.at("frames_drawn"), 1);
  EXPECT_GT(said.at("seconds"), 0);
}

TEST_F(RenderProgram, AllThatIsWrongWithAStyleIsToldAtOnce) {
  plant(1);
  const Ended ended = run_program("picture " + run_ + " --zoom 0.5 --colour grey --theme blue --tracks x");
  EXPECT_EQ(ended.code, 2);
  for (const char* key :
       {"--zoom: 0.5 is", "--colour: \"grey\" is", "--theme: \"blue\" is", "--tracks: \"x\" is not"}) {
    EXPECT_NE(ended.output.find(key), std::string::npos) << ended.output;
  }
}

TEST_F(RenderProgram, PresetsAreListedAndPrinted) {
  EXPECT_NE(run_program("style").output.find("mechanism"), std::string::npos);
  EXPECT_NE(run_program("style defects").output.find("\"background\": \"order\""), std::string::npos);
  EXPECT_EQ(run_program("style grey").code, 2);
}

TEST_F(RenderProgram, SeveralRunsGoSideBySideWithOneClock) {
  const ScratchFolder first, second;
  plant_trajectory(first.path(), 4);
  plant_trajectory(second.path(), 2);  // ends at 0.05 s
  const std::string runs = first.path().string() + " " + second.path().string();
  const auto drawn = [&](const std::string& arguments) {
    const std::string out = (first / "both.png").string();
    test::expect_end(0, run_program("picture " + arguments + " --size 480x270 -o " + out));
    return read_png(out);
  };
  const Image last = drawn(runs + " --label one --label two");
  EXPECT_NE(last, drawn(runs + " --label one --label other")) << "each has its headline";
  EXPECT_NE(last, drawn(runs + " --label one --label two --time 0.05"));
  EXPECT_EQ(last, drawn(runs + " --label one --label two --time 0.15")) << "one that has ended shows its last frame";
  for (const char* file : {"both.svg", "both.pdf"}) {
    EXPECT_EQ(run_program("picture " + runs + " -o " + (first / file).string()).code, 0) << file;
  }
  EXPECT_EQ(nlohmann::json::parse(test::said_with(0, run_program("movie " + runs + " --size 320x180 --json -o " +
                                                                 (first / "both.mp4").string())))["frames"],
            4)
      << "as long as the first";

  EXPECT_THAT(test::said_with(2, run_program("picture " + runs + " /nowhere /neither -o x.png")),
              AllOf(HasSubstr("/nowhere"), HasSubstr("/neither")))
      << "all that is wrong is told at once";
  EXPECT_EQ(run_program("picture " + runs + " --frame 0 -o x.png").code, 2);
  EXPECT_EQ(run_program("picture " + runs).code, 2) << "it belongs to none of the runs";
  EXPECT_EQ(run_program("picture " + runs + " --size 320x180 -o " + (first / "g.png").string()).code, 0);
  std::string many = "picture";
  for (int i = 0; i < 30; ++i) many += " " + second.path().string();
  EXPECT_EQ(run_program(many + " --size 128x128 -o " + (first / "g.png").string()).code, 1) << "no room";
  EXPECT_EQ(run_program("picture " + runs + " --label a --label b --label c -o x.png").code, 2);
  EXPECT_EQ(run_program("picture " + runs + " --view gap -o " + (first / "g.png").string()).code, 1);
}

TEST_F(RenderProgram, BadInputIsTwoFailureIsOne) {
  plant(2);
  for (const std::string bad : {"",
                                "draw",
                                "picture",
                                "picture /nowhere",
                                "picture RUN --frame 2",
                                "picture RUN --frame -1",
                                "picture RUN --frame 1 --time 2",
                                "picture RUN --size 1280",
                                "picture RUN --size 10x10",
                                "picture RUN --size 1280x720x3",
                                "picture RUN --colour grey",
                                "picture RUN --zoom 0.1",
                                "picture RUN --focus 1",
                                "movie RUN --size 321x180",
                                "picture RUN --style grey",
                                "picture RUN --view follow:3",
                                "movie RUN --from soon",
                                "movie RUN --speed 1e-9",
                                "movie RUN -o m.avi",
                                "movie RUN --every 0",
                                "movie RUN --from 2 --to -1",
                                "live abc",
                                "picture RUN --view follow:plus",
                                "picture RUN --view follow:plus:x",
                                "picture RUN --inset sweep",
                                "picture RUN --inset sweep --sweep {}",
                                "live abc -o x.png --view follow:plus",
                                "live abc -o x.png --inset order"}) {
    std::string arguments = bad;
    if (const auto at = arguments.find("RUN"); at != std::string::npos) arguments.replace(at, 3, run_);
    const Ended ended = run_program(arguments);
    EXPECT_EQ(ended.code, 2) << bad << ": " << ended.output;
    EXPECT_FALSE(ended.output.empty()) << bad;
  }
  EXPECT_EQ(test::said_with(1, run_program("picture " + run_ + " -o /nowhere/p.png")),
            "shaken-render: cannot write /nowhere/p.png: No such file or directory\n");
  EXPECT_EQ(run_program("movie " + run_ + " -o /nowhere/m.mp4").code, 1);
  EXPECT_EQ(listing(folder_), "trajectory.h5");
}

TEST_F(RenderProgram, HelpAndVersion) {
  EXPECT_THAT(test::said_with(0, run_program("--help")), HasSubstr("Examples:"));
  EXPECT_EQ(run_program("--version").output.substr(0, 14), "shaken-render ");
}

}  // namespace
}  // namespace shaken::render
