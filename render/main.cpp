// SPDX-License-Identifier: MIT
// shaken-render: pictures and movies of recorded and of running jobs, without a display.
#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <iostream>
#include <iterator>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "base/failure.h"
#include "base/files.h"
#include "base/help_formatter.h"
#include "base/keys/units.h"
#include "base/progress_line.h"
#include "base/standard_streams.h"
#include "base/text.h"
#include "proto/bus.h"
#include "render/colourings.h"
#include "render/film_axes.h"
#include "render/headline.h"
#include "render/make_movie.h"
#include "render/movie.h"
#include "render/painter.h"
#include "render/png.h"
#include "render/sources.h"
#include "render/style_file.h"
#include "render/style_keys.h"
#include "render/sweep_map.h"
#include "run/files/version.h"

namespace shaken::render {
namespace {

/// What the command line asks for.
struct Options {
  std::vector<std::string> sources;  ///< run directories or trajectory.h5; of a live picture, one job
  std::string out;
  bool json = false;

  std::string style;                        ///< preset or file; empty: none
  std::map<std::string, std::string> keys;  ///< of the style, as given
  std::map<std::string, bool> switches;     ///< of the style, as given
  std::vector<std::string> labels;          ///< of the sources, in their order
  bool bare = false;

  int depth = 8;  ///< bits a colour
  std::string frame = "last";
  std::string time;

  std::string sweep;  ///< JSON of sweep_places
  std::optional<std::size_t> every;
  std::string from, to;
  bool keep_frames = false;
  int n_threads = 0;
  std::string progress;

