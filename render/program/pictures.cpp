#include "render/program/pictures.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iostream>
#include <limits>

#include "base/failure.h"
#include "base/stopwatch.h"
#include "render/colourings.h"
#include "render/painter.h"
#include "render/png.h"
#include "render/program/runs.h"
#include "render/style_file.h"

namespace shaken::render {
namespace {

void check_picture_name(const Options& options, const PictureStyle& style) {
  if (style.transparent && options.depth != 8) {
    throw Failure(ExitCode::kBadInput, "--transparent is for 8 bits a colour, not for --depth 16");
  }
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
      done_or_fail(write_png(out, image, picture_texts(picture.frame, picture.captions), style.dpi.value_or(0)));
    };
    if (style.transparent) {
      const ClearImage image = value_or_fail(painter.paint_clear(picture, style), ExitCode::kFailed);
      done_or_fail(write_png(out, image, picture_texts(picture.frame, picture.captions), style.dpi.value_or(0)));
    } else {
      options.depth == 16 ? paint(std::uint16_t{}) : paint(std::uint8_t{});
    }
  }
  report(options, out, 1, style, watch.seconds());
}

/// The frame that `--frame` names.
std::size_t frame_in(const Options& options, const Runs& runs, std::size_t n_frames) {
  const bool digits = !options.frame.empty() && options.frame.size() < 10 &&
                      options.frame.find_first_not_of("0123456789") == std::string::npos;
  if (runs.are_several()) {
    throw Failure(ExitCode::kBadInput,
                  "--frame takes a number for one run only: runs have frames at different times; use --time");
  }
  if (!digits || std::stoul(options.frame) >= n_frames) {
    throw Failure(ExitCode::kBadInput,
                  fmt::format("--frame takes 'last' or a number from 0 to {}, not '{}'", n_frames - 1, options.frame));
  }
  return std::stoul(options.frame);
}

}  // namespace

void make_picture(const Options& options) {
  const Stopwatch watch;
  PictureStyle style = style_of(options);
  check_picture_name(options, style);
  Runs runs(options);
  const double time = options.time.empty() ? 0 : seconds_in(options.time, "--time");
  // Of several runs, one that has ended before shows its last frame beside the others.
  const bool is_recorded = std::any_of(runs.all().begin(), runs.all().end(), [&](const TrajectorySource& source) {
    return static_cast<bool>(source.recorded_frame(time));
  });
  if (!options.time.empty() && !is_recorded) value_or_fail(runs.first().recorded_frame(time), ExitCode::kBadInput);
  const std::size_t frame = options.frame == "last" ? 0 : frame_in(options, runs, runs.first().n_frames());
  if (style.inset == Inset::kOrder || (style.caption && !runs.are_several())) {
    for (TrajectorySource& source : runs.all()) done_or_fail(source.read_history());
  }
  constexpr double kAlways = std::numeric_limits<double>::infinity();
  runs.prepare(style, -kAlways, kAlways);
  const auto picture_of = [&](TrajectorySource& source) -> Result<RodPicture> {
    if (options.time.empty()) return source.picture(options.frame == "last" ? source.n_frames() - 1 : frame, style);
    return source.picture(SHAKEN_TRY(source.nearest_frame(time)), style);
  };
  RodPicture picture = value_or_fail(runs.joint_picture(style, picture_of));
  // One colouring for all panels, as there is one legend.
  if (runs.are_several() && style.colour == "auto") {
    style.colour = chosen_colour(picture, std::vector{picture.found.order}, style.mark_defects);
  }
  paint_to_file(options, style, picture, runs.out_or("picture.png"), watch);
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
    throw Failure(ExitCode::kBadInput, "messages do not tell S(t): of a running job the inset is angles");
  }
  check_picture_name(options, style);
  const auto timeout = std::chrono::milliseconds(std::llround(options.timeout_s * 1000));
  RodPicture picture = value_or_fail(live_picture(options.lcm_url, options.sources.front(), timeout, style));
  check_picture(style, picture);
  set_label(options, 0, picture.captions);
  paint_to_file(options, style, picture, options.out, watch);
}

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

}  // namespace shaken::render
