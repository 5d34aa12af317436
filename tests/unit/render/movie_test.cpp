#include "render/movie.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <vector>

#include "base/process.h"
#include "render/make_movie.h"
#include "tests/support/good.h"
#include "tests/unit/render/render_support.h"

namespace shaken::render {
namespace movie_test {

using Rgb = std::array<std::uint8_t, 3>;
constexpr std::array<Rgb, 4> kColours = {Rgb{230, 20, 25}, Rgb{190, 20, 180}, Rgb{30, 160, 60}, Rgb{240, 240, 240}};

Image plain(int width, int height, const Rgb& colour) {
  Image image(width, height);
  for (std::size_t i = 0; i < image.rgb.size(); ++i) image.rgb[i] = colour[i % 3];
  return image;
}

/// A film as the programs ffprobe and ffmpeg read it.
struct Decoded {
  nlohmann::json stream, tags;
  std::vector<double> time;                ///< [s]
  std::vector<std::array<int, 3>> middle;  ///< Y, Cb, Cr of each frame's middle; R, G, B of a GIF's
};

std::string output_of(std::vector<std::string> command) {
  command.insert(command.begin() + 1, {"-v", "error"});
  const Captured said = run_captured(command, {.time = std::chrono::minutes(1)});
  EXPECT_EQ(said.exit_code, 0) << said.output;
  return said.output;
}

Decoded decode(const std::filesystem::path& file) {
  const auto told = nlohmann::json::parse(output_of({"ffprobe", "-of", "json", "-show_entries",
                                                     "stream=codec_name,width,height,pix_fmt,color_space,color_range,"
                                                     "avg_frame_rate:format_tags:frame=pts_time",
                                                     file}));
  Decoded movie{told.at("streams").at(0), told.at("format").value("tags", nlohmann::json::object()), {}, {}};
  for (const auto& frame : told.at("frames")) {
    movie.time.push_back(std::stod(frame.at("pts_time").get<std::string>()));
  }
  const bool is_gif = movie.stream.at("codec_name") == "gif";
  const std::string bytes =
      output_of({"ffmpeg", "-nostdin", "-i", file, "-fps_mode", "passthrough", "-vf",
                 is_gif ? "format=rgb24,crop=1:1" : "format=yuv420p,crop=2:2", "-f", "rawvideo", "-"});
  const std::array<std::size_t, 4> at =
      is_gif ? std::array<std::size_t, 4>{0, 1, 2, 3} : std::array<std::size_t, 4>{0, 4, 5, 6};
  for (std::size_t i = 0; i + at[3] <= bytes.size(); i += at[3]) {
    const auto byte = [&](std::size_t c) { return static_cast<int>(static_cast<std::uint8_t>(bytes[i + at[c]])); };
    movie.middle.push_back({byte(0), byte(1), byte(2)});
  }
  return movie;
}

/// Rec. ITU-R BT.709: from 8-bit RGB to 8-bit limited-range Y, Cb, Cr.
std::array<int, 3> bt709(const Rgb& c) {
  const double y = (0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2]) / 255;
  const double cb = (c[2] / 255.0 - y) / 1.8556, cr = (c[0] / 255.0 - y) / 1.5748;
  return {static_cast<int>(std::lround(16 + 219 * y)), static_cast<int>(std::lround(128 + 224 * cb)),
          static_cast<int>(std::lround(128 + 224 * cr))};
}

void write_movie(const std::filesystem::path& file, int n_frames, double fps = 30) {
  Result<MovieWriter> movie = test::good(MovieWriter::create(file, 128, 96, fps));
  for (int i = 0; i < n_frames; ++i) ASSERT_TRUE(movie->add(plain(128, 96, kColours[static_cast<std::size_t>(i) % 4])));
  const auto done = test::good(movie->finish());
}

std::string bytes_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

TEST(Movie, DecodesToWhatWasPutIn) {
  const ScratchFolder folder;
  write_movie(folder / "m.mp4", 70, 25);
  EXPECT_EQ(listing(folder), "m.mp4");
  const Decoded movie = decode(folder / "m.mp4");
  EXPECT_EQ(movie.stream, nlohmann::json::parse(R"({"codec_name": "h264", "width": 128, "height": 96,
      "pix_fmt": "yuv420p", "color_space": "bt709", "color_range": "tv", "avg_frame_rate": "25/1"})"));
  ASSERT_EQ(movie.middle.size(), 70u);
  for (std::size_t i = 0; i < 70; ++i) {
    EXPECT_NEAR(movie.time[i], static_cast<double>(i) / 25, 1e-6);
    // With BT.601 red would be 19 brighter.
    const std::array<int, 3> expected = bt709(kColours[i % 4]);
    for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(movie.middle[i][c], expected[c], 3) << i << ' ' << c;
  }
}

TEST(Movie, TheIndexIsAtTheFront) {
  const ScratchFolder folder;
  write_movie(folder / "m.mp4", 5);
  const std::string bytes = bytes_of(folder / "m.mp4");
  EXPECT_LT(bytes.find("moov"), bytes.find("mdat"));
}

TEST(Movie, SameFramesSameFile) {
  const ScratchFolder folder;
  write_movie(folder / "a.mp4", 20);
  write_movie(folder / "b.mp4", 20);
  EXPECT_EQ(bytes_of(folder / "a.mp4"), bytes_of(folder / "b.mp4"));
}

TEST(Movie, AnUnfinishedMovieLeavesNothingAndTheOldOneStays) {
  const ScratchFolder folder;
  write_movie(folder / "m.mp4", 3);
  const std::string old = bytes_of(folder / "m.mp4");
  {
    Result<MovieWriter> movie = test::good(MovieWriter::create(folder / "m.mp4", 128, 96, 30));
    ASSERT_TRUE(movie->add(plain(128, 96, kColours[0])));
  }
  EXPECT_EQ(listing(folder), "m.mp4");
  EXPECT_EQ(bytes_of(folder / "m.mp4"), old);
}

TEST(Movie, RefusesOddSizesOddRatesAndOtherFrames) {
  const ScratchFolder folder;
  EXPECT_TRUE(check_movie("m.gif", 127, 95, 50));
  EXPECT_FALSE(check_movie("m.gif", 128, 96, 51)) << "before a run is opened";
  EXPECT_FALSE(MovieWriter::create(folder / "m.mp4", 127, 96, 30));
  EXPECT_FALSE(MovieWriter::create(folder / "m.mp4", 128, 95, 30));
  EXPECT_FALSE(MovieWriter::create(folder / "m.mp4", 128, 96, 0));
  EXPECT_FALSE(MovieWriter::create(folder / "m.mp4", 128, 96, NAN));
  Result<MovieWriter> movie = test::good(MovieWriter::create(folder / "m.mp4", 128, 96, 30));
  EXPECT_FALSE(movie->add(plain(96, 128, kColours[0])));
}

TEST(Movie, AFolderThatDoesNotExistIsAnError) {
  EXPECT_THAT(test::refusal(MovieWriter::create("/nowhere/at/all/m.mp4", 128, 96, 30)),
              testing::HasSubstr("/nowhere/at/all/m.mp4: No such file"));
}

/// While it lives, `ffmpeg` is a program of the shell with these lines; without lines there is none.
class OtherFfmpeg {
 public:
  explicit OtherFfmpeg(const std::string& lines) {
    setenv("PATH", folder_.path().c_str(), 1);
    if (lines.empty()) return;
    std::ofstream(folder_ / "ffmpeg") << "#!/bin/sh\nPATH='" << path_ << "'\n" << lines << '\n';
    std::filesystem::permissions(folder_ / "ffmpeg", std::filesystem::perms::owner_all);
  }
  OtherFfmpeg(const OtherFfmpeg&) = delete;
  OtherFfmpeg& operator=(const OtherFfmpeg&) = delete;
  ~OtherFfmpeg() { setenv("PATH", path_.c_str(), 1); }