  std::string lcm_url = proto::default_url();
  double timeout_s = 15;
  std::string preset;
};

/// The style that the command line asks for, over that of the scene. Lists everything that is wrong with it.
PictureStyle style_of(const Options& options, PictureStyle style = {}) {
  if (!options.style.empty()) style = value_or_fail(named_style(options.style, style), ExitCode::kBadInput);
  std::string wrong;
  for (const StyleKey& key : style_keys()) {
    if (const auto given = options.keys.find(key.path); given != options.keys.end() && !given->second.empty()) {
      const Result<void> done = set_from_text(style, key, given->second);
      if (!done) wrong += fmt::format("{}--{}: {}", wrong.empty() ? "" : "\n", option_of(key), done.error().message);
    }
    if (const auto given = options.switches.find(key.path); given != options.switches.end()) {
      key.store(style, given->second);
    }
  }
  if (!wrong.empty()) throw Failure(ExitCode::kBadInput, wrong);
  if (options.bare) style.caption = style.legend = style.scale_bar = false;
  done_or_fail(check(style), ExitCode::kBadInput);
  return style;
}

/// "10 s", "500ms", "12.5".
double seconds_in(const std::string& text, const char* option) {
  const Result<double> time = keys::parse_quantity(text, keys::Dimension::kTime);
  if (!time) throw Failure(ExitCode::kBadInput, fmt::format("{}: {}", option, time.error().message));
  return *time;
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
  if (path == "-") return;  // stdout has the frames
  if (!options.json) {
    std::cout << path << "\n";
    return;
  }
  const nlohmann::ordered_json said = {{"path", path},
                                       {"frames", frames},
                                       {"width_px", style.width},
                                       {"height_px", style.height},
                                       {"seconds", std::round(watch.seconds() * 1000) / 1000}};
  std::cout << said.dump() << "\n";
}

/// The headline that the command line gives source `i`, above what the picture said of itself.
void set_label(const Options& options, std::size_t i, RodPicture& picture) {
  if (i >= options.labels.size() || options.labels[i].empty()) return;
  picture.subtitle = picture.label;
  picture.label = headline(printable(options.labels[i]));
}

void check_picture_name(const Options& options) {
  const std::string ending = std::filesystem::path(options.out).extension().string();
  if (options.depth != 8 && ending != ".png" && !options.out.empty()) {
    throw Failure(ExitCode::kBadInput, fmt::format("--depth {} is for .png, not for '{}'", options.depth, options.out));
  }
  if (options.out.empty() || ending == ".png" || ending == ".svg" || ending == ".pdf") return;
  throw Failure(ExitCode::kBadInput,
                fmt::format("a picture is written as .png, .svg or .pdf, not as '{}'", options.out));
}

void paint_to_file(const Options& options, const PictureStyle& style, const RodPicture& picture, const std::string& out,
                   const Stopwatch& watch) {
  if (std::filesystem::path(out).extension() != ".png") {
    done_or_fail(write_vector(out, picture, style));
  } else {
    Painter painter = value_or_fail(Painter::create(), ExitCode::kFailed);
    const auto paint = [&]<class Channel>(Channel) {
      const ImageOf<Channel> image = value_or_fail(painter.paint<Channel>(picture, style), ExitCode::kFailed);
      done_or_fail(write_png(out, image, picture_texts(picture)));
    };
    options.depth == 16 ? paint(std::uint16_t{}) : paint(std::uint8_t{});
  }
  report(options, out, 1, style, watch);
}

/// `name` beside the trajectory, unless the command line says where.
std::string out_of(const Options& options, const TrajectorySource& source, const char* name) {
  return options.out.empty() ? (source.file().parent_path() / name).string() : options.out;
}

/// That the rods have what the style asks of them.
void check_picture(const PictureStyle& style, const RodPicture& picture) {
  if (style.inset == Inset::kG2Map && picture.cell.walls) {
    throw Failure(ExitCode::kBadInput,
                  "the map of G2 is of pairs in a periodic box, and these rods are between side walls: use g2, G2(r)");
  }
  if (style.followed && static_cast<std::size_t>(*style.followed) >= picture.n_rods()) {
    throw Failure(ExitCode::kBadInput, fmt::format("there is no rod {}: they are numbered from 0 to {}",
                                                   *style.followed, static_cast<std::ptrdiff_t>(picture.n_rods()) - 1));
  }
}

/// Has the defect followed that the style names, in the recorded frames from `first` to `last` [s].
void follow_defect(const PictureStyle& style, std::vector<TrajectorySource>& sources, double first, double last) {
  if (!style.followed_defect) return;
  for (TrajectorySource& source : sources) {
    const std::size_t from = value_or_fail(source.nearest_frame(first)), to = value_or_fail(source.nearest_frame(last));
    done_or_fail(source.follow(*style.followed_defect, from, to), ExitCode::kBadInput);
  }
}

std::vector<TrajectorySource> open_sources(const Options& options) {
  std::vector<TrajectorySource> sources;
  std::string wrong;
  for (const std::string& name : options.sources) {
    Result<TrajectorySource> source = TrajectorySource::open(name);
    if (source) {
      sources.push_back(std::move(*source));
    } else {
      wrong += (wrong.empty() ? "" : "\n") + source.error().message;
    }
  }
  if (!wrong.empty()) throw Failure(ExitCode::kBadInput, wrong);
  if (options.labels.size() > sources.size()) {
    throw Failure(ExitCode::kBadInput,
                  fmt::format("{} headlines (--label) for {} runs", options.labels.size(), sources.size()));
  }
  return sources;
}

/// Where the runs are in their sweep; nothing where the style does not ask.
SweepPlaces places_of(const Options& options, const PictureStyle& style) {
  if (style.inset != Inset::kSweep) return {};
  if (options.sweep.empty()) {
    throw Failure(ExitCode::kBadInput,
                  "an inset of the sweep takes its points from --sweep: `shaken picture` and `shaken movie` give it "
                  "where --inset sweep is on their command line");
  }
  return value_or_fail(sweep_places(options.sweep, options.sources.size()), ExitCode::kBadInput);
}

/// Frame `frame_of(i)` of source i: one picture, with those of further sources beside it.
Result<RodPicture> joint_picture(const Options& options, const PictureStyle& style, const SweepPlaces& places,
                                 std::vector<TrajectorySource>& sources,
                                 const std::function<Result<std::size_t>(std::size_t)>& frame_of) {
  std::vector<RodPicture> pictures;
  for (std::size_t i = 0; i < sources.size(); ++i) {
    const Result<std::size_t> frame = frame_of(i);
    if (!frame) return frame.error();
    Result<RodPicture> picture = sources[i].picture(*frame, style);
    if (!picture) return picture;
    check_picture(style, *picture);
    set_label(options, i, *picture);
    picture->sweep = places.map;
    if (places.map) picture->sweep_point = places.here[i];
    pictures.push_back(std::move(*picture));
  }
  RodPicture first = std::move(pictures.front());
  for (std::size_t i = 1; i < pictures.size(); ++i) {
    for (const auto& [key, value] : pictures[i].notes) {
      if (key != "Software") first.notes.emplace_back(fmt::format("{} ({})", key, i + 1), value);
    }
  }
  first.beside.assign(std::make_move_iterator(pictures.begin() + 1), std::make_move_iterator(pictures.end()));
  return first;
}

/// The frame that `--frame` names.
std::size_t frame_in(const Options& options, const std::vector<TrajectorySource>& sources) {
  const std::size_t n_frames = sources.front().n_frames();
  const bool digits = !options.frame.empty() && options.frame.size() < 10 &&
                      options.frame.find_first_not_of("0123456789") == std::string::npos;
  if (sources.size() > 1) {
    throw Failure(ExitCode::kBadInput,
                  "--frame takes a number for one run only: runs have frames at different times; "
                  "use --time");
  }
  if (!digits || std::stoul(options.frame) >= n_frames) {
    throw Failure(ExitCode::kBadInput,
                  fmt::format("--frame takes 'last' or a number from 0 to {}, not '{}'", n_frames - 1, options.frame));
  }
  return std::stoul(options.frame);
}

void make_picture(const Options& options) {
  const Stopwatch watch;
  PictureStyle style = style_of(options);
  check_picture_name(options);
  std::vector<TrajectorySource> sources = open_sources(options);
  if (sources.size() > 1 && options.out.empty()) throw Failure(ExitCode::kBadInput, "several runs need -o FILE");
  const double time = options.time.empty() ? 0 : seconds_in(options.time, "--time");
  // Of several runs, one that has ended before shows its last frame beside the others.
  const bool is_recorded = std::any_of(sources.begin(), sources.end(), [&](const TrajectorySource& source) {
    return static_cast<bool>(source.recorded_frame(time));
  });
  if (!options.time.empty() && !is_recorded) value_or_fail(sources.front().recorded_frame(time), ExitCode::kBadInput);
  const std::size_t frame = options.frame == "last" ? 0 : frame_in(options, sources);
  if (style.inset == Inset::kOrder || (style.caption && sources.size() == 1)) {
    for (TrajectorySource& source : sources) done_or_fail(source.read_history());
  }
  constexpr double kAlways = std::numeric_limits<double>::infinity();
  follow_defect(style, sources, -kAlways, kAlways);
  const SweepPlaces places = places_of(options, style);
  RodPicture picture =
      value_or_fail(joint_picture(options, style, places, sources, [&](std::size_t i) -> Result<std::size_t> {
        if (!options.time.empty()) return sources[i].nearest_frame(time);
        return options.frame == "last" ? sources[i].n_frames() - 1 : frame;
      }));
  // One colouring for all panels, as there is one legend.
  if (sources.size() > 1 && style.colour == "auto") {
    style.colour = chosen_colour(picture, std::vector{picture.order}, style.mark_defects);
  }
  paint_to_file(options, style, picture, out_of(options, sources.front(), "picture.png"), watch);
}

void make_live_picture(const Options& options) {
  const Stopwatch watch;
  const PictureStyle style = style_of(options);
  if (style.followed_defect) {
    throw Failure(ExitCode::kBadInput, "a defect is followed in recorded frames, not in a running job");
  }
  if (style.inset == Inset::kSweep) {
    throw Failure(ExitCode::kBadInput, "the inset of a sweep is drawn with recorded frames, not with a running job's");
  }
  if (style.inset == Inset::kOrder) {
    throw Failure(ExitCode::kBadInput, "messages do not tell S(t): of a running job the inset is angles, g2 or g2-map");
  }
  check_picture_name(options);
  const auto timeout = std::chrono::milliseconds(std::llround(options.timeout_s * 1000));
  RodPicture picture = value_or_fail(live_picture(options.lcm_url, options.sources.front(), timeout, style));
  check_picture(style, picture);
  set_label(options, 0, picture);
  paint_to_file(options, style, picture, options.out, watch);
}

volatile std::sig_atomic_t stop_requested = 0;

/// Which recorded frames a film shows, and how fast it then plays.
struct Cut {
  std::vector<std::size_t> frames;
  double playback = 0;  ///< simulated seconds per second of playing
};

Cut cut_of(const Options& options, const PictureStyle& style, const TrajectorySource& source) {
  const auto frame_at = [&](const std::string& text, const char* option, std::size_t otherwise) {
    if (text.empty()) return otherwise;
    return value_or_fail(source.recorded_frame(seconds_in(text, option)), ExitCode::kBadInput);
  };
  const auto time_of = [&](std::size_t index) { return value_or_fail(source.time_of(index), ExitCode::kFailed); };
  const std::size_t first = frame_at(options.from, "--from", 0);
  // A film ends with its run, wherever --to is.
  std::size_t last = source.n_frames() - 1;
  if (!options.to.empty())
    last = value_or_fail(source.nearest_frame(seconds_in(options.to, "--to")), ExitCode::kFailed);
  if (last < first) throw Failure(ExitCode::kBadInput, "--from is later than --to");
  const double begin = time_of(first), end = time_of(last);
  Cut cut;
  if (style.speed) {
    if (options.every) throw Failure(ExitCode::kBadInput, "--every and --speed exclude each other");
    constexpr double kMostFrames = 1e6;
    const double frames = (end - begin) / *style.speed * style.fps + 1;
    if (frames > kMostFrames) {
      throw Failure(ExitCode::kBadInput, fmt::format("at speed {:g} the film would have {:.3g} frames; at most a "
                                                     "million: use --from and --to",
                                                     *style.speed, frames));
    }
    const auto n_frames = static_cast<std::size_t>(frames + 1e-6);
    for (std::size_t k = 0; k < n_frames; ++k) {
      const double time = begin + static_cast<double>(k) * *style.speed / style.fps;
      cut.frames.push_back(value_or_fail(source.nearest_frame(time), ExitCode::kFailed));
    }
    cut.playback = *style.speed;
    return cut;
  }
  // What the command line leaves open, the scene may say.
  const std::optional<scene::Movie> request = source.movie_request();
  std::size_t stride = options.every.value_or(1);
  if (!options.every && request && source.n_frames() > 1) {
    const double step = time_of(1) - time_of(0);
    if (step > 0) stride = static_cast<std::size_t>(std::max(1.0, std::round(request->every / step)));
  }
  for (std::size_t index = first; index <= last; index += stride) cut.frames.push_back(index);
  if (cut.frames.size() > 1) cut.playback = (time_of(cut.frames[1]) - begin) * style.fps;
  return cut;
}

void make_movie_file(const Options& options) {
  const Stopwatch watch;
  std::vector<TrajectorySource> sources = open_sources(options);
  TrajectorySource& source = sources.front();
  PictureStyle style;
  if (const std::optional<scene::Movie> request = source.movie_request()) {
    style.width = request->width;
    style.height = request->height;
  }
  style = style_of(options, style);
  if (sources.size() > 1 && options.out.empty()) throw Failure(ExitCode::kBadInput, "several runs need -o FILE");
  const std::string out = out_of(options, source, "movie.mp4");
  done_or_fail(check_movie_name(out), ExitCode::kBadInput);
  done_or_fail(check_movie_size(out, style.width, style.height), ExitCode::kBadInput);
  const Cut cut = cut_of(options, style, source);
  for (TrajectorySource& each : sources) done_or_fail(each.read_history());
  // One colouring for the whole film.
  if (style.colour == "auto") {
    const RodPicture last = value_or_fail(source.picture(cut.frames.back(), style), ExitCode::kFailed);
    const auto time_of = [&](std::size_t index) { return value_or_fail(source.time_of(index), ExitCode::kFailed); };
    std::vector<double> orders = source.orders(time_of(cut.frames.front()), time_of(cut.frames.back()));
    if (orders.empty()) orders = {last.order};
    style.colour = chosen_colour(last, orders, style.mark_defects);
  }

  follow_defect(style, sources, value_or_fail(source.time_of(cut.frames.front())),
                value_or_fail(source.time_of(cut.frames.back())));
  const SweepPlaces places = places_of(options, style);
  MovieOptions movie{options.labels.empty() ? source.label() : headline(printable(options.labels.front())),
                     source.notes(), std::nullopt, options.n_threads};
  if (movie.n_threads < 1) movie.n_threads = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  // All painters of a process share Mesa's rasteriser, which takes one picture at a time: it is its threads that use
  // the cores, and the painters' own only have the next picture ready.
  setenv("LP_NUM_THREADS", std::to_string(movie.n_threads).c_str(), 1);
  if (options.keep_frames) movie.keep_frames = std::filesystem::path(out).parent_path() / "frames";
  FilmAxes axes;
  const auto picture = [&](std::size_t k) -> Result<RodPicture> {
    // The clock is the first run's; one that has ended before shows its last frame.
    const double time = value_or_fail(source.time_of(cut.frames[k]));
    Result<RodPicture> rods = joint_picture(options, style, places, sources, [&](std::size_t i) -> Result<std::size_t> {
      return i == 0 ? cut.frames[k] : sources[i].nearest_frame(time);
    });
    if (rods) {
      rods->playback = cut.playback;
      rods->axes = axes;
      for (RodPicture& beside : rods->beside) beside.axes = axes;
    }
    return rods;
  };
  axes = value_or_fail(film_axes(cut.frames.size(), picture, style), ExitCode::kFailed);
  struct sigaction stop {};
  stop.sa_handler = [](int) { stop_requested = 1; };
  stop.sa_flags = static_cast<int>(SA_RESTART | SA_RESETHAND);  // a second one ends the program at once
  sigaction(SIGINT, &stop, nullptr);
  sigaction(SIGTERM, &stop, nullptr);
  {
    ProgressLine progress("drawing");
    double told = -1;  // when progress was last written to a file [s]
    const Result<void> made = make_movie(out, style, movie, cut.frames.size(), picture, [&](std::size_t i) {
      progress.show(static_cast<double>(i + 1) / static_cast<double>(cut.frames.size()));
      constexpr double kPeriod = 0.3;
      const bool is_last = i + 1 == cut.frames.size();
      if (!options.progress.empty() && (is_last || watch.seconds() > told + kPeriod)) {
        told = watch.seconds();
        const nlohmann::ordered_json so_far = {
            {"frames_drawn", i + 1}, {"frames", cut.frames.size()}, {"seconds", told}};
        done_or_fail(write_file_atomically(options.progress, so_far.dump() + "\n"));
      }
      return stop_requested == 0;
    });
    done_or_fail(made, stop_requested != 0 ? ExitCode::kInterrupted : ExitCode::kFailed);
  }
  report(options, out, cut.frames.size(), style, watch);
}

/// Prints a preset as a style file, or a list of them.
void print_styles(const Options& options) {
  for (const Preset& preset : presets()) {
    if (options.preset.empty()) std::cout << fmt::format("{:<10} {}\n", preset.name, preset.doc);
    if (options.preset == preset.name) {
      std::cout << fmt::format("// {}: {}\n{}", preset.name, preset.doc, preset.text);
      return;
    }
  }
  if (!options.preset.empty()) {
    throw Failure(ExitCode::kBadInput,
                  fmt::format("there is no style '{}' (see `shaken-render style`)", options.preset));
  }
}

void declare_sweep(CLI::App& app, Options& options) {
  app.add_option("--sweep", options.sweep,
                 R"(For --inset sweep: {"x", "y": names, "points": [[X, Y, S]], "here": [[X, Y]] of each run})")
      ->type_name("JSON");
}

void declare_depth(CLI::App& app, Options& options) {
  app.add_option("--depth", options.depth, "Bits a colour of a .png: 8, or 16 for what is worked on afterwards")
      ->check(CLI::IsMember({8, 16}))
      ->capture_default_str()
      ->type_name("BITS");
}

void declare_style(CLI::App& app, Options& options) {
  app.add_option("--style", options.style,
                 "A preset (`shaken-render style` lists them) or a style file; the options "
                 "below change it")
      ->type_name("NAME|FILE");
  for (const StyleKey& key : style_keys()) {
    if (key.path == "style") continue;
    if (key.form == keys::Form::kSwitch) {
      app.add_flag(
          fmt::format("--{0},!--no-{0}", option_of(key)),
          [&options, &key](std::int64_t on) { options.switches[key.path] = on > 0; }, key.doc);
    } else {
      app.add_option(flags_of(key), options.keys[key.path], key.doc)->type_name(value_name(key));
    }
  }
  app.add_option("--label", options.labels,
                 "Headline, one for each run; settings like rods.length=2.5 are written as physicists do")
      ->type_name("TEXT")
      ->expected(1)
      ->take_all();
  app.add_flag("--bare", options.bare, "Only the box, filling the picture");
  app.add_flag("--json", options.json, "Prints path, frames, size and seconds as JSON");
}

int run(int argc, char** argv) {
  // Mesa would otherwise keep compiled shaders in the home directory; compiling them takes a tenth of a second.
  setenv("MESA_SHADER_CACHE_DISABLE", "true", 1);

  Options options;
  CLI::App app{"Pictures and movies of shaken rods, without a display.", "shaken-render"};
  app.formatter(std::make_shared<HelpFormatter>());
  app.set_version_flag("--version", std::string("shaken-render ") + run::version());
  app.require_subcommand(1);
  std::string colours;
  for (const Colouring& colouring : colourings()) colours += fmt::format("  {:<9} {}\n", colouring.name, colouring.doc);
  app.footer(
      "Colours (-c):\n"
      "  auto      layers where there is order and no defect is marked, else angle\n" +
      colours +
      "Examples:\n"
      "  shaken-render picture runs/first                           last frame -> runs/first/picture.png\n"
      "  shaken-render picture runs/first -o fig3.png --time 12.5s --colour tilt --size 1600x900\n"
      "  shaken-render picture runs/first -o fig4.pdf --style director --theme print\n"
      "  shaken-render movie runs/first                             -> runs/first/movie.mp4\n"
      "  shaken-render movie runs/first -o m.gif --from 10s --to 20s --speed 0.5 --size 640x360\n"
      "  shaken-render movie runs/a runs/b -o two.mp4 --label 0.45 --label 0.80     side by side, with one clock\n"
      "  shaken-render movie runs/first -o - --bare --size 720x720 | ffmpeg -f rawvideo -pix_fmt rgb24 -s 720x720 ...\n"
      "  shaken-render style defects > mine.json                    a style file to begin with\n"
      "  shaken-render live 1f0c -o now.png                         a running job, from LCM\n"
      "Exit codes: 0 done, 1 failed, 2 bad input, 130 interrupted by Ctrl-C.");

  CLI::App* picture = app.add_subcommand("picture", "One frame of a recorded run as a PNG, SVG or PDF");
  constexpr const char* kRuns = "Run directory or trajectory.h5; several are drawn side by side";
  picture->add_option("run", options.sources, kRuns)->required();
  picture->add_option("-o,--out", options.out, "File: .png, .svg or .pdf [picture.png beside the trajectory]")
      ->type_name("FILE");
  CLI::Option* frame = picture->add_option("--frame", options.frame, "Frame, counted from 0")->type_name("N|last");
  picture->add_option("--time", options.time, "The frame nearest to this simulated time: 12.5, 500ms")
      ->type_name("TIME")
      ->excludes(frame);
  declare_depth(*picture, options);
  declare_sweep(*picture, options);
  declare_style(*picture, options);

  CLI::App* movie = app.add_subcommand("movie", "A recorded run as a film");
  movie->add_option("run", options.sources, kRuns)->required();
  movie
      ->add_option("-o,--out", options.out,
                   "File: .mp4, .webm or .gif [movie.mp4 beside the trajectory]; FOLDER/ for numbered frames; - for "
                   "raw frames (rgb24) on stdout")
      ->type_name("FILE");
  movie->add_option("--every", options.every, "Takes every N-th frame [as the scene's movie.every says]")
      ->check(CLI::Range(1, 1000000000))
      ->type_name("N");
  movie->add_option("--from", options.from, "Begins at this simulated time: 10, 10s, 500ms")->type_name("TIME");
  movie->add_option("--to", options.to, "Ends at this simulated time")->type_name("TIME");
  movie->add_flag("--frames", options.keep_frames, "Keeps the frames too, in frames/frame_000000.png beside the movie");
  movie->add_option("--threads", options.n_threads, "Threads that draw [one per core]")
      ->check(CLI::Range(1, 256))
      ->type_name("N");
  movie->add_option("--progress", options.progress, "Keeps in this file, as JSON, how far it is")->type_name("FILE");
  declare_sweep(*movie, options);
  declare_style(*movie, options);

  CLI::App* live = app.add_subcommand("live", "The present state of a running job as a picture, from LCM");
  live->add_option("job", options.sources, "The job's id, or the beginning of it")->required()->expected(1);
  live->add_option("-o,--out", options.out, "File: .png, .svg or .pdf")->required()->type_name("FILE");
  live->add_option("--lcm-url", options.lcm_url, "The bus")->capture_default_str()->type_name("URL");
  live->add_option("--timeout", options.timeout_s, "How long to wait for a frame")
      ->check(CLI::Range(0.1, 86400.0))
      ->capture_default_str()
      ->type_name("S");
  declare_depth(*live, options);
  declare_style(*live, options);

  CLI::App* style = app.add_subcommand("style", "Lists the presets, or prints one as a style file");
  style->add_option("name", options.preset, "Preset");

  try {
    app.parse(argc, argv);
    if (picture->parsed()) make_picture(options);
    if (movie->parsed()) make_movie_file(options);
    if (live->parsed()) make_live_picture(options);
    if (style->parsed()) print_styles(options);
    return static_cast<int>(ExitCode::kOk);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);
    complain(fmt::format("shaken-render: {} (see `shaken-render --help`)", error.what()));
    return static_cast<int>(ExitCode::kBadInput);
  } catch (const Failure& failure) {
    complain("shaken-render: " + printable(failure.what(), Lines::kMany));
    return static_cast<int>(failure.code);
  } catch (const std::exception& error) {
    complain("shaken-render: " + printable(error.what(), Lines::kMany));
    return static_cast<int>(ExitCode::kFailed);
  }
}

}  // namespace
}  // namespace shaken::render

int main(int argc, char** argv) {
  shaken::guard_standard_streams("shaken-render");
  return shaken::render::run(argc, argv);
}
