// SPDX-License-Identifier: MIT
#include "render/movie.h"

#include <gtest/gtest.h>

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
}

#include <array>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <vector>

#include "render/make_movie.h"
#include "tests/unit/render/render_support.h"

namespace shaken::render {
namespace {

using Rgb = std::array<std::uint8_t, 3>;
constexpr std::array<Rgb, 4> kColours = {Rgb{230, 20, 25}, Rgb{190, 20, 180}, Rgb{30, 160, 60}, Rgb{240, 240, 240}};

Image plain(int width, int height, const Rgb& colour) {
  Image image(width, height);
  for (std::size_t i = 0; i < image.rgb.size(); ++i) image.rgb[i] = colour[i % 3];
  return image;
}

struct Decoded {
  int width = 0, height = 0;
  AVPixelFormat format = AV_PIX_FMT_NONE;
  AVColorSpace matrix = AVCOL_SPC_UNSPECIFIED;
  AVColorRange range = AVCOL_RANGE_UNSPECIFIED;
  double fps = 0;
  std::vector<double> time;                ///< [s]
  std::vector<std::array<int, 3>> middle;  ///< Y, Cb, Cr of each frame's middle
};

Decoded decode(const std::filesystem::path& file) {
  Decoded movie;
  AVFormatContext* format = nullptr;
  if (avformat_open_input(&format, file.c_str(), nullptr, nullptr) < 0) {
    ADD_FAILURE() << "cannot open " << file;
    return movie;
  }
  avformat_find_stream_info(format, nullptr);
  const AVStream* stream = format->streams[0];
  AVCodecContext* codec = avcodec_alloc_context3(avcodec_find_decoder(stream->codecpar->codec_id));
  avcodec_parameters_to_context(codec, stream->codecpar);
  avcodec_open2(codec, codec->codec, nullptr);
  movie.fps = av_q2d(stream->avg_frame_rate);
  AVPacket* packet = av_packet_alloc();
  AVFrame* frame = av_frame_alloc();
  const auto drain = [&] {
    while (avcodec_receive_frame(codec, frame) == 0) {
      movie.width = frame->width;
      movie.height = frame->height;
      movie.format = static_cast<AVPixelFormat>(frame->format);
      movie.matrix = frame->colorspace;
      movie.range = frame->color_range;
      movie.time.push_back(static_cast<double>(frame->pts) * av_q2d(stream->time_base));
      const int x = frame->width / 2, y = frame->height / 2;
      movie.middle.push_back({frame->data[0][y * frame->linesize[0] + x],
                              frame->data[1][y / 2 * frame->linesize[1] + x / 2],
                              frame->data[2][y / 2 * frame->linesize[2] + x / 2]});
    }
  };
  while (av_read_frame(format, packet) == 0) {
    avcodec_send_packet(codec, packet);
    av_packet_unref(packet);
    drain();
  }
  avcodec_send_packet(codec, nullptr);
  drain();
  av_frame_free(&frame);
  av_packet_free(&packet);
  avcodec_free_context(&codec);
  avformat_close_input(&format);
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
  Result<MovieWriter> movie = MovieWriter::create(file, 128, 96, fps);
  ASSERT_TRUE(movie) << movie.error().message;
  for (int i = 0; i < n_frames; ++i) ASSERT_TRUE(movie->add(plain(128, 96, kColours[static_cast<std::size_t>(i) % 4])));
  const auto done = movie->finish();
  ASSERT_TRUE(done) << done.error().message;
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
  EXPECT_EQ(movie.width, 128);
  EXPECT_EQ(movie.height, 96);
  EXPECT_EQ(movie.format, AV_PIX_FMT_YUV420P);
  EXPECT_EQ(movie.matrix, AVCOL_SPC_BT709);
  EXPECT_EQ(movie.range, AVCOL_RANGE_MPEG);
  EXPECT_DOUBLE_EQ(movie.fps, 25);
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
    Result<MovieWriter> movie = MovieWriter::create(folder / "m.mp4", 128, 96, 30);
    ASSERT_TRUE(movie);
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
  Result<MovieWriter> movie = MovieWriter::create(folder / "m.mp4", 128, 96, 30);
  ASSERT_TRUE(movie);
  EXPECT_FALSE(movie->add(plain(96, 128, kColours[0])));
}

TEST(Movie, AFolderThatDoesNotExistIsAnError) {
  const Result<MovieWriter> movie = MovieWriter::create("/nowhere/at/all/m.mp4", 128, 96, 30);
  ASSERT_FALSE(movie);
  EXPECT_NE(movie.error().message.find("/nowhere/at/all/m.mp4: No such file"), std::string::npos)
      << movie.error().message;
}

TEST(Movie, FailuresOfFfmpegAreToldAndLeaveNoFile) {
  const ScratchFolder folder, programs;
  const std::string path = std::getenv("PATH");
  setenv("PATH", programs.path().c_str(), 1);
  const Result<MovieWriter> none = MovieWriter::create(folder / "m.mp4", 128, 96, 30);
  std::ofstream(programs / "ffmpeg") << "#!/bin/sh\necho No space left on device\nexit 1\n";
  std::filesystem::permissions(programs / "ffmpeg", std::filesystem::perms::owner_all);
  {
    Result<MovieWriter> full = MovieWriter::create(folder / "m.mp4", 128, 96, 30);
    setenv("PATH", path.c_str(), 1);
    ASSERT_TRUE(full);
    const auto done = full->finish();
    ASSERT_FALSE(done);
    EXPECT_NE(done.error().message.find("ffmpeg failed with exit code 1: No space left"), std::string::npos)
        << done.error().message;
  }
  ASSERT_FALSE(none);
  EXPECT_NE(none.error().message.find("`apt install ffmpeg`"), std::string::npos) << none.error().message;
  EXPECT_EQ(listing(folder), "");
}

/// The colour of the middle of each frame, and when it is shown.
struct Shown {
  std::vector<Rgb> middle;
  std::vector<double> time;
};
Shown decode_gif(const std::filesystem::path& file) {
  Shown shown;
  AVFormatContext* format = nullptr;
  EXPECT_GE(avformat_open_input(&format, file.c_str(), av_find_input_format("gif"), nullptr), 0);
  if (!format) return shown;
  avformat_find_stream_info(format, nullptr);
  const AVStream* stream = format->streams[0];
  AVCodecContext* codec = avcodec_alloc_context3(avcodec_find_decoder(AV_CODEC_ID_GIF));
  avcodec_parameters_to_context(codec, stream->codecpar);
  avcodec_open2(codec, codec->codec, nullptr);
  AVPacket* packet = av_packet_alloc();
  AVFrame* frame = av_frame_alloc();
  while (av_read_frame(format, packet) == 0) {
    avcodec_send_packet(codec, packet);
    av_packet_unref(packet);
    while (avcodec_receive_frame(codec, frame) == 0) {
      EXPECT_EQ(frame->format, AV_PIX_FMT_BGRA);
      const std::uint8_t* p = frame->data[0] + frame->height / 2 * frame->linesize[0] + frame->width / 2 * 4;
      shown.middle.push_back({p[2], p[1], p[0]});
      shown.time.push_back(static_cast<double>(frame->pts) * av_q2d(stream->time_base));
    }
  }
  av_frame_free(&frame);
  av_packet_free(&packet);
  avcodec_free_context(&codec);
  avformat_close_input(&format);
  return shown;
}

TEST(Movie, AGifIsAGif) {
  const ScratchFolder folder;
  Result<MovieWriter> movie =
      MovieWriter::create(folder / "m.gif", 129, 96, 20, "", {{"Run id", std::string(300, 'a')}, {"Seed", "7"}});
  ASSERT_TRUE(movie) << movie.error().message;
  for (std::size_t i = 0; i < 6; ++i) ASSERT_TRUE(movie->add(plain(129, 96, kColours[i % 4])));
  const auto done = movie->finish();
  ASSERT_TRUE(done) << done.error().message;
  EXPECT_EQ(listing(folder), "m.gif");
  const std::string bytes = bytes_of(folder / "m.gif");
  EXPECT_EQ(bytes.substr(0, 6), "GIF89a");
  EXPECT_EQ(bytes.back(), '\x3B');
  const std::string comment = std::string("\x21\xFE\xFF", 3) + "Run id: " + std::string(247, 'a') +
                              static_cast<char>(300 - 247 + 9) + std::string(300 - 247, 'a') + "; Seed: 7";
  EXPECT_NE(bytes.find(comment), std::string::npos) << "the notes, in blocks of 255 bytes";
  const Shown shown = decode_gif(folder / "m.gif");
  ASSERT_EQ(shown.middle.size(), 6u);
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_NEAR(shown.time[i], 0.05 * static_cast<double>(i), 1e-6);
    for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(shown.middle[i][c], kColours[i % 4][c], 4) << i << ' ' << c;
  }
  EXPECT_FALSE(MovieWriter::create(folder / "m.gif", 128, 96, 60)) << "GIF counts in hundredths of a second";
}

TEST(Movie, WebmDecodes) {
  const ScratchFolder folder;
  Result<MovieWriter> movie = MovieWriter::create(folder / "m.webm", 128, 96, 25);
  ASSERT_TRUE(movie) << movie.error().message;
  for (std::size_t i = 0; i < 4; ++i) ASSERT_TRUE(movie->add(plain(128, 96, kColours[i % 4])));
  ASSERT_TRUE(movie->finish());
  const Decoded decoded = decode(folder / "m.webm");
  ASSERT_EQ(decoded.middle.size(), 4u);
  EXPECT_EQ(decoded.matrix, AVCOL_SPC_BT709);
  for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(decoded.middle[0][c], bt709(kColours[0])[c], 4) << c;
}

TEST(Movie, OtherEndingsAreRefused) {
  const ScratchFolder folder;
  for (const char* name : {"m.avi", "m", "m.mp4.txt", "m.GIF"}) {
    const Result<MovieWriter> movie = MovieWriter::create(folder / name, 128, 96, 30);
    ASSERT_FALSE(movie) << name;
    EXPECT_NE(movie.error().message.find(".mp4, .webm or .gif"), std::string::npos) << movie.error().message;
  }
  EXPECT_EQ(listing(folder), "");
}

TEST(Movie, SaysWhereItComesFrom) {
  const ScratchFolder folder;
  Result<MovieWriter> movie =
      MovieWriter::create(folder / "m.mp4", 128, 96, 30, "\u03c6 = 0.8", {{"Run id", "1f0c"}, {"Seed", "3"}});
  ASSERT_TRUE(movie);
  ASSERT_TRUE(movie->add(plain(128, 96, kColours[0])));
  ASSERT_TRUE(movie->finish());
  AVFormatContext* format = nullptr;
  ASSERT_GE(avformat_open_input(&format, (folder / "m.mp4").c_str(), nullptr, nullptr), 0);
  const auto tag = [&](const char* key) {
    const AVDictionaryEntry* entry = av_dict_get(format->metadata, key, nullptr, 0);
    return entry ? std::string(entry->value) : std::string();
  };
  EXPECT_EQ(tag("title"), "\u03c6 = 0.8");
  EXPECT_EQ(tag("comment"), "Run id: 1f0c; Seed: 3");
  avformat_close_input(&format);
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
    const auto made = make_movie((folder / "m.mp4").string(), small(), options, 12, turning);
    ASSERT_TRUE(made) << made.error().message;
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

}  // namespace
}  // namespace shaken::render