 private:
  const ScratchFolder folder_;
  const std::string path_ = std::getenv("PATH");
};

TEST(Movie, FailuresOfFfmpegAreToldAndLeaveNoFile) {
  const ScratchFolder folder;
  // A file that can grow no more fails as a full disk does: here when ffmpeg writes the index of a short film.
  const std::array<std::pair<const char*, const char*>, 4> cases = {
      std::pair{"", "ffmpeg cannot be run: No such file or directory; it encodes films: `apt install ffmpeg`"},
      {"echo No space left on device; exit 1", "ffmpeg failed with exit code 1: No space left on device"},
      {"trap '' XFSZ; ulimit -f 1; exec ffmpeg \"$@\"", "File too large"},
      {"kill -9 $$", "ffmpeg was ended by signal 9"}};
  for (const auto& [lines, words] : cases) {
    const OtherFfmpeg ffmpeg(lines);
    Result<MovieWriter> movie = MovieWriter::create(folder / "m.mp4", 128, 96, 30);
    Result<void> done = movie ? movie->add(plain(128, 96, kColours[0])) : movie.error();
    if (done) done = movie->finish();
    ASSERT_FALSE(done) << lines;
    EXPECT_NE(done.error().message.find(words), std::string::npos) << done.error().message;
  }
  EXPECT_EQ(listing(folder), "");
}

TEST(Movie, AFilmThatHasFailedFailsAgainAndWaitsForNobody) {
  const ScratchFolder folder;
  const OtherFfmpeg ffmpeg("kill -9 $$");
  Result<MovieWriter> movie = test::good(MovieWriter::create(folder / "m.mp4", 128, 96, 30));
  const auto add = [&] { return movie->add(plain(128, 96, kColours[0])); };
  auto added = add();
  for (int i = 0; i < 1000 && added; ++i) added = add();
  ASSERT_FALSE(added);
  EXPECT_NE(added.error().message.find("signal 9"), std::string::npos) << added.error().message;
  const Result<pid_t> other = test::good(start_child({.command = {"/bin/sleep", "5"}}));
  EXPECT_FALSE(add());
  EXPECT_FALSE(movie->finish());
  EXPECT_FALSE(poll_child(*other)) << "a child of somebody else's";
  kill(*other, SIGKILL);
  wait_for_child(*other);
}

TEST(Movie, AGifIsAGif) {
  const ScratchFolder folder;
  Result<MovieWriter> movie = test::good(
      MovieWriter::create(folder / "m.gif", 129, 96, 20, "", {{"Run id", std::string(300, 'a')}, {"Seed", "7"}}));
  for (std::size_t i = 0; i < 6; ++i) ASSERT_TRUE(movie->add(plain(129, 96, kColours[i % 4])));
  const auto done = test::good(movie->finish());
  EXPECT_EQ(listing(folder), "m.gif");
  const std::string bytes = bytes_of(folder / "m.gif");
  EXPECT_EQ(bytes.substr(0, 6), "GIF89a");
  EXPECT_EQ(bytes.back(), '\x3B');
  const std::string comment = std::string("\x21\xFE\xFF", 3) + "Run id: " + std::string(247, 'a') +
                              static_cast<char>(300 - 247 + 9) + std::string(300 - 247, 'a') + "; Seed: 7";
  EXPECT_NE(bytes.find(comment), std::string::npos) << "the notes, in blocks of 255 bytes";
  const Decoded shown = decode(folder / "m.gif");
  ASSERT_EQ(shown.middle.size(), 6u);
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_NEAR(shown.time[i], 0.05 * static_cast<double>(i), 1e-6);
    for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(shown.middle[i][c], kColours[i % 4][c], 4) << i << ' ' << c;
  }
  EXPECT_FALSE(MovieWriter::create(folder / "m.gif", 128, 96, 60)) << "GIF counts in hundredths of a second";
}

