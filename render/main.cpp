// SPDX-License-Identifier: MIT
// shaken-render: pictures and movies of recorded and of running jobs, without a display.
#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>

#include "base/failure.h"
#include "base/progress_line.h"
#include "base/text.h"
#include "proto/bus.h"
#include "render/make_movie.h"
#include "render/painter.h"
#include "render/png.h"
#include "render/sources.h"
#include "run/files/version.h"

namespace shaken::render {
namespace {

/// What the command line asks for.
struct Options {
  std::string source;  ///< run directory, trajectory.h5 or job
  std::string out;
  bool json = false;

  std::string colour = "layers";
  std::string theme = "light";
  std::string size;
  double zoom = 1;
  std::string focus = "0.5,0.5";
  std::string label;
  bool no_defects = false, no_caption = false, no_legend = false, no_scale_bar = false, bare = false;

  std::string frame = "last";
  std::optional<double> time_s;

  double fps = 30;
  std::optional<std::size_t> every;
  std::optional<double> from_s, to_s;
  bool keep_frames = false;

  std::string lcm_url = proto::default_url();
  double timeout_s = 15;
};

/// Two numbers with `separator` between them.
template <class T>
std::pair<T, T> parse_pair(const std::string& text, char separator, const std::string& what) {
  std::istringstream in(text);
  T first, second;
  char between = 0;
  if (!(in >> first >> between >> second) || between != separator || in.peek() != EOF) {
    throw Failure(ExitCode::kBadInput, fmt::format("{}, not '{}'", what, text));
  }
  return {first, second};
}

PictureStyle style_of(const Options& options) {
  PictureStyle style;
  if (!options.size.empty()) {
    const auto [width, height] = parse_pair<int>(options.size, 'x', "--size takes WIDTHxHEIGHT, like 1280x720");
    style.width = width;
    style.height = height;
  }
  const auto [x, y] = parse_pair<double>(options.focus, ',', "--focus takes X,Y in box sides, like 0.5,0.5");
  style.focus = Vec2(x, y);
  style.zoom = options.zoom;
  style.colouring = options.colour == "wheel" ? Colouring::kWheel : Colouring::kLayers;
  style.theme = options.theme == "dark" ? Theme::kDark : Theme::kLight;
  style.mark_defects = !options.no_defects;
  style.caption = !options.no_caption && !options.bare;
  style.legend = !options.no_legend && !options.bare;
  style.scale_bar = !options.no_scale_bar && !options.bare;
  done_or_fail(check(style), ExitCode::kBadInput);
  return style;
}

class Stopwatch {
 public:
  double seconds() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point start_ = Clock::now();
};

void report(const Options& options, const std::string& path, std::size_t frames, const PictureStyle& style,
            const Stopwatch& watch) {
  if (!options.json) {
    fmt::print("{}\n", path);
    return;
  }
  const nlohmann::ordered_json said = {{"path", path},
                                       {"frames", frames},
                                       {"width_px", style.width},
                                       {"height_px", style.height},
                                       {"seconds", std::round(watch.seconds() * 1000) / 1000}};
  fmt::print("{}\n", said.dump());
}

void paint_to_file(const Options& options, const PictureStyle& style, RodPicture picture, const std::string& out,
                   const Stopwatch& watch) {
  if (!options.label.empty()) picture.label = options.label;
  Painter painter = value_or_fail(Painter::create(), ExitCode::kFailed);
  const Image image = value_or_fail(painter.paint(picture, style), ExitCode::kFailed);
  done_or_fail(write_png(out, image, picture_texts(picture)));
  report(options, out, 1, style, watch);
}

/// `name` beside the trajectory, unless the command line says where.
std::string out_of(const Options& options, const TrajectorySource& source, const char* name) {
  return options.out.empty() ? (source.file().parent_path() / name).string() : options.out;
}

void make_picture(const Options& options) {
  const Stopwatch watch;
  const PictureStyle style = style_of(options);
  TrajectorySource source = value_or_fail(TrajectorySource::open(options.source), ExitCode::kBadInput);
  std::size_t index = source.n_frames() - 1;
  if (options.time_s) {
    index = value_or_fail(source.nearest_frame(*options.time_s), ExitCode::kFailed);
  } else if (options.frame != "last") {
    const bool digits = !options.frame.empty() && options.frame.size() < 10 &&
                        options.frame.find_first_not_of("0123456789") == std::string::npos;
    if (!digits || std::stoul(options.frame) >= source.n_frames()) {
      throw Failure(ExitCode::kBadInput, fmt::format("--frame takes 'last' or a number from 0 to {}, not '{}'",
                                                     source.n_frames() - 1, options.frame));
    }
    index = std::stoul(options.frame);
  }
  if (style.caption) done_or_fail(source.read_history());
  paint_to_file(options, style, value_or_fail(source.picture(index, style.mark_defects), ExitCode::kFailed),
                out_of(options, source, "picture.png"), watch);
}

void make_live_picture(const Options& options) {
  const Stopwatch watch;
  const PictureStyle style = style_of(options);
  const auto timeout = std::chrono::milliseconds(std::llround(options.timeout_s * 1000));
  RodPicture picture =
      value_or_fail(live_picture(options.lcm_url, options.source, timeout, style.mark_defects), ExitCode::kFailed);
  paint_to_file(options, style, std::move(picture), options.out, watch);
}

volatile std::sig_atomic_t stop_requested = 0;

/// How many recorded frames make up `every` seconds; at least 1.
std::size_t stride_for(const TrajectorySource& source, double every) {
  if (source.n_frames() < 2) return 1;
  const double first = value_or_fail(source.time_of(0), ExitCode::kFailed),
               second = value_or_fail(source.time_of(1), ExitCode::kFailed);
  return second > first ? static_cast<std::size_t>(std::max(1.0, std::round(every / (second - first)))) : 1;
}

void make_movie_file(const Options& options) {
  const Stopwatch watch;
  TrajectorySource source = value_or_fail(TrajectorySource::open(options.source), ExitCode::kBadInput);
  PictureStyle style = style_of(options);
  // What the command line leaves open, the scene may say.
  const std::optional<MovieRequest> request = source.movie_request();
  if (request && options.size.empty()) {
    style.width = request->width;
    style.height = request->height;
  }
  if (style.width % 2 != 0 || style.height % 2 != 0) {
    throw Failure(ExitCode::kBadInput, "a movie needs an even width and height, not " + options.size);
  }
  const std::size_t first =
      options.from_s ? value_or_fail(source.nearest_frame(*options.from_s), ExitCode::kFailed) : 0;
  const std::size_t last =
      options.to_s ? value_or_fail(source.nearest_frame(*options.to_s), ExitCode::kFailed) : source.n_frames() - 1;
  if (last < first) throw Failure(ExitCode::kBadInput, "--from is later than --to");
  const std::size_t stride = options.every ? *options.every : request ? stride_for(source, request->every) : 1;
  const std::size_t n_frames = (last - first) / stride + 1;

  const std::string out = out_of(options, source, "movie.mp4");
  MovieOptions movie{options.fps, options.label, std::nullopt};
  if (options.keep_frames) movie.keep_frames = std::filesystem::path(out).parent_path() / "frames";
  if (style.caption) done_or_fail(source.read_history());
  const auto picture = [&](std::size_t i) -> Result<RodPicture> {
    Result<RodPicture> rods = source.picture(first + i * stride, style.mark_defects);
    if (rods && !options.label.empty()) rods->label = options.label;
    return rods;
  };
  Painter painter = value_or_fail(Painter::create(), ExitCode::kFailed);
  std::signal(SIGINT, [](int) { stop_requested = 1; });
  std::signal(SIGTERM, [](int) { stop_requested = 1; });
  {
    ProgressLine progress("drawing");
    const Result<void> made = make_movie(painter, out, style, movie, n_frames, picture, [&](std::size_t i) {
      progress.show(static_cast<double>(i + 1) / static_cast<double>(n_frames));
      return stop_requested == 0;
    });
    done_or_fail(made, stop_requested != 0 ? ExitCode::kInterrupted : ExitCode::kFailed);
  }
  report(options, out, n_frames, style, watch);
}

void declare_style(CLI::App& app, Options& options) {
  app.add_option("-c,--colour", options.colour,
                 "layers: red and magenta by the angle to the director; wheel: by the angle in the box")
      ->check(CLI::IsMember({"layers", "wheel"}))
      ->capture_default_str();
  app.add_option("--theme", options.theme, "Colours of page and text")
      ->check(CLI::IsMember({"light", "dark"}))
      ->capture_default_str();
  app.add_option("--size", options.size,
                 "Pixels [a movie: the scene's; 1280x720]; wide, square and tall pictures are laid out differently")
      ->type_name("WxH");
  app.add_option("--zoom", options.zoom, "Shows a part of the box, this many times enlarged")
      ->check(CLI::Range(1.0, 1000.0))
      ->type_name("FACTOR");
  app.add_option("--focus", options.focus, "Middle of the zoomed part, in box sides")->type_name("X,Y");
  app.add_option("--label", options.label, "Headline")->type_name("TEXT");
  app.add_flag("--no-defects", options.no_defects, "Neither looks for defects nor marks them");
  app.add_flag("--no-caption", options.no_caption, "No numbers");
  app.add_flag("--no-legend", options.no_legend, "No colour scale");
  app.add_flag("--no-scale-bar", options.no_scale_bar, "No scale bar");
  app.add_flag("--bare", options.bare, "Only the box, filling the picture");
  app.add_flag("--json", options.json, "Prints path, frames, size and seconds as JSON");
}

int run(int argc, char** argv) {
  // Mesa would otherwise keep compiled shaders in the home directory; compiling them takes a tenth of a second.
  setenv("MESA_SHADER_CACHE_DISABLE", "true", 1);

  Options options;
  CLI::App app{"Pictures and movies of shaken rods, without a display.", "shaken-render"};
  app.set_version_flag("--version", std::string("shaken-render ") + run::version());
  app.require_subcommand(1);
  app.footer(
      "Examples:\n"
      "  shaken-render picture runs/first                           last frame -> runs/first/picture.png\n"
      "  shaken-render picture runs/first -o fig3.png --time 12.5 --colour wheel --size 1600x900\n"
      "  shaken-render picture runs/first -o box.png --bare --size 2000x2000\n"
      "  shaken-render movie runs/first                             -> runs/first/movie.mp4\n"
      "  shaken-render movie runs/first -o m.mp4 --from 10 --to 20 --every 2 --frames\n"
      "  shaken-render live 1f0c -o now.png                         a running job, from LCM\n"
      "Exit codes: 0 done, 1 failed, 2 bad input, 130 interrupted by Ctrl-C.");

  CLI::App* picture = app.add_subcommand("picture", "One frame of a recorded run as a PNG");
  picture->add_option("run", options.source, "Run directory or trajectory.h5")->required();
  picture->add_option("-o,--out", options.out, "File [picture.png beside the trajectory]")->type_name("FILE");
  CLI::Option* frame = picture->add_option("--frame", options.frame, "Frame, counted from 0")->type_name("N|last");
  picture->add_option("--time", options.time_s, "The frame nearest to this simulated time")
      ->type_name("S")
      ->excludes(frame);
  declare_style(*picture, options);

  CLI::App* movie = app.add_subcommand("movie", "A recorded run as an mp4 (H.264)");
  movie->add_option("run", options.source, "Run directory or trajectory.h5")->required();
  movie->add_option("-o,--out", options.out, "File [movie.mp4 beside the trajectory]")->type_name("FILE");
  movie->add_option("--fps", options.fps, "Frames per second of playing")
      ->check(CLI::Range(0.1, 1000.0))
      ->capture_default_str();
  movie->add_option("--every", options.every, "Takes every N-th frame [as the scene's movie.every says]")
      ->check(CLI::Range(1, 1000000000))
      ->type_name("N");
  movie->add_option("--from", options.from_s, "Begins at this simulated time")->type_name("S");
  movie->add_option("--to", options.to_s, "Ends at this simulated time")->type_name("S");
  movie->add_flag("--frames", options.keep_frames, "Keeps the frames too, in frames/frame_000000.png beside the movie");
  declare_style(*movie, options);

  CLI::App* live = app.add_subcommand("live", "The present state of a running job as a PNG, from LCM");
  live->add_option("job", options.source, "The job's id, or the beginning of it")->required();
  live->add_option("-o,--out", options.out, "File")->required()->type_name("FILE");
  live->add_option("--lcm-url", options.lcm_url, "The bus")->capture_default_str()->type_name("URL");
  live->add_option("--timeout", options.timeout_s, "How long to wait for a frame")
      ->check(CLI::Range(0.1, 86400.0))
      ->capture_default_str()
      ->type_name("S");
  declare_style(*live, options);

  try {
    app.parse(argc, argv);
    if (picture->parsed()) make_picture(options);
    if (movie->parsed()) make_movie_file(options);
    if (live->parsed()) make_live_picture(options);
    return static_cast<int>(ExitCode::kOk);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);
    fmt::print(stderr, "shaken-render: {} (see `shaken-render --help`)\n", error.what());
    return static_cast<int>(ExitCode::kBadInput);
  } catch (const Failure& failure) {
    fmt::print(stderr, "shaken-render: {}\n", printable(failure.what(), Lines::kMany));
    return static_cast<int>(failure.code);
  } catch (const std::exception& error) {
    fmt::print(stderr, "shaken-render: {}\n", printable(error.what(), Lines::kMany));
    return static_cast<int>(ExitCode::kFailed);
  }
}

}  // namespace
}  // namespace shaken::render

int main(int argc, char** argv) { return shaken::render::run(argc, argv); }
