#include "render/program/films.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "base/failure.h"
#include "base/files.h"
#include "base/processor.h"
#include "base/progress_line.h"
#include "base/stopwatch.h"
#include "base/text.h"
#include "render/colourings.h"
#include "render/headline.h"
#include "render/make_movie.h"
#include "render/movie.h"
#include "render/program/runs.h"

namespace shaken::render {
namespace {

volatile std::sig_atomic_t stop_requested = 0;

/// Which times a film shows, and how fast it then plays.
struct Cut {
  std::vector<double> times;  ///< increasing [s]
  double playback = 0;        ///< simulated seconds per second of playing
};

Cut cut_of(const Options& options, const PictureStyle& style, const TrajectorySource& source) {
  const auto time_of = [&](std::size_t index) { return value_or_fail(source.time_of(index), ExitCode::kFailed); };
  std::size_t first = 0;
  if (!options.from.empty())
    first = value_or_fail(source.recorded_frame(seconds_in(options.from, "--from")), ExitCode::kBadInput);
  // A film ends with its run, wherever --to is.
  std::size_t last = source.n_frames() - 1;
  if (!options.to.empty())
    last = value_or_fail(source.nearest_frame(seconds_in(options.to, "--to")), ExitCode::kFailed);
  if (last < first) throw Failure(ExitCode::kBadInput, "--from is later than --to");
  double begin = time_of(first), end = time_of(last);
  if (style.speed && style.interpolate) {
    if (!options.from.empty()) begin = std::max(seconds_in(options.from, "--from"), time_of(0));
    if (!options.to.empty()) end = std::min(seconds_in(options.to, "--to"), time_of(source.n_frames() - 1));
    if (end < begin) throw Failure(ExitCode::kBadInput, "--from is later than --to");
  }
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
      cut.times.push_back(begin + static_cast<double>(k) * *style.speed / style.fps);
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
  for (std::size_t index = first; index <= last; index += stride) cut.times.push_back(time_of(index));
  if (cut.times.size() > 1) cut.playback = (cut.times[1] - begin) * style.fps;
  return cut;
}

/// What the film says of frames that were not recorded.
Notes notes_of(const TrajectorySource& source, const PictureStyle& style, const Cut& cut) {
  Notes notes = source.notes();
  if (!style.interpolate || source.n_frames() < 2 || cut.times.size() < 2) return notes;
  const double recorded = value_or_fail(source.time_of(1)) - value_or_fail(source.time_of(0));
  if (cut.times[1] - cut.times[0] > 0.999 * recorded) return notes;
  notes.emplace_back("Interpolated", fmt::format("between frames that were recorded every {:.4g} s", recorded));
  return notes;
}

/// Keeps a file that says how far the film is, as JSON.
class ProgressFile {
 public:
  explicit ProgressFile(std::string file) : file_(std::move(file)) {}
  void write(std::size_t drawn, std::size_t all, double seconds) {
    constexpr double kPeriod = 0.3;  // [s]
    if (file_.empty() || (drawn < all && seconds <= written_ + kPeriod)) return;
    written_ = seconds;
    const nlohmann::ordered_json so_far = {{"frames_drawn", drawn}, {"frames", all}, {"seconds", seconds}};
    done_or_fail(write_file_atomically(file_, so_far.dump() + "\n"));
  }

 private:
  std::string file_;
  double written_ = -1;
};

}  // namespace

void make_film(const Options& options) {
  const Stopwatch watch;
  Runs runs(options);
  TrajectorySource& source = runs.first();
  PictureStyle style;
  if (const std::optional<scene::Movie> request = source.movie_request()) {
    style.width = request->width;
    style.height = request->height;
  }
  style = style_of(options, style);
  const std::string out = runs.out_or("movie.mp4");
  done_or_fail(check_movie_name(out), ExitCode::kBadInput);
  done_or_fail(check_movie(out, style.width, style.height, style.fps), ExitCode::kBadInput);
  if (style.small && std::filesystem::path(out).extension() == ".gif") {
    throw Failure(ExitCode::kBadInput, "--small is of .mp4 and .webm: a .gif has one kind of compression");
  }
  if (style.transparent) {
    throw Failure(ExitCode::kBadInput, "--transparent is for pictures: films have no opacity");
  }
  const Cut cut = cut_of(options, style, source);
  const double begin = cut.times.front(), end = cut.times.back();
  for (TrajectorySource& each : runs.all()) done_or_fail(each.read_history());
  const RodPicture last = value_or_fail(source.picture_at(end, style), ExitCode::kFailed);
  // One colouring for the whole film.
  if (style.colour == "auto") {
    std::vector<double> orders = source.orders(begin, end);
    if (orders.empty()) orders = {last.found.order};
    style.colour = chosen_colour(last, orders, style.mark_defects);
  }
  runs.prepare(style, begin, end);

  MovieOptions movie;
  movie.title = options.labels.empty() ? last.captions.label : headline(printable(options.labels.front()));
  movie.notes = notes_of(source, style, cut);
  movie.n_threads = options.n_threads > 0 ? options.n_threads : allowed_cores();
  // All painters of a process share Mesa's rasteriser, which takes one picture at a time: it is its threads that use
  // the cores, and the painters' own only have the next picture ready.
  setenv("LP_NUM_THREADS", std::to_string(movie.n_threads).c_str(), 1);
  if (options.keep_frames) movie.keep_frames = std::filesystem::path(out).parent_path() / "frames";
  FilmAxes axes;
  const auto picture = [&](std::size_t k) -> Result<RodPicture> {
    // The clock is the first run's; one that has ended before shows its last frame.
    Result<RodPicture> rods =
        runs.joint_picture(style, [&](TrajectorySource& each) { return each.picture_at(cut.times[k], style); });
    if (!rods) return rods;
    rods->captions.playback = cut.playback;
    rods->captions.film_share = end > begin ? (cut.times[k] - begin) / (end - begin) : 1;
    rods->captions.axes = axes;
    for (RodPicture& beside : rods->beside) beside.captions.axes = axes;
    return rods;
  };
  const std::size_t n_frames = cut.times.size();
  axes = value_or_fail(film_axes(n_frames, picture, style), ExitCode::kFailed);
  struct sigaction stop {};
  stop.sa_handler = [](int) { stop_requested = 1; };
  stop.sa_flags = static_cast<int>(SA_RESTART | SA_RESETHAND);  // a second one ends the program at once
  sigaction(SIGINT, &stop, nullptr);
  sigaction(SIGTERM, &stop, nullptr);
  {
    ProgressLine progress("drawing");
    ProgressFile file(options.progress);
    const Result<void> made = make_movie(out, style, movie, n_frames, picture, [&](std::size_t i) {
      progress.show(static_cast<double>(i + 1) / static_cast<double>(n_frames));
      file.write(i + 1, n_frames, watch.seconds());
      return stop_requested == 0;
    });
    done_or_fail(made, stop_requested != 0 ? ExitCode::kInterrupted : ExitCode::kFailed);
  }
  report(options, out, n_frames, style, watch.seconds());
}

}  // namespace shaken::render