TEST(Movie, WebmDecodes) {
  const ScratchFolder folder;
  Result<MovieWriter> movie = test::good(MovieWriter::create(folder / "m.webm", 128, 96, 25));
  for (std::size_t i = 0; i < 4; ++i) ASSERT_TRUE(movie->add(plain(128, 96, kColours[i % 4])));
  ASSERT_TRUE(movie->finish());
  const Decoded decoded = decode(folder / "m.webm");
  ASSERT_EQ(decoded.middle.size(), 4u);
  EXPECT_EQ(decoded.stream.at("color_space"), "bt709");
  for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(decoded.middle[0][c], bt709(kColours[0])[c], 4) << c;
}

TEST(Movie, OtherEndingsAreRefused) {
  const ScratchFolder folder;
  for (const char* name : {"m.avi", "m", "m.mp4.txt", "m.GIF"}) {
    EXPECT_THAT(test::refusal(MovieWriter::create(folder / name, 128, 96, 30)),
                testing::HasSubstr(".mp4, .webm or .gif"));
  }
  EXPECT_EQ(listing(folder), "");
}

TEST(Movie, SaysWhereItComesFrom) {
  const ScratchFolder folder;
  Result<MovieWriter> movie = test::good(
      MovieWriter::create(folder / "m.mp4", 128, 96, 30, "\u03c6 = 0.8", {{"Run id", "1f0c"}, {"Seed", "3"}}));
  ASSERT_TRUE(movie->add(plain(128, 96, kColours[0])));
  ASSERT_TRUE(movie->finish());
  const Decoded decoded = decode(folder / "m.mp4");
  EXPECT_EQ(decoded.tags.at("title"), "\u03c6 = 0.8");
  EXPECT_EQ(decoded.tags.at("comment"), "Run id: 1f0c; Seed: 3");
}

PictureStyle small() {
  PictureStyle style;
  style.width = 320;
  style.height = 180;
  return style;
}

Result<RodPicture> turning(std::size_t i) {
  RodPicture picture = empty_picture(10);
  add_rod(picture, 5, 5, 0.1 * static_cast<double>(i));
  return picture;
}

TEST(MakeMovie, KeepsItsFramesOnRequest) {
  const ScratchFolder folder;
  std::vector<std::size_t> told;
  MovieOptions options;
  options.keep_frames = folder / "frames";
  const auto made = make_movie((folder / "m.mp4").string(), small(), options, 3, turning, [&](std::size_t i) {
    told.push_back(i);
    return true;
  });
  ASSERT_TRUE(made) << made.error().message;
  EXPECT_EQ(told, (std::vector<std::size_t>{0, 1, 2}));
  EXPECT_EQ(decode(folder / "m.mp4").middle.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    const Image frame = read_png(folder / ("frames/frame_00000" + std::to_string(i) + ".png"));
    EXPECT_EQ(frame, painter().paint(turning(i).value(), small()).value());
  }
}

TEST(MakeMovie, IsTheSameFileOnAnyNumberOfThreads) {
  const ScratchFolder folder;
  std::string first;
  for (const int threads : {1, 2, 5}) {
    MovieOptions options;
    options.n_threads = threads;
    const auto made = test::good(make_movie((folder / "m.mp4").string(), small(), options, 12, turning));
    if (first.empty()) first = bytes_of(folder / "m.mp4");
    EXPECT_EQ(bytes_of(folder / "m.mp4"), first) << threads;
  }
}

TEST(MakeMovie, AFolderGetsNumberedFramesAndNoFilm) {
  const ScratchFolder folder;
  ASSERT_TRUE(make_movie((folder / "frames/").string(), small(), {}, 2, turning));
  EXPECT_EQ(listing(folder), "frames");
  EXPECT_EQ(read_png(folder / "frames/frame_000001.png"), painter().paint(turning(1).value(), small()).value());
}

TEST(MakeMovie, StoppingAndFailingFramesLeaveNoMovie) {
  const ScratchFolder folder;
  const auto stopped =
      make_movie((folder / "m.mp4").string(), small(), {}, 5, turning, [](std::size_t i) { return i < 1; });
  ASSERT_FALSE(stopped);
  EXPECT_EQ(stopped.error().message, "stopped after 2 frames");
  const auto failed = make_movie((folder / "m.mp4").string(), small(), {}, 5, [](std::size_t i) -> Result<RodPicture> {
    if (i == 2) return Error{"torn"};
    return turning(i);
  });
  ASSERT_FALSE(failed);
  EXPECT_EQ(failed.error().message, "torn");
  EXPECT_FALSE(make_movie((folder / "m.mp4").string(), small(), {}, 0, turning));
  EXPECT_EQ(listing(folder), "");
}

}  // namespace movie_test
}  // namespace shaken::render
